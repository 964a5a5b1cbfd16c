#!/bin/bash
# The steps of test_python inside of the bare system. Lines that begin with ## are the report.
set -euo pipefail

report() { echo "## $*"; }

cd /tmp
python3 -m venv environment
start=$SECONDS
environment/bin/pip install -q "$(ls /packages/voussoir-*.tar.gz)[files]"
took=$((SECONDS - start))
times >/tmp/times  # the second line is that of the children
report "pip install of $(stat -c %s /packages/voussoir-*.tar.gz) bytes: $took s, processor time $(sed -n '2s/ .*//p' /tmp/times)"
module=$(ls environment/lib/python3*/site-packages/voussoir/_core*.so)
report "module: $(stat -c %s "$module") bytes, needs $(ldd "$module" | awk '{print $1}' | tr '\n' ' ')"
ldd "$module" | grep -E 'hdf5|gmsh|cholmod|fmt|kokkos' && { report "FAILED: the module needs a library that it must not need"; exit 1; }
environment/bin/python - <<'PYTHON'
import numpy as np

import voussoir

packing = voussoir.make_packings(1, grains=60)[0]
packing.save("packing.h5")
with voussoir.RveBatch(voussoir.load_packing("packing.h5"), 4) as batch:
    step = np.zeros((4, 2, 2))
    step[:, 1, 1] = -1e-3
    answer = batch.evaluate(step)
    batch.commit()
assert answer.usable and np.all(answer.stress[:, 1, 1] < -100e3), answer.stress
print("## evaluated:", packing, f"{answer.stress[0, 1, 1] / 1e3:.1f} kPa")
PYTHON
