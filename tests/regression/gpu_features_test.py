"""What a case may ask for, on the device that is the host: each feature answers as with lanes, and what a device cannot
do is left to lanes or refused."""

import numpy as np
from devices import far_from, log_of, on_device, small_column
from program import PROGRAM, ROOT, check, check_same, command, fresh, run, table

GPU = 'engine.backend="gpu"'
DATA = ROOT / "tests/data/packings"
SETTINGS = small_column(step=0.1, candidates=3)


def words(folder, settings, *further, case="column"):
    return command(case, folder, settings, "--threads", "1", *further)


def check_of(settings):
    line = [PROGRAM, "check", str(ROOT / "cases/column/case.toml")]
    return line + [word for setting in settings for word in ("--set", setting)]


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
    "gauss/fabric_anisotropy",
    "snapshots/point_00002/x",
    most=1e-3,
)

# RVEs that answer by their tangent, so that only some run.
lanes, device = both("deferred", [*SETTINGS, "engine.defer=1e-2"], "gauss/stress", most=1e-3)
deferred = [sum(np.nan_to_num(row["deferred_points"]) for row in table(folder)) for folder in (lanes, device)]
check(deferred[0] > 0 and abs(deferred[1] - deferred[0]) <= 0.2 * deferred[0], f"{deferred} points were deferred")

# Double precision: two orders of the same sums (measured 1e-12), until grains that slip multiply the difference. Static
# tangents are iterated, so that with them Newton comes to rest elsewhere within its tolerance.
settings = [*SETTINGS, 'engine.precision="double"', 'newton.tangent="contact"']
lanes, device = both("double", settings, "gauss/stress", "node/displacement", most=3e-4)
off = far_from(lanes, device, "gauss/stress", increment=3)
check(0 < off < 1e-11, f"stresses in double are off by {off:.1e} after three increments")

# Gravel: grains of three materials.
gravel = fresh("gravel")
gravel.mkdir()
(gravel / "case.toml").write_text(f'extends = ["{ROOT}/cases/column/case.toml", "{ROOT}/cases/soils/cpg_d.toml"]\n')
settings = [
    f"packing.file={DATA / 'cpg_d_400_particles.csv'}",
    "column.elements=2",
    "ground.height=4 m",
    "gravity.uniform_step=0.3",
]
both("gravel", settings, "gauss/stress", most=1e-3, case=gravel.resolve())

# What a device does not compute: lanes run and the log says why, or the case is refused before anything is written.
loading = [*SETTINGS, 'newton.tangent="loading"']
lanes, device, asked = fresh("loading_lanes"), fresh("loading_auto"), fresh("loading_asked")
run(words(lanes, loading))
run(on_device(words(device, loading)))
check_same(lanes, device)
reason = "grains by lanes: device 0 is not used: a device does not compute loading tangents"
check(reason in log_of(device) and reason not in log_of(lanes), "the log does not say why lanes run")
for line in (words(asked, [*loading, GPU]), check_of([*loading, GPU])):
    said = run(on_device(line), code=2)
    check("newton.tangent" in said.stderr and "loading" in said.stderr, f"loading is refused with {said.stderr}")
check(not asked.exists(), "a case that was refused has left a folder")

# Nor is there anything to ask for where there is no device.
for line in (words(asked, [*SETTINGS, GPU]), check_of([*SETTINGS, GPU])):
    said = run(line, code=2)
    check("engine.backend" in said.stderr and "none can be used" in said.stderr, f"no device: {said.stderr}")

# A device without room for the RVEs: lanes run and the log says why; whoever asks for the device is told.
lanes, full = fresh("plain"), fresh("full")
run(words(lanes, SETTINGS))
run(on_device(words(full, SETTINGS), VOUSSOIR_EMULATED_ROOM=3))
check_same(lanes, full)
reason = "grains by lanes: the device emulated device 0 is not used: the device has no memory left"
check(reason in log_of(full), "the log does not say that the device has no room")
said = run(on_device(words(asked, [*SETTINGS, GPU]), VOUSSOIR_EMULATED_ROOM=3), code=4)
check("the device has no memory left" in said.stderr, f"a device without room says {said.stderr}")
