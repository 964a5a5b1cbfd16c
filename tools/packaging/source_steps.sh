#!/bin/bash
# The steps of test_source inside of the system without a network. Lines that begin with ## are the report.
set -euo pipefail

report() { echo "## $*"; }

if (($(wc -l </proc/self/net/route) > 1)); then report "FAILED: there is a network"; exit 1; fi
mkdir /build && cd /build
tar -xzf /packages/voussoir-*.tar.gz
cd voussoir-*
start=$SECONDS
tools/setup --no-python
report "tools/setup --no-python built Kokkos without a network: $((SECONDS - start)) s"
start=$SECONDS
cmake --preset openmp -DVOUSSOIR_TESTS=OFF
cmake --build --preset openmp
report "built without a network: $((SECONDS - start)) s"
cmake --install build/openmp --prefix /opt/voussoir
report "$(/opt/voussoir/bin/voussoir --version)"
/opt/voussoir/bin/voussoir run /opt/voussoir/share/voussoir/cases/tunnel_elastic/case.toml -o /tmp/elastic
report "tunnel_elastic ran"
