"""The trends that the study reports. Each is computed from a run and has a verdict: seen or not.

A trend is judged by a pure function of arrays (tests/regression/trends_test.py has their known answers); `table` takes
the arrays from a run. "Not applicable" says that the study reports the trend of another soil or cover; its numbers are
given all the same.
"""

import itertools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from . import resolution
from .resolution import percent

SEEN, NOT_SEEN, NOT_APPLICABLE = "seen", "not seen", "not applicable"
NOT_REACHED, NO_DATA = "not reached", "no data"  # the run ends before, or lacks a field

# End over minimum of the ground reaction, of running means (docs/measurements/unseen_trends.md): four draws of dense
# sand gave 1.19 at least, four of medium dense sand 1.02 at most.
RECOVERS, MONOTONE = 1.1, 1.05


@dataclass
class Trend:
    statement: str
    verdict: str
    numbers: str

    def where(self, applies: bool, reason: str) -> "Trend":
        """The same, but not applicable where the study does not report it."""
        return self if applies else Trend(self.statement, NOT_APPLICABLE, f"{reason}; here: {self.numbers}")


def fault(statement: str, error: Exception) -> Trend:
    return Trend(statement, "fault of the tool", f"{type(error).__name__}: {' '.join(str(error).split())}")


def verdict(holds: bool | np.bool_) -> str:
    return SEEN if holds else NOT_SEEN


def not_reached(statement: str, wanted: float, last: float) -> Trend:
    return Trend(statement, NOT_REACHED, f"needs V_l = {percent(wanted)}, the run ends at {percent(last)}")


def at_the_end(statement: str, holds: bool | np.bool_, text: str, loss: np.ndarray) -> Trend:
    """A trend that a longer run may still break. If it holds in a run that ends before 20 %, nothing is known."""
    if holds and loss[-1] < 0.199:
        return Trend(statement, NOT_REACHED, f"the run ends at {percent(loss[-1])}; so far {text}")
    return Trend(statement, verdict(holds), text)


def numbers(values: Iterable[float], form: str = "{:.3g}") -> str:
    return ", ".join(form.format(v) for v in values)


def slope(x: np.ndarray, y: np.ndarray, low: float, high: float) -> float:
    """Slope of the straight line through the points with low <= x <= high; NaN where there are fewer than two."""
    inside = (x >= low - 1e-9) & (x <= high + 1e-9)
    return np.polyfit(x[inside], y[inside], 1)[0] if inside.sum() > 1 else np.nan


def at(x: np.ndarray, y: np.ndarray, where: float) -> float:
    return float(np.interp(where, x, y))


def settlement_slows(loss: np.ndarray, settlements: Mapping[float, np.ndarray], diameter: float) -> Trend:
    """settlements: {z/C: S [m]}; the settlement of the crown (z/C = 1) is prescribed and does not count."""
    statement = "Settlement above the crown grows more slowly with V_l below 10 %"
    if loss[-1] < 0.0999:
        return not_reached(statement, 0.10, loss[-1])
    for low, high in ((0.0, 0.02), (0.08, 0.10)):
        if why := resolution.few_states(loss, low, high, 2):
            return Trend(statement, NOT_REACHED, why)
    pairs = {
        z: (slope(loss, s, 0, 0.02) / diameter, slope(loss, s, 0.08, 0.10) / diameter) for z, s in settlements.items()
    }
    text = "; ".join(f"z/C = {z:g}: {a:.2f} to {b:.2f}" for z, (a, b) in pairs.items())
    holds = all(b < 0.9 * a for z, (a, b) in pairs.items() if z < 1)
    return Trend(statement, verdict(holds), f"slope dS/dV_l / D at V_l = 0 to 2 % and 8 to 10 %: {text}")


