"""RVEs on a device, which is the host here (tests/emulated_gpu): the program opens its library, and a tunnel has the
lanes' answers within rounding. Without the library, and with one that has no device, the lanes' bits stay."""

import os
import subprocess

import h5py
import numpy as np
from program import PROGRAM, SMALL_TUNNEL, check, check_same, command, fresh, run

LIBRARY = os.environ["VOUSSOIR_EMULATED_GPU"]
EMULATED = {"VOUSSOIR_GPU_LIBRARY": LIBRARY}
SETTINGS = [*SMALL_TUNNEL, "packing.grains=100", "volume_loss.increments=2"]


def devices(**environment):
    out = subprocess.run([PROGRAM, "info", "--devices"], check=False, capture_output=True, text=True, env=os.environ | environment)
    check(out.returncode == 0, f"info --devices ended with {out.returncode}: {out.stderr}")
    return out.stdout


def with_environment(words, **environment):
    return ["env", *(f"{name}={value}" for name, value in environment.items()), *words]


def last(folder):
    return sorted((folder / "increments").glob("*.h5"))[-1]


# What the search for devices says.
check("devices: none: there is no " in devices(VOUSSOIR_GPU_LIBRARY="/no/such/library.so"), "no library is not said")
check("device 0: emulated device 0" in devices(**EMULATED), "the emulated device is not named")
two = devices(**EMULATED, VOUSSOIR_EMULATED_GPUS="2")
check("device 1: emulated device 1" in two, "the second device is not named")
none = devices(**EMULATED, VOUSSOIR_EMULATED_GPUS="0")
check("devices: none: the driver knows no device" in none, f"a library without devices says {none}")
wrong = devices(VOUSSOIR_GPU_LIBRARY=PROGRAM)
check("devices: none: the library cannot be opened" in wrong or "another version" in wrong, f"a wrong file says {wrong}")

# Without a device nothing changes; whoever asks for one is told that there is none.
lanes = fresh("lanes")
run(command("tunnel_quick", lanes, SETTINGS))
deviceless = fresh("deviceless")
run(with_environment(command("tunnel_quick", deviceless, SETTINGS), **EMULATED, VOUSSOIR_EMULATED_GPUS="0"))
check_same(lanes, deviceless)
asked = fresh("asked")
words = command("tunnel_quick", asked, [*SETTINGS, 'engine.backend="gpu"'])
refused = subprocess.run(words, check=False, capture_output=True, text=True)
check(refused.returncode != 0 and "no device is there" in refused.stderr, f"a missing device is not said: {refused.stderr}")
by_lanes = [*SETTINGS, 'engine.backend="lanes"']
unseen = fresh("unseen")
run(command("tunnel_quick", unseen, by_lanes))
ignored = fresh("ignored")
run(with_environment(command("tunnel_quick", ignored, by_lanes), **EMULATED))
check_same(unseen, ignored)

# On the device: the log says so, and the ground moves as with lanes.
device = fresh("device")
run(with_environment(command("tunnel_quick", device, SETTINGS), **EMULATED))
check("grains on the device emulated device 0" in (device / "run.log").read_text(), "the log does not name the device")
check(last(device).name == last(lanes).name, "the device took another number of increments")
with h5py.File(last(lanes)) as a, h5py.File(last(device)) as b:
    expected, found = a["node/displacement"][:], b["node/displacement"][:]
largest = np.abs(expected).max()
off = np.abs(found - expected).max() / largest
print(f"displacements of the device are off by {off:.1e} of the largest, {largest:.3e} m")
check(0 < off < 0.05, "displacements on the device are not those of lanes within repeats")

# The contact networks that the device describes by itself. In double the answers differ by rounding, but Newton's
# paths differ by the tolerance of the tangents, 1e-4 of the stress, so that a few contacts open, close or become strong:
# the measured rms difference is at most 0.006 of a field's largest value, and 0.1 where a network has few grains at
# all. The bits are compared in unit tests.
NETWORK = [
    "fabric_anisotropy",
    "fabric_direction",
    "mechanical_coordination",
    "strong_coordination_1",
    "strong_coordination_2",
    "strong_coordination_2_5",
    "void_ratio",
    "grain_rotation",
    "coordination",
]
EXACT = [
    *SETTINGS,
    "engine.precision=double",
    'output.microstructure=["fabric", "coordination", "strong_networks"]',
    "volume_loss.increments=1",
]
lanes_in_double, device_in_double = fresh("lanes_in_double"), fresh("device_in_double")
run(command("tunnel_quick", lanes_in_double, EXACT))
run(with_environment(command("tunnel_quick", device_in_double, EXACT), **EMULATED))
with h5py.File(last(lanes_in_double)) as a, h5py.File(last(device_in_double)) as b:
    for name in NETWORK:
        expected, found = a[f"gauss/{name}"][:], b[f"gauss/{name}"][:]
        largest = np.abs(expected).max()
        rms = np.sqrt(np.mean((found - expected) ** 2)) / largest
        print(f"{name}: off by {rms:.1e} (rms) of the largest, {largest:.1e}")
        check(largest > 0, f"{name} is 0 everywhere: the test shows nothing")
        check(0 < rms < (0.2 if name == "strong_coordination_2_5" else 0.02), f"{name} is not that of the lanes")

# The same bits again, and after a stop: states come down for the checkpoint and go up again.
again = fresh("again")
run(with_environment(command("tunnel_quick", again, SETTINGS), **EMULATED))
check_same(device, again)
