"""Checkpoints between device and lanes: whoever goes on, goes on from the states that were written."""

import signal

import h5py
from devices import far_from, log_of, on_device, small_column
from program import check, check_same, command, fresh, run, start_and_signal

SETTINGS = small_column(elements=4, step=0.05)


def words(folder, *further):
    return command("column", folder, SETTINGS, "--threads", "1", *further)


def stopped(name, begin):
    """A copy of a run that was stopped after some increments."""
    folder = fresh(name)
    code = start_and_signal(begin(words(folder)), folder / "increments/0004.h5", signal.SIGTERM)
    check(code == 130, f"{name}: a run stopped by SIGTERM ended with {code}")
    return folder


def by_lanes(line):
    return line


lanes, device = fresh("lanes"), fresh("device")
run(words(lanes))
run(on_device(words(device)))

# On the device all the way: the same bits.
folder = stopped("device_device", on_device)
run(on_device(words(folder, "--resume")))
check_same(device, folder)

# From one to the other: the log names both, the numbers are those of either.
for name, begin, end in (("device_lanes", on_device, by_lanes), ("lanes_device", by_lanes, on_device)):
    folder = stopped(name, begin)
    named = log_of(folder).count("grains on the device emulated device 0")
    check(named == (1 if begin is on_device else 0), f"{name}: the log names the device {named} times")
    run(end(words(folder, "--resume")))
    for straight in (lanes, device):
        off = far_from(straight, folder, "gauss/stress")
        print(f"{name}: stresses are off by {off:.1e} from {straight}")
        check(0 < off < 1e-3, f"{name}: stresses are off by {off:.1e} from {straight}")
    with h5py.File(folder / "run.h5") as file:
        origin = file["provenance"].attrs["device"]
    expected = "emulated device 0" if begin is on_device else "none"
    check(origin.decode() == expected if isinstance(origin, bytes) else origin == expected, f"{name}: {origin}")
