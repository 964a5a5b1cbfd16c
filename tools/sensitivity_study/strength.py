"""The strength of the soils of a sweep, from its biaxial tests at low pressure."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from voussoir.figures.result import RunIndex
from voussoir.figures.small_samples import standard_error

GRID = "strength"  # of the sweep
COLUMNS = ("pressure", "valid", "peak_angle", "critical_angle", "peak_strain", "contraction")


@dataclass(frozen=True)
class Strength:
    """Means over the valid tests at one pressure, and standard errors."""

    count: int
    peak: float  # peak friction angle [rad]
    peak_error: float
    critical: float  # [rad]
    critical_error: float
    peak_strain: float  # axial strain at the peak [-]
    contraction: float  # the largest of the test [-]


def of_tests(columns: Mapping[str, np.ndarray], pressure: float) -> Strength | None:
    """None where fewer than two tests at this pressure [Pa] are valid."""
    inside = np.isclose(columns["pressure"], pressure, rtol=0.01) & (columns["valid"] > 0)
    count = int(inside.sum())
    if count < 2:
        return None
    known = {name: columns[name][inside & np.isfinite(columns[name])] for name in COLUMNS}

    def mean(name: str) -> float:
        return float(np.mean(known[name])) if len(known[name]) else float("nan")

    return Strength(
        count,
        mean("peak_angle"),
        standard_error(known["peak_angle"]),
        mean("critical_angle"),
        standard_error(known["critical_angle"]),
        mean("peak_strain"),
        mean("contraction"),
    )


def of_point(folder: Path, name: str, pressure: float) -> Strength | None:
    """Of a point of the sweep; None where it has no tests."""
    run = folder / GRID / name
    return of_tests(RunIndex(run).table("strength", *COLUMNS), pressure) if (run / "run.h5").exists() else None
