"""What a case may ask for, on the device that is the host: each feature answers as with lanes, and what a device cannot
do is left to lanes or refused."""

import shutil
import signal
import subprocess

import h5py
import numpy as np
from devices import EMULATED, far_from, last, log_of, on_device
from program import PROGRAM, ROOT, check, check_same, command, fresh, run, start_and_signal, table

DATA = ROOT / "tests/data/packings"
SETTINGS = [
    "packing.grains=60",
    "packing.candidates=3",
    "packing.folder=packings",
    "column.elements=3",
    "gravity.uniform_step=0.1",
]


def words(folder, settings, *further, case="column"):
    return command(case, folder, settings, "--threads", "1", *further)


def both(name, settings, *fields, most, case="column"):
    """Runs a case by lanes and on the device. `most` is how far the fields may be apart, of their largest value."""
    lanes, device = fresh(f"{name}_lanes"), fresh(f"{name}_device")
    run(words(lanes, settings, case=case))
    run(on_device(words(device, settings, case=case)))
    check("on the device" not in log_of(lanes), f"{name}: lanes speak of a device")
    check("grains on the device emulated device 0" in log_of(device), f"{name}: the device was not used")
    for field in fields:
        off = far_from(lanes, device, field)
        print(f"{name}: {field} is off by {off:.1e}")
        check(0 < off < most, f"{name}: {field} of the device is off by {off:.1e} of its largest value")
    return lanes, device


# Several packings, every second point a mirror image, the grains' network and pictures of single RVEs.
lanes, device = both(
    "mixed",
    [*SETTINGS, "packing.variety=3", "packing.mirrored=true", "output.rves=[1, 2]", 'output.microstructure=["fabric"]'],
    "gauss/stress",
    "gauss/void_ratio",
    "gauss/fabric",
    "rve/point_00002/x",
    most=1e-3,
)

# RVEs that answer by their tangent, so that only some run.
lanes, device = both("deferred", [*SETTINGS, "engine.defer=1e-2"], "gauss/stress", most=1e-3)
deferred = [sum(np.nan_to_num(row["deferred_points"]) for row in table(folder)) for folder in (lanes, device)]
check(deferred[0] > 0 and abs(deferred[1] - deferred[0]) <= 0.2 * deferred[0], f"{deferred} points were deferred")

# Double precision: the two differ by the order of sums alone.
both("double", [*SETTINGS, 'engine.precision="double"'], "gauss/stress", "node/displacement", most=1e-6)

# Gravel: grains of three materials.
gravel = fresh("gravel")
gravel.mkdir()
(gravel / "case.toml").write_text(f'extends = ["{ROOT}/cases/column/case.toml", "{ROOT}/cases/soils/cpg_d.toml"]\n')
settings = [
    f"packing.file={DATA / 'cpg_d_400_particles.csv'}",
    "column.elements=1",
    "ground.height=3 m",
    "gravity.uniform_step=0.3",
]
both("gravel", settings, "gauss/stress", most=1e-3, case=gravel / "case.toml")

# RVEs that fail: the same failures, the same cuts, the same end.
lanes, device = fresh("failed_lanes"), fresh("failed_device")
settings = [*SETTINGS, "gravity.uniform_step=1", "newton.smallest_cut=1"]
ends = [
    subprocess.run(line, check=False, capture_output=True, text=True)
    for line in (words(lanes, settings), on_device(words(device, settings)))
]
print([end.returncode for end in ends], ends[0].stderr)
