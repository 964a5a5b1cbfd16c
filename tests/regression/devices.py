"""The device that is the host, for the tests of RVEs on devices."""

import os

import h5py
import numpy as np

LIBRARY = os.environ["VOUSSOIR_EMULATED_GPU"]
EMULATED = {"VOUSSOIR_GPU_LIBRARY": LIBRARY}


def small_column(elements=3, step=0.2, candidates=1):
    """Settings of a column that is short on the emulated device, which is slow."""
    return [
        "packing.grains=60",
        f"packing.candidates={candidates}",
        "packing.folder=packings",
        f"column.elements={elements}",
        f"gravity.uniform_step={step}",
    ]


def with_environment(words, **environment):
    return ["env", *(f"{name}={value}" for name, value in environment.items()), *words]


def on_device(words, **environment):
    """A command with one emulated device, or with as many as VOUSSOIR_EMULATED_GPUS says."""
    return with_environment(words, **EMULATED, **environment)


def last(folder):
    return max((folder / "increments").glob("*.h5"))


def log_of(folder):
    return (folder / "run.log").read_text()


def far_from(lanes, device, field, increment=None):
    """The largest difference of a field of two runs, over the largest value: at their end, or at an increment."""
    files = [
        last(folder) if increment is None else folder / f"increments/{increment:04d}.h5" for folder in (lanes, device)
    ]
    with h5py.File(files[0]) as a, h5py.File(files[1]) as b:
        expected, found = a[field][()], b[field][()]
    return np.abs(found - expected).max() / np.abs(expected).max()