def surface_accelerates(loss: np.ndarray, settlement: np.ndarray, diameter: float) -> Trend:
    statement = "Surface settlement accelerates again near V_l = 15 %"
    if loss[-1] < 0.1749:
        return not_reached(statement, 0.175, loss[-1])
    for v in (0.10, 0.125, 0.15, 0.175):
        if why := resolution.few_states(loss, v - 0.0125, v + 0.0125, 2):
            return Trend(statement, NOT_REACHED, why)
    rates = {v: slope(loss, settlement, v - 0.0125, v + 0.0125) / diameter for v in (0.10, 0.125, 0.15, 0.175)}
    before, after = rates[0.10], max(rates[0.15], rates[0.175])
    text = ", ".join(f"{rate:.3f} at {percent(v)}" for v, rate in rates.items())
    return Trend(statement, verdict(after > 1.25 * before), f"slope dS/dV_l / D: {text}")


def band_height(
    height: np.ndarray, x: np.ndarray, strain: np.ndarray, aside: float, threshold: float
) -> tuple[float, float]:
    """How far the band reaches (heights of points above the crown over the cover): off the axis (x > aside) and at
    it."""
    sheared = (strain >= threshold) & (height > 0)
    off, on = height[sheared & (x > aside)], height[sheared & (x <= aside)]
    return (float(off.max()) if off.size else 0.0), (float(on.max()) if on.size else 0.0)


def bands(reach: Mapping[float, tuple[float, float]], cover_ratio: float, threshold: float) -> Trend:
    """reach: {V_l: (band beside the axis, sheared soil at the axis), both as heights above the crown over C}."""
    text = "; ".join(f"{percent(v)}: {a:.2f} C beside, {b:.2f} C at the axis" for v, (a, b) in reach.items())
    text = f"soil with eps_q of {percent(threshold)} and more reaches, above the crown, at V_l = {text}"
    beside, middle = list(reach.values())[-1]
    if cover_ratio < 2.5:
        statement, holds = "Shear bands reach the surface (C/D = 2)", beside > 0.9
    elif cover_ratio < 3.5:
        statement, holds = (
            "Shear bands close into an arch below the surface (C/D = 3)",
            0.1 < max(beside, middle) < 0.9 and middle > 0.1,
        )
    else:
        statement, holds = "Shear bands stay low, the arch is stable (C/D = 4)", max(beside, middle) < 0.7
    if not holds and max(reach) < 0.199:
        return Trend(statement, NOT_REACHED, f"the run ends before V_l = 20 %; {text}")
    return Trend(statement, verdict(holds), text)


def gauss_fits(misfits: Mapping[float, np.ndarray], at_bounds: Mapping[float, np.ndarray]) -> Trend:
    """misfits: {z/C: rms misfit over S_max, over the losses}."""
    worst = max(float(np.max(m)) for m in misfits.values())
    text = "; ".join(f"z/C = {z:g}: {percent(float(np.max(m)))}" for z, m in misfits.items())
    share = float(np.mean([float(np.mean(b)) for b in at_bounds.values()]))
    return Trend(
        "The modified Gauss curve fits the troughs at all depths",
        verdict(worst <= 0.05),
        f"largest rms misfit over S_max: {text}; alpha at its lower bound in {percent(share)} of the fits (the trough "
        "is more pointed, with a wider foot, than the family)",
    )


def troughs_narrow(loss: np.ndarray, inflection: Mapping[float, np.ndarray]) -> Trend:
    """inflection: {z/C: i [m] over the losses}."""
    statement = "Troughs narrow with V_l"
    if loss[-1] < 0.0299:
        return not_reached(statement, 0.03, loss[-1])
    if why := resolution.few_states(loss, 0.0, 0.02, 1):
        return Trend(statement, NOT_REACHED, why)
    first = int(np.argmin(np.abs(loss - 0.01)))
    text = "; ".join(f"z/C = {z:g}: {i[first]:.2f} to {i[-1]:.2f} m" for z, i in inflection.items())
    return Trend(
        statement,
        verdict(all(i[-1] < 0.95 * i[first] for i in inflection.values())),
        f"inflection from V_l = {percent(loss[first])} to {percent(loss[-1])}: {text}",
    )


