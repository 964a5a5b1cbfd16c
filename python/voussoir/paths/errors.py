"""How far the stresses of a dataset are from those of another packing, and from those of a finer engine."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from .dataset import Dataset
from .replay import replay
from .tensors import pressure_of

Array = np.ndarray


@dataclass(frozen=True)
class Scatter:
    """Differences of stresses between packings that took the same path. `value`: root mean square over paths, points
    and the three components of the standard deviation between packings, over the mean p of the set."""

    paths: int
    value: float
    by_point: Array  # (points,) the same of each point


def relative(difference: Array, stress: Array) -> float:
    """Rms of differences of stress (..., 3) over components and everything else, over the mean pressure of `stress`."""
    return float(np.sqrt(np.nanmean(difference**2)) / np.nanmean(pressure_of(stress)))


def scatter_between_packings(data: Dataset) -> Scatter | None:
    """None: no path ran on more than one packing. Rows that held a stress are left out, because their strains
    differ."""
    path, rows = data["row/path"][:], data.rows(complete=True)
    rows = rows[~data["path/held"][:].any(axis=1)[path[rows]]]
    names, counts = np.unique(path[rows], return_counts=True)
    names = names[counts > 1]
    if not len(names):
        return None
    stress = data["stress"][:].astype(float)
    mirrored = data["row/mirrored"][:]
    groups = [rows[path[rows] == name] for name in names]
    groups = [group for group in groups if len(np.unique(mirrored[group])) == 1]
    variance = np.array([stress[group].var(axis=0, ddof=1) for group in groups])  # (paths, points, 3)
    pressure = np.nanmean(pressure_of(stress[np.concatenate(groups)]))
    return Scatter(len(groups), float(np.sqrt(variance.mean()) / pressure), np.sqrt(variance.mean((0, 2))) / pressure)


def error_of_preset(data: Dataset, packings: Any, count: int) -> tuple[int, float] | None:
    """Rows that were compared, and the rms difference of their stresses from the preset "reference", over their mean
    p."""
    rows = data.rows(complete=True)
    if count < 1 or not len(rows):
        return None
    rows = np.unique(rows[np.linspace(0, len(rows) - 1, min(count, len(rows))).astype(int)])
    kept = data["stress"][:][rows].astype(float)
    finer = replay(data, packings, rows, preset="reference", accuracy=None, tangent=None, microstructure=())
    return len(rows), relative(kept - finer, finer)
