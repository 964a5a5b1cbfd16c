"""Datasets of strain paths: grains take many paths, and one file holds what they answered.

    from voussoir import make_packings, paths

    packings = make_packings(8)
    data = paths.generate("set.h5", {"random": paths.random(512, 50), "cyclic": paths.cyclic(50, 0.004)}, packings)
    stress = data["stress"][:]        # (rows, points, 3) [Pa], tension positive

A path is an array of displacement gradients F - I, one an increment, each counted from the state that was committed
before it; the functions `random`, `stratified`, `prescribed`, `undrained`, `biaxial`, `cyclic` and `rotating` make
such arrays (n, increments, 2, 2). `drained` makes paths that hold a stress. The page docs/how-to/make_a_dataset.md
shows all of it."""

try:
    import h5py as _h5py  # noqa: F401
except ImportError as _missing:
    raise ImportError("voussoir.paths needs h5py: pip install 'voussoir[files]'") from _missing

from .control import StressControl
from .dataset import Dataset, open_dataset
from .draws import random, stratified
from .errors import relative, scatter_between_packings
from .families import biaxial, cyclic, drained, prescribed, rotating, undrained
from .fields import BY_NAME as FIELDS
from .generation import generate
from .replay import replay
from .schedule import Paths, as_paths
from .tensors import compose, gradient_of_strain, pressure_of, strain_of_gradient, totals

__all__ = [
    "FIELDS",
    "Dataset",
    "Paths",
    "StressControl",
    "as_paths",
    "biaxial",
    "compose",
    "cyclic",
    "drained",
    "generate",
    "gradient_of_strain",
    "open_dataset",
    "prescribed",
    "pressure_of",
    "random",
    "relative",
    "replay",
    "rotating",
    "scatter_between_packings",
    "strain_of_gradient",
    "stratified",
    "totals",
    "undrained",
]