def surface_width_in_range(loss: np.ndarray, width: np.ndarray, low: float, high: float) -> Trend:
    statement = f"K_s lies mostly in Mair and Taylor's range ({low:g} to {high:g})"
    if loss[-1] < 0.0499:
        return not_reached(statement, 0.05, loss[-1])
    if why := resolution.coarse_path(np.insert(loss, 0, 0.0)):
        return Trend(statement, NOT_REACHED, why)
    inside = (width >= low) & (width <= high)
    return Trend(
        statement,
        verdict(inside.mean() > 0.5),
        f"in it at {percent(inside.mean())} of the increments; K_s = {at(loss, width, loss[0]):.2f} at V_l = "
        f"{percent(loss[0])}, {at(loss, width, 0.05):.2f} at 5 %, {width[-1]:.2f} at {percent(loss[-1])}",
    )


def stresses_text(loss: np.ndarray, horizontal: np.ndarray, vertical: np.ndarray) -> str:
    """Both stresses at the volume losses that the run resolves."""
    wanted = [v for v in (0.01, 0.02, 0.05, 0.10, 0.20) if not resolution.no_states_near(loss, v)] or [loss[-1]]
    return "; ".join(f"{percent(v)}: {at(loss, horizontal, v):.2f} and {at(loss, vertical, v):.2f}" for v in wanted)


def stresses_above(loss: np.ndarray, horizontal: np.ndarray, vertical: np.ndarray, until: float = 0.05) -> Trend:
    """Mean stresses above the crown over their values at V_l = 0."""
    last = min(until, loss[-1])
    statement = f"Above the crown sigma_xx rises and sigma_yy falls (at V_l = {percent(last)})"
    if why := resolution.no_states_near(loss, last):
        return Trend(statement, NOT_REACHED, why)
    holds = at(loss, horizontal, last) > 1.05 and at(loss, vertical, last) < 0.95
    text = stresses_text(loss, horizontal, vertical)
    return Trend(
        statement,
        verdict(holds),
        f"mean over the first D above the crown, over its value at V_l = 0, xx and yy at {text}",
    )


def stresses_beside(loss: np.ndarray, horizontal: np.ndarray, vertical: np.ndarray, until: float = 0.02) -> Trend:
    last = min(until, loss[-1])
    statement = f"At the sides the opposite: sigma_xx falls and sigma_yy rises (at V_l = {percent(last)})"
    if why := resolution.no_states_near(loss, last):
        return Trend(statement, NOT_REACHED, why)
    holds = at(loss, horizontal, last) < 0.98 and at(loss, vertical, last) > 1.02
    text = stresses_text(loss, horizontal, vertical)
    return Trend(
        statement,
        verdict(holds),
        f"mean from the opening to D beside it, over its value at V_l = 0, xx and yy at {text}",
    )


def reaction(loss: np.ndarray, ratio: np.ndarray, soil: str) -> Trend:
    """The ground reaction curve: a minimum and recovery in dense soils, a monotone fall in medium dense sand."""
    least = int(np.argmin(ratio))
    recovery = resolution.recovery_factor(loss, ratio)
    text = (
        f"minimum {ratio[least]:.3f} at V_l = {percent(loss[least])}, {ratio[-1]:.3f} at the end "
        f"({percent(loss[-1])}): end over minimum of running means {recovery:.2f}"
    )
    loose = soil == "medium dense sand"
    statement = (
        "The ground reaction curve falls monotonically to its end value (medium dense sand)"
        if loose
        else "The ground reaction curve drops to a minimum, then recovers (dense soils)"
    )
    if why := resolution.coarse_path(loss):
        return Trend(statement, NOT_REACHED, why)
    if loose:
        return at_the_end(statement, recovery < MONOTONE, text, loss)
    if recovery < RECOVERS and loss[-1] < 0.199:
        return Trend(statement, NOT_REACHED, f"the run ends at {percent(loss[-1])}; {text}")
    return Trend(statement, verdict(recovery >= RECOVERS), text)


