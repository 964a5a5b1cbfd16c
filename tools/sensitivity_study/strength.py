"""The strength of the soils of a sweep, from its biaxial tests at low pressure."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from voussoir_plots.result import Missing, check_format, reading

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
    values = {name: columns[name][inside] for name in COLUMNS}

    def error(name: str) -> float:
        return float(np.nanstd(values[name], ddof=1) / np.sqrt(count))

    return Strength(
        count,
        float(np.nanmean(values["peak_angle"])),
        error("peak_angle"),
        float(np.nanmean(values["critical_angle"])),
        error("critical_angle"),
        float(np.nanmean(values["peak_strain"])),
        float(np.nanmean(values["contraction"])),
    )


def of_point(folder: Path, name: str, pressure: float) -> Strength | None:
    """Of a point of the sweep; None where it has no tests."""
    index = folder / GRID / name / "run.h5"
    if not index.exists():
        return None
    with reading(index) as file:
        check_format(file, index, "voussoir run")
        if "strength" not in file.get("tables", {}):
            raise Missing(f"{index} has no table strength")
        table = file["tables/strength"]
        columns = {column: table[column][()] for column in COLUMNS}
    return of_tests(columns, pressure)
