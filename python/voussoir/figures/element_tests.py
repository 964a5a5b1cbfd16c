"""Drained biaxial tests of a run of kind `biaxial`: curves of all packings and pressures, and the angles of strength
with their standard errors."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from .result import Missing, RunIndex, Unreadable
from .small_samples import jackknife, standard_error
from .soils import NAMES

STRENGTH = ("seed", "pressure", "peak_angle", "critical_angle", "dilatancy_angle", "peak_strain", "contraction")
CURVE = ("axial_strain", "volumetric_strain", "p", "q")


@dataclass
class Test:
    """One test; the angles in rad, compression and contraction positive."""

    seed: int
    pressure: float  # that was wanted [Pa]; row has the one that the packing came to
    valid: bool
    row: dict[str, float]  # of the table `strength`
    curve: dict[str, np.ndarray]

    def at(self, strain: np.ndarray, name: str) -> np.ndarray:
        """A column of the curve, or "q_over_p", at axial strains; not a number beyond the test's end."""
        axial = self.curve["axial_strain"]
        values = self.curve["q"] / self.curve["p"] if name == "q_over_p" else self.curve[name]
        return np.interp(strain, axial, values, right=np.nan)


class Series:
    """The tests of one run."""

    def __init__(self, run: RunIndex) -> None:
        self.run = run
        self.soil = run.soil  # one of NAMES only where it is the study's
        table = run.table("strength", *STRENGTH)
        valid = table.get("valid", np.ones(len(table["seed"])))  # files of the first versions lack it
        self.tests: list[Test] = []
        for k in range(len(table["seed"])):
            row = {name: float(values[k]) for name, values in table.items()}
            name, pressure = _curve_name(run, int(row["seed"]), row["pressure"])
            curve = run.table(name, *CURVE)
            if len(curve["q"]) > 1:
                self.tests.append(Test(int(row["seed"]), pressure, bool(valid[k] > 0), row, curve))
        if not self.tests:
            raise Missing(f"{run.folder} has no test with a curve")

    @cached_property
    def pressures(self) -> list[float]:
        return sorted({test.pressure for test in self.tests})

    @cached_property
    def valid(self) -> list[Test]:
        """The tests that reached their end with the lateral stress held; only these have a strength."""
        return [test for test in self.tests if test.valid]

    @cached_property
    def grains(self) -> int:
        return int(self.run.case.get("packing", {}).get("grains", 0))

    def of_pressure(self, pressure: float) -> list[Test]:
        return [test for test in self.valid if test.pressure == pressure]

    def strain_grid(self) -> np.ndarray:
        """Axial strains that all curves of the run reach or may reach, evenly spaced."""
        return np.linspace(0, max(test.curve["axial_strain"][-1] for test in self.tests), 401)

    def angle(self, name: str) -> tuple[float, float]:
        """(angle, its standard error) [rad] over the packings of the valid tests; not a number where there are none.

        sin phi is the slope of a line q against p through the origin over all tests, as in
        host/element_tests/strength.cpp; the dilatancy is the mean of the tests. The error is by leaving out one packing
        at a time."""
        groups = [
            np.array([[test.row["pressure"], test.row[name]] for test in tests])
            for tests in _by_seed(test for test in self.valid if np.isfinite(test.row[name]))
        ]
        if not groups:
            return np.nan, np.nan
        return jackknife(groups, _mean_angle if name == "dilatancy_angle" else common_angle)

    def mean_of(self, name: str) -> tuple[float, float]:
        """(mean over the packings, its standard error) of another column of `strength`."""
        means = np.array([np.mean([test.row[name] for test in tests]) for tests in _by_seed(self.valid)])
        return (float(means.mean()), standard_error(means)) if len(means) else (np.nan, np.nan)


def _curve_name(run: RunIndex, seed: int, pressure: float) -> tuple[str, float]:
    """Name of the curve of a test and the pressure in this name [Pa], which is the one that was wanted."""
    found = [re.fullmatch(rf"seed_{seed}_(\S+)_kPa", name) for name in run.tables]
    wanted = {float(name[1]) * 1e3: name[0] for name in found if name}
    if not wanted:
        raise Missing(f"{run.folder / 'run.h5'} has no curve of seed {seed}")
    nearest = min(wanted, key=lambda value: abs(value - pressure))
    return wanted[nearest], nearest


def common_angle(rows: np.ndarray) -> float:
    """The angle of the line q against p through the origin that fits tests (pressure, angle) [Pa, rad] at the moments
    at which they have these angles: there p = pressure / (1 - sin(angle)) and q = p sin(angle)."""
    sine = np.sin(rows[:, 1])
    p = rows[:, 0] / (1 - sine)
    return float(np.arcsin(min(np.sum(p * p * sine) / np.sum(p * p), 1.0)))


def _mean_angle(rows: np.ndarray) -> float:
    """From the mean sine of the tests, as host/element_tests/calibrate_tests.cpp has it."""
    return float(np.arcsin(np.sin(rows[:, 1]).mean()))


def _by_seed(tests: Iterable[Test]) -> list[list[Test]]:
    found: dict[int, list[Test]] = {}
    for test in tests:
        found.setdefault(test.seed, []).append(test)
    return list(found.values())


def labels(all_series: Sequence[Series]) -> list[str]:
    """Short names for legends: the study's name of its soils, and the folder where two runs have one soil."""
    soils = [NAMES.get(series.soil, series.soil) for series in all_series]
    return [
        soil if soils.count(soil) == 1 else f"{soil} ({series.run.folder.resolve().name})"
        for soil, series in zip(soils, all_series)
    ]


def read(folders: Iterable[Path]) -> tuple[list[Series], list[Missing]]:
    """The series that can be read, in the order of the study's soils and then of their sizes, and why others cannot."""
    found: list[Series] = []
    left_out: list[Missing] = []
    for folder in folders:
        try:
            run = RunIndex(folder)
            if run.kind != "biaxial":
                raise Unreadable(f"{folder} is a run of kind {run.kind}; only runs of kind biaxial are drawn together")
            found.append(Series(run))
        except Missing as reason:
            left_out.append(reason)
    order = list(NAMES)
    place = {soil: k for k, soil in enumerate(order)}
    return sorted(found, key=lambda series: (place.get(series.soil, len(order)), series.grains)), left_out