def falls_linearly(loss: np.ndarray, ratios: Mapping[str, np.ndarray], until: float = 0.02) -> Trend:
    """ratios: {point: q/p}. The trend is seen where a straight line from V_l = 0 to 2 % descends and explains 95 %."""
    statement = "q/p falls linearly for V_l < 2 % (unloading)"
    if loss[-1] < until - 1e-9:
        return not_reached(statement, until, loss[-1])
    # Two states lie on a straight line whatever the ground does.
    if why := resolution.few_states(loss, 0.0, until, 3):
        return Trend(statement, NOT_REACHED, why)
    inside = loss <= until + 1e-9
    found, unknown = {}, []
    for name, ratio in ratios.items():
        known = inside & np.isfinite(ratio)
        x, y = loss[known], ratio[known]
        if len(x) < 3:
            unknown.append(name)
            continue
        fit = np.polyval(np.polyfit(x, y, 1), x)
        spread = np.sum((y - y.mean()) ** 2)
        found[name] = (
            1 - np.sum((y - fit) ** 2) / spread if spread > 0 else 0.0,
            np.polyfit(x, y, 1)[0],
            loss[np.nanargmin(ratio)],
            np.nanmin(ratio),
        )
    if not found:
        return Trend(statement, NO_DATA, f"hardly compressed: {', '.join(unknown) or 'no point'}")
    text = "; ".join(
        f"{name}: slope {b:.1f}, R2 {r:.3f}, least {low:.2f} at {percent(v)}" for name, (r, b, v, low) in found.items()
    )
    text += "".join(f"; {name}: hardly compressed" for name in unknown)
    holds = all(b < 0 and r > 0.95 for r, b, _, _ in found.values())
    return Trend(statement, verdict(holds), text)


def peak_after_unloading(loss: np.ndarray, ratio: np.ndarray) -> tuple[float, float, bool]:
    """V_l and value of the first peak of q/p after its minimum: the first maximum after which q/p falls by 5 %, or the
    largest value where q/p never falls so much. The third value is True where q/p falls. Where q/p is NaN (the point is
    hardly compressed) it is left out."""
    loss, ratio = loss[np.isfinite(ratio)], ratio[np.isfinite(ratio)]
    start = int(np.argmin(ratio))
    best = start
    for k in range(start, len(ratio)):
        if ratio[k] > ratio[best]:
            best = k
        elif ratio[k] < 0.95 * ratio[best]:
            return loss[best], ratio[best], True
    return loss[best], ratio[best], False


