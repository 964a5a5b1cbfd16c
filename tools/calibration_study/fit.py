"""A quadratic response surface of all numbers over the logarithms of beta, of what the limit leaves of the spring and
of the thickness, by weighted least squares, and the place of the box that meets Table 2 best, for the three soils at
once or for some of them."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .plan import ANGLES, BOX, PEAK_STRAIN, SOILS, TARGETS, Set, from_unit, place_of, to_unit
from .results import Angles

Array = np.ndarray
Observable = tuple[str, str]  # soil, and "peak", "critical", "dilatancy" or "strain"
Choice = Mapping[str, str]  # the definition by which each of them is read
OBSERVABLES: list[Observable] = [(soil, kind) for soil in SOILS for kind in (*ANGLES, "strain")]
FEWEST = {1: 6, 2: 20}  # sets that a linear and a quadratic surface take
SIDE = 41  # places of the lattice along each side of the box on which the optimum is looked for


def target_of(observable: Observable) -> float:
    """The number of Table 2 [degrees]."""
    soil, kind = observable
    return TARGETS[soil][ANGLES.index(kind)]


@dataclass(frozen=True)
class Measured:
    """What the sets of a design gave for each soil: one row for each set that has a place in the box."""

    units: dict[str, Array]  # of a soil: (set, 3), places in the unit box
    values: dict[Observable, Array]  # (set,), nan where it is missing
    errors: dict[Observable, Array]  # standard errors over the packings

    def packing_deviation(self, observable: Observable, packings: int) -> float:
        """The typical standard deviation of a single packing: the root mean square over the sets."""
        errors = self.errors[observable]
        errors = errors[np.isfinite(errors)]
        return float(np.sqrt(np.mean(errors**2) * packings)) if len(errors) else float("nan")


def measured(sets: Iterable[Set], results: Mapping[str, Mapping[str, Angles]], choice: Choice) -> Measured:
    """The rows of all sets; each set counts once, and so does each place of a soil."""
    units: dict[str, Array] = {}
    values: dict[Observable, Array] = {}
    errors: dict[Observable, Array] = {}
    by_name = {one.name: one for one in sets}
    for soil in SOILS:
        rows: dict[tuple[float, float, float], Angles] = {}
        for name, one in by_name.items():
            place = place_of(soil, one.soils[soil]) if soil in one.soils else None
            if place is not None and soil in results.get(name, {}):
                rows.setdefault(place, results[name][soil])
        units[soil] = np.array([to_unit(place) for place in rows]).reshape(-1, len(BOX))
        for kind in (*ANGLES, "strain"):
            chosen = [angles[kind][choice[kind]] for angles in rows.values()]
            values[soil, kind] = np.array([value.mean for value in chosen])
            errors[soil, kind] = np.array([value.error for value in chosen])
    return Measured(units, values, errors)


def features(units: Array) -> Array:
    """(..., 3): the place with its second coordinate replaced by ln(limit / (limit + beta^0.75)), which saturates where
    the spring is too soft to reach the limit. Leave-one-out errors of the surfaces are a fifth smaller with it than
    with the logarithm of the limit."""
    low, high = (np.array([side[k] for side in BOX.values()]) for k in (0, 1))
    beta, limit = (low[k] * (high[k] / low[k]) ** units[..., k] for k in (0, 1))
    return np.stack([units[..., 0], np.log(limit / (limit + beta**0.75)), units[..., 2]], axis=-1)


def monomials(units: Array, order: int) -> Array:
    """1, x_i and, of order 2, x_i x_j of the features at places (..., 3) -> (..., 4 or 10)."""
    x = list(np.moveaxis(features(units), -1, 0))
    products = [x[i] * x[j] for i in range(len(x)) for j in range(i + 1)] if order == 2 else []
    return np.stack([np.ones_like(x[0]), *x, *products], axis=-1)


@dataclass(frozen=True)
class Surface:
    """One number over the box."""

    order: int  # 2, or 1 where too few sets have the number
    coefficients: Array  # (4,) or (10,)
    covariance: Array
    misfit: float  # weighted root mean square of the residuals over their standard errors [-]
    left_out: float  # the same of a set that is left out, in degrees or % of strain

    def at(self, units: Array) -> Array:
        return np.asarray(monomials(units, self.order) @ self.coefficients)

    def error_at(self, units: Array) -> Array:
        m = monomials(units, self.order)
        return np.sqrt(np.maximum(np.einsum("...i,ij,...j->...", m, self.covariance, m), 0.0))

    def per_doubling(self, unit: Array, k: int) -> tuple[float, float]:
        """What doubling parameter `k` changes around a place, and its standard error."""
        low, high = list(BOX.values())[k]
        step = 0.05
        ends = np.stack([unit, unit])
        ends[:, k] += [-step, step]
        m = monomials(ends, self.order)
        difference = (m[1] - m[0]) / (2 * step * np.log2(high / low))
        return float(difference @ self.coefficients), float(np.sqrt(difference @ self.covariance @ difference))


def surface(data: Measured, observable: Observable, centre: Array, reach: float) -> Surface:
    """Weights are 1/(standard error)^2, and fall with the distance from `centre` over `reach` [unit box]. A standard
    error of a few packings is itself uncertain: half of its square is taken from the mean of all sets. Where the
    residuals are larger than the errors explain, the covariance grows with them."""
    y, own = data.values[observable], data.errors[observable]
    good = np.isfinite(y) & np.isfinite(own)
    y, own, units = y[good], own[good], data.units[observable[0]][good]
    if len(y) < FEWEST[1]:
        raise ValueError(f"{len(y)} sets have {observable[1]} of {observable[0]}; a surface takes {FEWEST[1]}")
    order = 2 if len(y) >= FEWEST[2] else 1
    variance = 0.5 * (own**2 + np.mean(own**2)) + 1e-4
    weight = np.exp(-0.5 * np.sum((units - centre) ** 2, axis=1) / reach**2) / variance
    terms = monomials(units, order)
    rows = terms * np.sqrt(weight)[:, None]
    inverse = np.linalg.pinv(rows.T @ rows)
    influence = np.einsum("ki,ij,kj->k", rows, inverse, rows)
    coefficients = inverse @ rows.T @ (y * np.sqrt(weight))
    near = weight * variance
    residuals = (y - terms @ coefficients) / np.sqrt(variance)
    free = max(float(near.sum()) - terms.shape[1], 1.0)
    misfit = float(np.sqrt(np.sum(near * residuals**2) / free))
    left_out = (y - terms @ coefficients) / np.maximum(1.0 - influence, 0.05)
    spread = float(np.sqrt(np.average(left_out**2, weights=near)))
    return Surface(order, coefficients, inverse * max(misfit, 1.0) ** 2, misfit, spread)


@dataclass(frozen=True)
class Optimum:
    """The best place, its expected numbers, and how far each parameter may move."""

    place: tuple[float, float, float]
    chi_squared: float
    numbers: int  # how many of them entered it
    intervals: list[tuple[float, float]]  # of beta, limit and thickness: chi^2 rises by no more than 1 (68 %)
    expected: dict[Observable, tuple[float, float]]
    surfaces: dict[Observable, Surface]


def chi_squared(surfaces: Mapping[Observable, Surface], units: Array, deviations: Mapping[Observable, float], *,
                keep_peak: bool) -> Array:  # fmt: skip
    """Sum of squared differences from Table 2, each over the scatter of one packing, because Table 2 is of one packing.
    The surface's own error is left out, or places would win of which little is known. `keep_peak` adds what the axial
    strain at the peak of a dense soil is beyond its limits."""
    total = np.zeros(units.shape[:-1])
    for observable, fitted in surfaces.items():
        soil, kind = observable
        value = fitted.at(units)
        if kind != "strain":
            total += ((value - target_of(observable)) / deviations[observable]) ** 2
        elif keep_peak and soil in PEAK_STRAIN:
            low, high = PEAK_STRAIN[soil]
            total += np.maximum(np.maximum(low - value, value - high), 0.0) ** 2
    return total


def optimum(data: Measured, soils: Sequence[str], *, packings: int, keep_peak: bool = True, reach: float = 0.7
            ) -> Optimum:  # fmt: skip
    """Done three times: the weights of the surface follow the place that the surface had before."""
    wanted = [o for o in OBSERVABLES if o[0] in soils]
    deviations = {o: data.packing_deviation(o, packings) for o in wanted}
    axis = np.linspace(0, 1, SIDE)
    lattice = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1)
    centre = np.full(3, 0.5)
    for width in (9.0, reach, reach):
        surfaces = {o: surface(data, o, centre, width) for o in wanted}
        chi = chi_squared(surfaces, lattice, deviations, keep_peak=keep_peak)
        best = np.unravel_index(int(np.argmin(chi)), chi.shape)
        centre = lattice[best]
    least = float(chi[best])
    intervals = []
    for k, side in enumerate(BOX.values()):
        others = tuple(j for j in range(3) if j != k)
        inside = axis[chi.min(axis=others) <= least + 1.0]
        low, high = (side[0] * (side[1] / side[0]) ** float(u) for u in (inside[0], inside[-1]))
        intervals.append((low, high))
    expected = {o: (float(s.at(centre)), float(s.error_at(centre))) for o, s in surfaces.items()}
    return Optimum(from_unit(centre), least, sum(o[1] != "strain" for o in wanted), intervals, expected, surfaces)
