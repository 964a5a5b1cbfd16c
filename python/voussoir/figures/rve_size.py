"""How large an RVE must be (the study's appendix A): the coefficient of variation of the deviatoric stress over
packings of equal size, at several axial strains, and the smallest size that meets the study's bound.

A study of sizes is a group of biaxial runs of a sweep whose cases differ in the number of grains alone."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from .element_tests import Series, Test, read
from .result import Missing, remembered
from .small_samples import variation, variation_interval
from .soils import NAMES
from .sweep import Sweep

STRAINS = (0.01, 0.02, 0.05, 0.10, 0.20)  # axial [-]
BOUND = 0.1  # of the coefficient of variation
LEAST = 3  # packings without which no coefficient is told
MOST_SCATTER = 0.1  # of the lateral stress, as in host/element_tests/strength.hpp
HELD_AROUND = 0.005  # half of the range of axial strain over which that scatter is taken [-]
AROUND = 0.001  # half of the range of axial strain over which a stress is averaged [-]: the servo moves it all the time
STUDY = {"dense sand": 700, "gravel": 1500}  # grains that the study chose


@dataclass(frozen=True)
class Variation:
    """Coefficient of variation of q at one strain over n packings, with its 95 % interval; not a number where fewer
    than LEAST packings reached the strain."""

    cov: float
    low: float
    high: float
    n: int


def held_to(test: Test, strain: float) -> bool:
    """True if a test reached an axial strain and its lateral stress was held there. What happened elsewhere, such as
    an overlap beyond the law's range at the end, does not count against it."""
    axial = test.curve["axial_strain"]
    if axial[-1] < strain - AROUND:
        return False
    if "stress_xx" not in test.curve:
        return test.valid
    near = np.abs(axial - strain) <= HELD_AROUND
    # Tension is positive in the files, compression in the pressure.
    off = np.abs(test.curve["stress_xx"][near]) / test.row["pressure"] - 1
    return bool(near.any() and np.sqrt(np.mean(off**2)) <= MOST_SCATTER)


def stress_at(test: Test, strain: float) -> float:
    """q at an axial strain [Pa], the mean over a short range; not a number where the test did not come so far."""
    axial = test.curve["axial_strain"]
    if not held_to(test, strain):
        return float("nan")
    near = np.abs(axial - strain) <= AROUND
    if near.any():
        return float(test.curve["q"][near].mean())
    return float(np.interp(strain, axial, test.curve["q"]))


class SizeStudy:
    """Runs of one soil with RVEs of several sizes; the pressure is the least one of the tests."""

    def __init__(self, series: Sequence[Series]) -> None:
        self.series = sorted(series, key=lambda one: one.grains)
        self.soil = self.series[0].soil
        self.pressure = self.series[0].pressures[0]

    @property
    def label(self) -> str:
        return NAMES.get(self.soil, self.soil)

    @cached_property
    def sizes(self) -> list[int]:
        return [one.grains for one in self.series]

    def tests(self, series: Series) -> list[Test]:
        return [test for test in series.tests if test.pressure == self.pressure]

    def whole_tests(self, series: Series) -> list[Test]:
        """The tests that came to their end, for mean curves."""
        end = max(test.curve["axial_strain"][-1] for test in series.tests)
        return [test for test in self.tests(series) if held_to(test, end)]

    @cached_property
    def table(self) -> list[list[Variation]]:
        """Rows by size, columns by strain."""
        return [[self._variation(series, strain) for strain in STRAINS] for series in self.series]

    def _variation(self, series: Series, strain: float) -> Variation:
        q = np.array([stress_at(test, strain) for test in self.tests(series)])
        q = q[np.isfinite(q)]
        if len(q) < LEAST:
            return Variation(np.nan, np.nan, np.nan, len(q))
        cov = variation(q)
        return Variation(cov, *variation_interval(cov, len(q)), len(q))

    def meets(self, k: int) -> bool:
        """True where all strains of a size have a coefficient of at most BOUND."""
        return all(one.cov <= BOUND for one in self.table[k])

    def smallest(self) -> int | None:
        """The smallest size that meets the bound at all strains; None: no size does."""
        return next((size for k, size in enumerate(self.sizes) if self.meets(k)), None)

    def smallest_at(self, column: int) -> int | None:
        """The smallest size that meets the bound at one of STRAINS."""
        return next((size for size, row in zip(self.sizes, self.table) if row[column].cov <= BOUND), None)

    def smallest_not_excluded(self) -> int | None:
        """The smallest size of which no interval lies above the bound as a whole: the coefficient of a draw of more
        packings may meet it at all strains."""
        return next((size for size, row in zip(self.sizes, self.table) if all(one.low <= BOUND for one in row)), None)

    def smallest_from(self) -> int | None:
        """The size from which on all larger ones meet the bound as well."""
        found = None
        for k in reversed(range(len(self.sizes))):
            if not self.meets(k):
                break
            found = self.sizes[k]
        return found


def studies(sweep: Sweep) -> list[SizeStudy]:
    """The studies of sizes among a sweep's runs."""

    def look() -> list[SizeStudy]:
        series, left_out = read(member.folder for member in sweep.of_kind("biaxial"))
        groups: dict[str, list[Series]] = {}
        for one in series:
            groups.setdefault(_without_size(one.run.case), []).append(one)
        found = [SizeStudy(group) for group in groups.values() if len({one.grains for one in group}) > 1]
        if not found:
            further = f" ({left_out[0]})" if left_out else ""
            raise Missing(f"{sweep.folder} has no biaxial runs that differ in packing.grains alone{further}")
        return found

    return remembered(sweep, "studies of sizes", look)


def _without_size(case: dict[str, Any]) -> str:
    """A case as text, without the number of grains and what changes no number."""
    kept = {name: value for name, value in case.items() if name not in ("title", "output")}
    packing = dict(kept.get("packing", {}))
    for key in ("grains", "folder"):
        packing.pop(key, None)
    return repr(sorted({**kept, "packing": sorted(packing.items())}.items()))
