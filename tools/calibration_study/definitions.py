"""What the three angles of a table of strengths may mean: definitions of phi_p, phi_cs and psi_max, all read from the
same curves of drained biaxial tests. Compression is positive, angles are in degrees, sin(phi) = q/p with
p = (s1 + s3)/2 and q = (s1 - s3)/2, and the shear strain is gamma = e1 - e3 (equations 8 to 11 of the study).

Every definition takes the tests of several packings. A value is read from each test, averaged over the packings at each
pressure, and then joined over the pressures. Tests that broke off count for what they reached."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from voussoir.figures.element_tests import common_angle
from voussoir.figures.small_samples import jackknife_error

from .plan import PRESSURES

Array = np.ndarray
NAN = float("nan")
END = 0.199  # axial strain of a test that came to its end [-]


@dataclass(frozen=True)
class Test:
    """The curve of one test: arrays over its points."""

    seed: int
    pressure: float  # on x [Pa]
    axial: Array  # logarithmic strain [-]
    volumetric: Array  # [-], contraction is positive
    shear: Array  # e1 - e3 [-]
    p: Array  # [Pa]
    q: Array  # [Pa]

    @property
    def reached(self) -> float:
        return float(self.axial[-1])


Definition = Callable[[Sequence[Test]], float]


def _starts_and_ends(x: Array, window: float) -> tuple[Array, Array, Array]:
    """For each point of `x` that has a whole window around it: its index, and the first and the end of the points in
    the window."""
    inside = np.flatnonzero((x - 0.5 * window >= x[0] - 1e-12) & (x + 0.5 * window <= x[-1] + 1e-12))
    return (inside, np.searchsorted(x, x[inside] - 0.5 * window - 1e-12),
            np.searchsorted(x, x[inside] + 0.5 * window + 1e-12))  # fmt: skip


def _sums(values: Array, starts: Array, ends: Array) -> Array:
    total = np.concatenate([[0.0], np.cumsum(values)])
    return np.asarray(total[ends] - total[starts])


def smoothed_ratio(test: Test, window: float) -> tuple[Array, Array]:
    """Axial strains and q/p averaged over a window around each. A window of zero smooths nothing."""
    ratio = test.q / test.p
    if window <= 0:
        return test.axial, ratio
    inside, starts, ends = _starts_and_ends(test.axial, window)
    return test.axial[inside], _sums(ratio, starts, ends) / np.maximum(ends - starts, 1)


def dilatancy(test: Test, window: float) -> tuple[Array, Array]:
    """Axial strains and -d(eps_v)/d(gamma) = sin(psi), the slope of a least-squares line within a window of axial
    strain around each."""
    inside, starts, ends = _starts_and_ends(test.axial, window)
    x, y = test.shear, test.volumetric
    n = ends - starts
    sx, sy, sxx, sxy = (_sums(v, starts, ends) for v in (x, y, x * x, x * y))
    spread = n * sxx - sx * sx
    good = (n >= 3) & (spread > 0)
    return test.axial[inside][good], -((n * sxy - sx * sy)[good] / spread[good])


def peak_of(test: Test, window: float) -> float:
    """The largest smoothed q/p; nan for a test that broke off before twice the strain of its peak."""
    strain, ratio = smoothed_ratio(test, window)
    if not len(ratio):
        return NAN
    k = int(np.argmax(ratio))
    return float(ratio[k]) if test.reached >= END or strain[k] <= 0.5 * test.reached else NAN


def largest_dilatancy_of(test: Test, window: float) -> float:
    strain, rate = dilatancy(test, window)
    if not len(rate):
        return NAN
    k = int(np.argmax(rate))
    return float(rate[k]) if test.reached >= END or (k > 0 and strain[k] <= 0.5 * test.reached) else NAN


def mean_ratio_of(test: Test, low: float, high: float) -> float:
    """Mean q/p over a range of axial strain; nan for a test that did not come to its end."""
    chosen = (test.axial >= low - 1e-9) & (test.axial <= high + 1e-9)
    return float(np.mean((test.q / test.p)[chosen])) if test.reached >= high - 1e-3 and chosen.any() else NAN


def _after_peak(test: Test, window: float) -> tuple[Array, Array]:
    """Smoothed dilatancy and q/p at the same strains past the peak, where dilatancy and strength fall together."""
    strain, rate = dilatancy(test, window)
    at, ratio = smoothed_ratio(test, window)
    if not len(strain) or not len(at):
        return np.empty(0), np.empty(0)
    past = strain > at[int(np.argmax(ratio))]
    return rate[past], np.interp(strain[past], at, ratio)


def ratio_at_constant_volume(test: Test, window: float = 0.02, most: float = 0.03) -> float:
    """Mean q/p past the peak where the volume hardly changes, |sin psi| <= `most`."""
    rate, ratio = _after_peak(test, window)
    chosen = np.abs(rate) <= most
    return float(np.mean(ratio[chosen])) if chosen.sum() >= 5 and test.reached >= END else NAN


def ratio_at_zero_dilatancy(test: Test, window: float = 0.02) -> float:
    """q/p where a line through the points past the peak, q/p against dilatancy, has no dilatancy."""
    rate, ratio = _after_peak(test, window)
    if len(rate) < 10 or np.ptp(rate) < 0.05 or test.reached < END:
        return NAN
    return float(np.polynomial.polynomial.polyfit(rate, ratio, 1)[0])


def by_pressure(tests: Sequence[Test], value_of: Callable[[Test], float]) -> tuple[Array, Array]:
    """(pressures, means): the mean over the packings of a value at each pressure [Pa]; nan where no test has it, so
    that a set that lost all tests of a pressure is not compared with one that has them."""
    pressures = 1e3 * np.array(PRESSURES)
    means = []
    for pressure in pressures:
        values = np.array([value_of(test) for test in tests if abs(test.pressure - pressure) < 1e-3 * pressure])
        values = values[np.isfinite(values)]
        means.append(float(np.mean(values)) if len(values) else NAN)
    return pressures, np.array(means)


def angle(sine: float) -> float:
    """asin in degrees; nan stays nan."""
    return math.degrees(math.asin(min(max(sine, -1.0), 1.0))) if math.isfinite(sine) else NAN


def _line(pressures: Array, sines: Array, *, through_origin: bool) -> float:
    """Angle of the line q against p fitted to the tests' points; each lies where a test under its pressure on x has its
    ratio, p = pressure / (1 - sin phi)."""
    if np.isnan(sines).any():
        return NAN
    if through_origin:
        return math.degrees(common_angle(np.column_stack([pressures, np.arcsin(sines)])))
    p = pressures / (1.0 - sines)
    return angle(float(np.polynomial.polynomial.polyfit(p, sines * p, 1)[1]))


def averaged_curves(tests: Sequence[Test], points: int = 401) -> list[Test]:
    """One curve for each pressure: stresses and strains averaged over the packings at the same axial strain, as far as
    all packings went."""
    out = []
    for pressure in 1e3 * np.array(PRESSURES):
        near = [test for test in tests if abs(test.pressure - pressure) < 1e-3 * pressure]
        members = [test for test in near if test.reached > 0.1]
        if not members:
            continue
        axial = np.linspace(0, min(m.reached for m in members), points)

        def mean(name: str, members: Sequence[Test] = members, axial: Array = axial) -> Array:
            return np.asarray(np.mean([np.interp(axial, m.axial, getattr(m, name)) for m in members], axis=0))

        out.append(Test(0, pressure, axial, mean("volumetric"), mean("shear"), mean("p"), mean("q")))
    return out


def mean_peak_strain(tests: Sequence[Test]) -> float:
    """Axial strain at the peak [%], averaged over packings and pressures."""

    def strain(test: Test) -> float:
        at, ratio = smoothed_ratio(test, 0.02)
        return float(100 * at[int(np.argmax(ratio))]) if np.isfinite(peak_of(test, 0.02)) else NAN

    return float(np.mean(by_pressure(tests, strain)[1]))


def line(value_of: Callable[[Test], float], *, through_origin: bool = True) -> Definition:
    return lambda tests: _line(*by_pressure(tests, value_of), through_origin=through_origin)


def mean_of_tests(value_of: Callable[[Test], float]) -> Definition:
    def value(tests: Sequence[Test]) -> float:
        return float(np.mean([angle(s) for s in by_pressure(tests, value_of)[1]]))

    return value


def at_pressure(kilopascals: int, value_of: Callable[[Test], float]) -> Definition:
    def value(tests: Sequence[Test]) -> float:
        return angle(float(by_pressure(tests, value_of)[1][PRESSURES.index(kilopascals)]))

    return value


def of_averages(definition: Definition) -> Definition:
    return lambda tests: definition(averaged_curves(tests))


def _peak(window: float) -> Callable[[Test], float]:
    return lambda test: peak_of(test, window)


def _late(low: float, high: float) -> Callable[[Test], float]:
    return lambda test: mean_ratio_of(test, low, high)


def _dilation(window: float) -> Callable[[Test], float]:
    return lambda test: largest_dilatancy_of(test, window)


VERSION = 2  # of the definitions; results that another version has stored are made anew
PEAK: dict[str, Definition] = {
    "line through the origin, 2 %": line(_peak(0.02)),
    "the same, 0.5 %": line(_peak(0.005)),
    "the same, not smoothed": line(_peak(0.0)),
    "line with an intercept, 2 %": line(_peak(0.02), through_origin=False),
    "mean of the tests, 2 %": mean_of_tests(_peak(0.02)),
    "at 100 kPa, 2 %": at_pressure(100, _peak(0.02)),
    "at 400 kPa, 2 %": at_pressure(400, _peak(0.02)),
    "line, curves averaged first, 2 %": of_averages(line(_peak(0.02))),
}
CRITICAL: dict[str, Definition] = {
    "line, 15 to 20 % of strain": line(_late(0.15, 0.20)),
    "line, 10 to 20 %": line(_late(0.10, 0.20)),
    "line, 18 to 20 %": line(_late(0.18, 0.20)),
    "line with an intercept, 15 to 20 %": line(_late(0.15, 0.20), through_origin=False),
    "mean of the tests, 15 to 20 %": mean_of_tests(_late(0.15, 0.20)),
    "at 100 kPa, 15 to 20 %": at_pressure(100, _late(0.15, 0.20)),
    "line, where the volume is constant": line(ratio_at_constant_volume),
    "line, extrapolated to no dilatancy": line(ratio_at_zero_dilatancy),
}
DILATANCY: dict[str, Definition] = {
    "mean of the tests, 2 %": mean_of_tests(_dilation(0.02)),
    "the same, 0.5 %": mean_of_tests(_dilation(0.005)),
    "the same, 1 %": mean_of_tests(_dilation(0.01)),
    "the same, 4 %": mean_of_tests(_dilation(0.04)),
    "the same, 6 %": mean_of_tests(_dilation(0.06)),
    "at 100 kPa, 2 %": at_pressure(100, _dilation(0.02)),
    "at 400 kPa, 2 %": at_pressure(400, _dilation(0.02)),
    "curves averaged first, 1 %": of_averages(mean_of_tests(_dilation(0.01))),
    "curves averaged first, 2 %": of_averages(mean_of_tests(_dilation(0.02))),
    "curves averaged first, 4 %": of_averages(mean_of_tests(_dilation(0.04))),
}
STRAIN: dict[str, Definition] = {"mean of the tests, 2 %": mean_peak_strain}  # [%]
DEFINITIONS: dict[str, dict[str, Definition]] = {
    "peak": PEAK,
    "critical": CRITICAL,
    "dilatancy": DILATANCY,
    "strain": STRAIN,
}
USUAL = {kind: next(iter(definitions)) for kind, definitions in DEFINITIONS.items()}


@dataclass(frozen=True)
class Value:
    """An angle [degrees] with its standard error over the packings."""

    mean: float
    error: float
    packings: int

    @property
    def deviation(self) -> float:
        """Standard deviation of a single packing."""
        return self.error * math.sqrt(self.packings)


def with_error(tests: Sequence[Test], definition: Definition) -> Value:
    """The value of all packings and its standard error by the jackknife: each packing is left out once, which works for
    means and for values of averaged curves alike."""
    seeds = sorted({test.seed for test in tests})
    whole = definition(tests)
    if len(seeds) < 2:
        return Value(whole, NAN, len(seeds))
    found = [definition([test for test in tests if test.seed != seed]) for seed in seeds]
    without = [value for value in found if math.isfinite(value)]
    return Value(whole, jackknife_error(without) if len(without) > 1 else NAN, len(without))
