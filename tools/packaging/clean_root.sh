# Functions for tests in a bare Debian 12: a folder with a system of its own, in which commands run as root. It needs root
# and mmdebstrap. The folder lies outside of the checkout, below TMPDIR, because a system's files are no part of it.

clean_roots="${TMPDIR:-/tmp}/voussoir_roots"

# make_root NAME: prints the folder of a new bare system. The first call downloads its packages; later calls unpack them.
make_root() {
  local folder="$clean_roots/$1" base="$clean_roots/debian12.tar"
  mkdir -p "$clean_roots"
  if [[ ! -s "$base" ]]; then
    mmdebstrap --quiet --variant=minbase bookworm "$base.new" >&2 || return 1
    mv "$base.new" "$base"
  fi
  rm -rf "$folder"
  mkdir -p "$folder"
  tar -xf "$base" -C "$folder" || return 1
  cp /etc/resolv.conf "$folder/etc/resolv.conf"
  # Behind a proxy that has a certificate of its own, pip must know the certificates of this machine.
  cp "${SSL_CERT_FILE:-/etc/ssl/certs/ca-certificates.crt}" "$folder/etc/certificates_of_host.crt"
  cp -l "$clean_roots"/archives/*.deb "$folder/var/cache/apt/archives/" 2>/dev/null
  echo "$folder"
}

# in_root FOLDER COMMAND...: runs a command in the system, with its own process numbers and mounts, which end with it. The
# Debian packages that it downloads are kept for later systems.
in_root() {
  local folder="$1" status
  shift
  unshare --mount --pid --fork -- bash -c '
    folder=$1; shift
    mount -t proc proc "$folder/proc" && mount --rbind /dev "$folder/dev" && mount -t tmpfs tmpfs "$folder/dev/shm" || exit 1
    exec env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 TERM=dumb \
      DEBIAN_FRONTEND=noninteractive OMP_WAIT_POLICY=passive PIP_CERT=/etc/certificates_of_host.crt \
      ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} chroot "$folder" "$@"
    ' in_root "$folder" "$@"
  status=$?
  mkdir -p "$clean_roots/archives"
  cp -nl "$folder"/var/cache/apt/archives/*.deb "$clean_roots/archives/" 2>/dev/null
  return $status
}
