# An image with the program, made as tools/setup and tools/package make the Debian package:
#   docker build -t voussoir . && docker run --rm -v "$PWD:/work" voussoir run /usr/share/voussoir/cases/tunnel_quick/case.toml
# tools/package --test-docker runs the same steps without docker.
FROM debian:12-slim AS build
COPY . /voussoir
WORKDIR /voussoir
RUN tools/setup --package --no-python && \
    tools/package --debian

FROM debian:12-slim
COPY --from=build /voussoir/build/package/voussoir_*.deb /tmp/
RUN apt-get update && \
    apt-get install -y --no-install-recommends /tmp/voussoir_*.deb && \
    rm -rf /tmp/voussoir_*.deb /var/lib/apt/lists/* && \
    useradd --uid 1000 --create-home voussoir && \
    mkdir /work && \
    chown voussoir /work
USER 1000
WORKDIR /work
ENTRYPOINT ["voussoir"]
CMD ["--help"]