def compressed(ratios: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The points whose q/p is known at any time."""
    return {name: ratio for name, ratio in ratios.items() if np.isfinite(ratio).any()}


def softening_order(loss: np.ndarray, ratios: Mapping[str, np.ndarray]) -> Trend:
    statement = "Aa softens first, then Ab peaks, Ac last"
    ratios = compressed(ratios)
    if "Aa" not in ratios:
        return Trend(statement, NO_DATA, "the point Aa does not exist, or it is hardly compressed")
    if why := resolution.coarse_path(loss):
        return Trend(statement, NOT_REACHED, why)
    peaks = {name: peak_after_unloading(loss, ratio) for name, ratio in ratios.items()}
    text = "; ".join(
        f"{name}: {value:.2f} at V_l = {percent(v)}, {'falls after it' if fell else 'no softening until the end'}"
        for name, (v, value, fell) in peaks.items()
    )
    order = [peaks[name][0] for name in ("Aa", "Ab", "Ac") if name in peaks]
    holds = all(a <= b for a, b in itertools.pairwise(order)) and peaks["Aa"][2]
    text = f"peak of q/p after unloading: {text}"
    if loss[-1] < 0.199 and not all(fell for _, _, fell in peaks.values()) and (holds or not peaks["Aa"][2]):
        return Trend(statement, NOT_REACHED, f"the run ends at {percent(loss[-1])}; so far {text}")
    return Trend(statement, verdict(holds), text)


def no_softening(loss: np.ndarray, ratios: Mapping[str, np.ndarray], soil: str) -> Trend:
    statement = f"No softening at Aa, Ab, Ac ({soil})"
    ratios = compressed(ratios)
    if not ratios:
        return Trend(statement, NO_DATA, "no point is compressed")
    if why := resolution.coarse_path(loss):
        return Trend(statement, NOT_REACHED, why)
    peaks = {name: peak_after_unloading(loss, ratio) for name, ratio in ratios.items()}
    text = "; ".join(
        f"{name}: end over peak {ratio[np.isfinite(ratio)][-1] / peaks[name][1]:.2f}" for name, ratio in ratios.items()
    )
    return at_the_end(statement, not any(fell for _, _, fell in peaks.values()), text, loss)


def contracts_until(loss: np.ndarray, volumetric: np.ndarray, wanted: float = 0.15) -> Trend:
    statement = f"Ac contracts until V_l = {percent(wanted)}"
    if why := resolution.coarse_path(loss):
        return Trend(statement, NOT_REACHED, why)
    most = int(np.argmax(volumetric))
    text = (
        f"largest contraction {percent(volumetric[most])} at V_l = {percent(loss[most])}, {percent(volumetric[-1])} at "
        f"the end ({percent(loss[-1])})"
    )
    if loss[-1] < wanted - 1e-9 and volumetric[-1] > 0.5 * volumetric[most]:
        return Trend(statement, NOT_REACHED, f"the run ends at {percent(loss[-1])}; {text}")
    return Trend(statement, verdict(loss[most] >= wanted - 0.03), text)


def ends_contracted(loss: np.ndarray, volumetrics: Mapping[str, np.ndarray]) -> Trend:
    statement = "Ab and Ac contract (medium dense sand)"
    if not volumetrics:
        return Trend(statement, NO_DATA, "neither point exists")
    text = "; ".join(f"{name}: {percent(v[-1])}" for name, v in volumetrics.items())
    return at_the_end(
        statement,
        all(v[-1] > 0 for v in volumetrics.values()),
        f"volumetric strain at the end, contraction positive: {text}",
        loss,
    )


def follows_fabric(stress: Mapping[float, np.ndarray], fabric: Mapping[float, np.ndarray]) -> Trend:
    """{V_l: angles [rad]} of both along the line; axes have no arrow, so differences are taken modulo 180 deg."""
    away = {v: np.degrees(np.abs((stress[v] - fabric[v] + np.pi / 2) % np.pi - np.pi / 2)) for v in stress}
    together = {v: float(np.abs(np.mean(np.exp(2j * (stress[v] - fabric[v]))))) for v in stress}
    text = "; ".join(f"{percent(v)}: {d.mean():.0f} deg, {together[v]:.2f}" for v, d in away.items())
    holds = all(d.mean() < 20 for d in away.values())
    return Trend(
        "Principal stresses above the crown turn with the RVEs' fabric",
        verdict(holds),
        f"mean angle between major stress and theta_a along the line, and agreement from 0 to 1, at V_l = {text}",
    )


def ranks(values: np.ndarray) -> np.ndarray:
    return np.argsort(np.argsort(values)).astype(float)


def overlaps(
    strain: np.ndarray, rotation: np.ndarray, dilation: np.ndarray, share: float = 0.05
) -> tuple[float, float]:
    """How many of the most sheared points are among the most turned, and among the most dilated [-]."""
    count = max(1, int(share * len(strain)))
    sheared, turned, dilated = (set(np.argsort(-values)[:count]) for values in (strain, np.abs(rotation), dilation))
    return len(sheared & turned) / count, len(sheared & dilated) / count


def localise_together(strain: np.ndarray, rotation: np.ndarray, dilation: np.ndarray, share: float = 0.05) -> Trend:
    """Rank correlation of eps_q with |grain rotation| and with the change of void ratio, and how many of the most
    sheared points are also among the most turned and dilated."""
    overlap = overlaps(strain, rotation, dilation, share)
    correlation = [np.corrcoef(ranks(strain), ranks(values))[0, 1] for values in (np.abs(rotation), dilation)]
    return Trend(
        "Deviatoric strain, grain rotation and void ratio localise together",
        verdict(min(overlap) > 0.5),
        f"of the {percent(share)} most sheared points {percent(overlap[0])} are among the most turned, "
        f"{percent(overlap[1])} among the most dilated (by chance {percent(share)}); rank correlations "
        f"{numbers(correlation, '{:.2f}')}",
    )
