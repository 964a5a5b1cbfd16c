"""RVEs on a device, which is the host here (tests/emulated_gpu): the program opens its library, and a column has the
lanes' answers within rounding. Without the library, and with one that has no device, the lanes' bits stay."""

import os
import subprocess

import h5py
import numpy as np
from devices import EMULATED, far_from, last, log_of, on_device, small_column, with_environment
from program import PROGRAM, check, check_same, command, fresh, run

SETTINGS = small_column()


def devices(**environment):
    out = subprocess.run(
        [PROGRAM, "info", "--devices"], check=False, capture_output=True, text=True, env=os.environ | environment
    )
    check(out.returncode == 0, f"info --devices ended with {out.returncode}: {out.stderr}")
    return out.stdout


# What the search for devices says.
check("devices: none: there is no " in devices(VOUSSOIR_GPU_LIBRARY="/no/such/library.so"), "no library is not said")
check("device 0: emulated device 0" in devices(**EMULATED), "the emulated device is not named")
two = devices(**EMULATED, VOUSSOIR_EMULATED_GPUS="2")
check("device 1: emulated device 1" in two, "the second device is not named")
none = devices(**EMULATED, VOUSSOIR_EMULATED_GPUS="0")
check("devices: none: the driver knows no device" in none, f"a library without devices says {none}")
wrong = devices(VOUSSOIR_GPU_LIBRARY=PROGRAM)
check(
    "devices: none: the library cannot be opened" in wrong or "another version" in wrong, f"a wrong file says {wrong}"
)

# Without a device nothing changes; whoever asks for one is told that there is none.
lanes = fresh("lanes")
run(command("column", lanes, SETTINGS))
deviceless = fresh("deviceless")
run(with_environment(command("column", deviceless, SETTINGS), **EMULATED, VOUSSOIR_EMULATED_GPUS="0"))
check_same(lanes, deviceless)
asked = fresh("asked")
words = command("column", asked, [*SETTINGS, 'engine.backend="gpu"'])
refused = subprocess.run(words, check=False, capture_output=True, text=True)
check(
    refused.returncode == 2 and "none can be used" in refused.stderr, f"a missing device is not said: {refused.stderr}"
)
check(not asked.exists(), "a case that was refused has left a folder")
by_lanes, ignored = [*SETTINGS, 'engine.backend="lanes"'], fresh("ignored")
run(command("column", asked, by_lanes))
run(on_device(command("column", ignored, by_lanes)))
check("device" not in log_of(ignored), "the log speaks of a device that the case does not want")
check_same(asked, ignored)

# On the device: the log and the results say so, and the ground moves as with lanes.
device = fresh("device")
run(on_device(command("column", device, SETTINGS)))
check("grains on the device emulated device 0" in log_of(device), "the log does not name the device")
for folder, name in ((device, "emulated device 0"), (lanes, "none")):
    said = run([PROGRAM, "info", str(folder / "run.h5")]).stdout
    check(f"device: {name}\n" in said, f"{folder}: the results do not say the device {name}: {said}")
check(last(device).name == last(lanes).name, "the device took another number of increments")
off = far_from(lanes, device, "node/displacement")
print(f"displacements of the device are off by {off:.1e} of the largest")
check(0 < off < 0.05, "displacements on the device are not those of lanes within repeats")

# The contact networks that the device describes by itself. In double the answers differ by rounding, but Newton's paths
# differ by the tolerance of the tangents, 1e-4 of the stress, so that a few contacts open or close and are strong or
# not: in this column of few points the rms difference is at most 0.015 of a field's largest value. The bits are
# compared in unit tests.
NETWORK = [
    "fabric_anisotropy",
    "fabric_direction",
    "mechanical_coordination",
    "strong_coordination_1",
    "strong_coordination_2",
    "void_ratio",
    "grain_rotation",
    "coordination",
]
EXACT = [*SETTINGS, "engine.precision=double", 'output.microstructure=["fabric", "coordination", "strong_networks"]']
differing = 0
lanes_in_double, device_in_double = fresh("lanes_in_double"), fresh("device_in_double")
run(command("column", lanes_in_double, EXACT))
run(on_device(command("column", device_in_double, EXACT)))
with h5py.File(last(lanes_in_double)) as a, h5py.File(last(device_in_double)) as b:
    for name in NETWORK:
        expected, found = a[f"gauss/{name}"][:], b[f"gauss/{name}"][:]
        largest = np.abs(expected).max()
        rms = np.sqrt(np.mean((found - expected) ** 2)) / largest
        print(f"{name}: off by {rms:.1e} (rms) of the largest, {largest:.1e}")
        check(largest > 0, f"{name} is 0 everywhere: the test shows nothing")
        differing += rms > 0
        check(rms < 0.05, f"{name} is not that of the lanes")
check(differing > 0, "nothing differs: the device has not described the networks")

# The same bits again.
again = fresh("again")
run(on_device(command("column", again, SETTINGS)))
check_same(device, again)
