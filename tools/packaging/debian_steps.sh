#!/bin/bash
# The steps of test_debian inside of the bare system. Lines that begin with ## are the report.
set -euo pipefail

readonly cases=/usr/share/voussoir/cases
report() { echo "## $*"; }
fail() { report "FAILED: $*"; exit 1; }

# files: all files and folders of the system but those of package management, temporary ones and what this test has brought.
files() {
  find / -xdev \( -path /proc -o -path /dev -o -path /sys -o -path /tmp -o -path /packages -o -path /var/cache -o \
    -path /var/lib/apt -o -path /var/lib/dpkg -o -path /var/log \) -prune -o -print | sort
}

install() { apt-get -q -y install --no-install-recommends "$@"; }
disk() { du -sxk / --exclude=/proc --exclude=/packages --exclude=/tmp --exclude=/var/cache 2>/dev/null | cut -f1; }

# same_numbers FIRST SECOND: the tables of two runs hold the same bits, but for times and memory.
same_numbers() {
  /usr/bin/python3 - "$1" "$2" <<'PYTHON'
import sys

import h5py

tables = [h5py.File(f"{folder}/run.h5")["table"] for folder in sys.argv[1:]]
names = [name for name in tables[0] if not name.startswith("time_") and name not in ("wall_s", "peak_memory")]
different = [name for name in names if tables[0][name][()].tobytes() != tables[1][name][()].tobytes()]
assert len(names) > 5 and not different, different
PYTHON
}

apt-get -q update
before=$(disk)
files >/tmp/files_before
install /packages/voussoir_*.deb
report "installed with $(apt-get -s autoremove voussoir 2>/dev/null | grep -c '^Remv') packages; the disk holds $((($(disk) - before) / 1024)) MiB more"
cd /tmp
[[ ! -e /packages/consumer/../CMakeLists.txt ]] || fail "the sources are there"
report "$(voussoir --version)"
report "$(voussoir info --cpu | head -1)"
ldd /usr/bin/voussoir | grep 'not found' && fail "libraries are missing"

start=$SECONDS
voussoir run $cases/tunnel_elastic/case.toml -o /tmp/elastic
report "tunnel_elastic: $((SECONDS - start)) s"
start=$SECONDS
voussoir run $cases/tunnel_quick/case.toml -o /tmp/quick
report "tunnel_quick: $((SECONDS - start)) s"
report "Python: $(PYTHONPATH=/usr/share/voussoir/python python3 -c 'import voussoir; print(voussoir.open_result("/tmp/quick"))')"
start=$SECONDS
voussoir-figures /tmp/quick
voussoir-figures /tmp/elastic
voussoir-report /tmp/quick
report "figures and report: $((SECONDS - start)) s, $(ls /tmp/quick/*.png | wc -l) pictures, report of $(stat -c %s /tmp/quick/report.html) bytes"

small=(--set packing.grains=100 --set packing.candidates=1 --set packing.variety=1 --set 'ground.mesh_size_opening=2.5 m'
  --set 'ground.mesh_size_far=8 m' --set column.elements=4 --set gravity.ratio=2 --set 'volume_loss.total=1 %'
  --set volume_loss.increments=4)
for isa in scalar v3 v4; do
  if VOUSSOIR_ISA=$isa voussoir run $cases/tunnel_quick/case.toml -o /tmp/lanes_$isa "${small[@]}" >/tmp/lanes_$isa.log 2>&1; then
    same_numbers /tmp/lanes_scalar /tmp/lanes_$isa
    report "VOUSSOIR_ISA=$isa: a small tunnel has the bits of the scalar lanes"
  else
    [[ $isa == v4 ]] || fail "VOUSSOIR_ISA=$isa: $(tail -1 /tmp/lanes_$isa.log)"
    report "VOUSSOIR_ISA=v4: $(tail -1 /tmp/lanes_v4.log)"
  fi
done

install /packages/libvoussoir*.deb /packages/voussoir-dev_*.deb cmake make
for part in consumer consumer/c; do
  cmake -S "/packages/$part" -B "/tmp/$part" && cmake --build "/tmp/$part"
done
/tmp/consumer/consumer /packages/consumer/grains.toml /tmp/consumer_packings
/tmp/consumer/c/consumer_c /packages/consumer/grains.toml /tmp/consumer_packings
report "programs in C++ and C were built against voussoir-dev and passed their checks"

apt-get -q -y purge voussoir voussoir-dev 'libvoussoir*' cmake make
apt-get -q -y autoremove --purge
[[ -z "$(dpkg-query -W -f '${Package}\n' 'voussoir*' 'libvoussoir*' 2>/dev/null)" ]] || fail "dpkg still knows the packages"
files >/tmp/files_after
left=$(comm -13 /tmp/files_before /tmp/files_after)
[[ -z "$(grep -i voussoir <<<"$left")" ]] || fail "the packages left files: $(grep -i voussoir <<<"$left")"
report "removed: no file of voussoir is left; packages that came with it left $(grep -c . <<<"$left") files and folders"
grep . <<<"$left" || true
