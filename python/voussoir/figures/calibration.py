"""A calibration: what its sets of parameters gave, and the surfaces through them.

As in the program (host/element_tests/calibration.hpp), each observable has a quadratic in the logarithms of the
parameters; here it goes through all usable sets with equal weights, because the whole range is shown and not the
neighbourhood of the optimum alone."""

from dataclasses import dataclass
from itertools import combinations_with_replacement

import numpy as np

from .result import Missing, RunIndex
from .units import quantity

PARAMETERS = {
    "rolling_stiffness": r"rolling stiffness  $\beta$  [-]",
    "rolling_limit": r"rolling limit  $\eta$  [-]",
    "thickness": "thickness  $t$  [m]",
}


@dataclass(frozen=True)
class Observable:
    name: str
    symbol: str
    unit: str
    factor: float  # from the file's unit
    low: float  # what the case accepts, in the file's unit
    high: float

    def met(self, value: float) -> bool:
        return self.low <= value <= self.high


def observables(run: RunIndex) -> list[Observable]:
    """The four quantities of the tests, with the ranges that the case accepts."""
    case = run.case.get("calibrate", {})

    def number(key: str) -> float:
        try:
            return quantity(case[key])
        except (KeyError, ValueError) as error:
            raise Missing(f"{run.folder / 'run.h5'}: the case has no calibrate.{key} that can be read") from error

    found = []
    for name, symbol in (
        ("peak_angle", r"$\phi_p$"),
        ("critical_angle", r"$\phi_{cs}$"),
        ("dilatancy_angle", r"$\psi_{max}$"),
    ):
        wanted, tolerance = number(name), number(f"{name}_tolerance")
        found.append(Observable(name, symbol, "deg", 180 / np.pi, wanted - tolerance, wanted + tolerance))
    low, high = number("peak_strain_minimum"), number("peak_strain_maximum")
    return [*found, Observable("peak_strain", r"$\varepsilon_a$ at the peak", "%", 100, low, high)]


def misfit(values: dict[str, np.ndarray], run: RunIndex) -> np.ndarray:
    """Sum of the squared differences from the targets, each over its tolerance, as `misfit` of the program: within its
    limits a peak strain adds nothing."""
    total: np.ndarray = np.zeros(np.shape(next(iter(values.values()))))
    for one in observables(run):
        value = values[one.name]
        if one.name == "peak_strain":
            tolerance = quantity(run.case["calibrate"].get("peak_strain_tolerance", "1 %"))
            total += (np.maximum(np.maximum(one.low - value, value - one.high), 0) / tolerance) ** 2
        else:
            total += ((value - (one.low + one.high) / 2) / ((one.high - one.low) / 2)) ** 2
    return total


def monomials(place: np.ndarray) -> np.ndarray:
    """1, x_i and x_i x_j of places (point, dimension)."""
    columns = [np.ones(len(place)), *place.T]
    columns += [place[:, i] * place[:, j] for i, j in combinations_with_replacement(range(place.shape[1]), 2)]
    return np.column_stack(columns)


class Search:
    """The sets that were tested, and the quadratics through the usable ones."""

    def __init__(self, run: RunIndex) -> None:
        self.run = run
        self.observables = observables(run)
        names = [one.name for one in self.observables]
        columns = (*PARAMETERS, *names, *(f"{name}_deviation" for name in names), "usable", "misfit")
        self.sets = run.table("search", *columns)
        self.fit = run.table("fit", *columns) if "fit" in run.tables else None
        self.usable = self.sets["usable"] > 0
        if not self.usable.any():
            raise Missing("no set of the search was usable")
        self.searched = [name for name in PARAMETERS if np.ptp(self.sets[name]) > 0]
        if not self.searched:
            raise Missing("the search had no parameter with several values")

    def places(self, sets: dict[str, np.ndarray]) -> np.ndarray:
        return np.column_stack([np.log(sets[name]) for name in self.searched])

    def surfaces(self, sets: dict[str, np.ndarray]) -> dict[str, np.ndarray] | None:
        """Each observable at other sets, or None where there are fewer usable sets than coefficients."""
        centre = self.places(self.sets).mean(axis=0)
        rows = monomials(self.places(self.sets)[self.usable] - centre)
        if len(rows) < rows.shape[1]:
            return None
        wanted = monomials(self.places(sets) - centre)
        return {
            one.name: wanted @ np.linalg.lstsq(rows, self.sets[one.name][self.usable], rcond=None)[0]
            for one in self.observables
        }

    def best(self, name: str) -> float:
        """A parameter's value at the fit, or where there is none at the best set."""
        if self.fit is not None:
            return float(self.fit[name][0])
        measured = misfit({one.name: self.sets[one.name] for one in self.observables}, self.run)
        return float(self.sets[name][np.argmin(np.where(self.usable, measured, np.inf))])

    def plane(self, size: int = 81) -> dict[str, np.ndarray]:
        """Sets over the first two searched parameters, the others as in the fit: each array is flat, row by row."""
        axes = [np.geomspace(self.sets[name].min(), self.sets[name].max(), size) for name in self.searched[:2]]
        meshes = np.meshgrid(*axes)
        fixed = {name: np.full(meshes[0].size, self.best(name)) for name in PARAMETERS}
        return {**fixed, **{name: mesh.ravel() for name, mesh in zip(self.searched, meshes)}}
