"""The device that is the host, for the tests of RVEs on devices."""

import os

import h5py
import numpy as np

LIBRARY = os.environ["VOUSSOIR_EMULATED_GPU"]
EMULATED = {"VOUSSOIR_GPU_LIBRARY": LIBRARY}


def with_environment(words, **environment):
    return ["env", *(f"{name}={value}" for name, value in environment.items()), *words]


def on_device(words, **environment):
    """A command with one emulated device, or with as many as VOUSSOIR_EMULATED_GPUS says."""
    return with_environment(words, **EMULATED, **environment)


def last(folder):
    return max((folder / "increments").glob("*.h5"))


def log_of(folder):
    return (folder / "run.log").read_text()


def far_from(lanes, device, field):
    """The largest difference of a field at the end of two runs, over the largest value."""
    with h5py.File(last(lanes)) as a, h5py.File(last(device)) as b:
        expected, found = a[field][()], b[field][()]
    return np.abs(found - expected).max() / np.abs(expected).max()
