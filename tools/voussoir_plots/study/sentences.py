"""One sentence for each figure of the ground: our numbers over the members (mean ± half width of the 95 % band of the
mean), and whether they show what the paper reports."""

from collections.abc import Callable, Sequence

import numpy as np

from .. import profiles, settings, tensors, trends, trough_fit
from .. import settlements as of_one
from .. import stresses as geostatic
from ..points import original_points
from ..q8 import gauss_coordinates
from ..reaction import curve
from ..resolution import percent
from ..result import Increment, Missing, Result
from ..trend_table import BAND
from .bands import number
from .data import Study, Tunnel
from .initial import ratio_curve
from .settlements import SUBSURFACE, largest, normalised_trough, widths

HIGH_STRESS, LOW_STRESS = 200e3, 20e3  # of K0 [Pa]


def says(holds: bool | np.bool, paper: str, ours: str) -> str:
    """`paper`: what the paper reports; `ours`: our numbers."""
    return f"{'As' if holds else 'Other than'} in the paper ({paper}): {ours}."


def each(tunnels: Sequence[Tunnel], text: Callable[[Tunnel], str], by: str = "cover") -> str:
    """ "C/D = 2: ...; C/D = 3: ..." """
    return "; ".join(f"{f'C/D = {t.cover_ratio:.3g}' if by == 'cover' else t.code}: {text(t)}" for t in tunnels)


def at(result: Result, values: np.ndarray, loss: float) -> float:
    if loss > result.volume_loss[-1] + 1e-9:
        raise Missing(f"{result.folder} ends at V_l = {percent(result.volume_loss[-1])}")
    return float(np.interp(loss, result.volume_loss, values))


def end(tunnels: Sequence[Tunnel]) -> float:
    """The largest V_l that all tunnels reached [-]."""
    return min(float(tunnel.loss[-1]) for tunnel in tunnels)


def initial(study: Study) -> str:
    tunnel = study.main()
    stress, bands = ratio_curve(tunnel)

    def ratio(wanted: float) -> tuple[float, str]:
        found = number([np.interp(wanted, stress, member) for member in bands.members])
        return found.mean, f"{found} at {wanted / 1e3:g} kPa"

    def deflection(member: Result) -> float:
        tensor = geostatic.after_gravity(member).field("gauss/stress")
        far = geostatic.far_from_opening(member, gauss_coordinates(member.coordinates, member.connectivity))
        deep = far & (-tensor[..., 1] > 50e3)
        if not deep.any():
            raise Missing("no point has more than 50 kPa")
        return float(np.degrees(np.abs(tensors.major_from_vertical(tensor[deep])).mean()))

    angle = tunnel.number(deflection)
    (low, at_low), (high, at_high) = ratio(LOW_STRESS), ratio(HIGH_STRESS)
    return says(
        high < low and angle.mean < 1,
        "K0 falls with the stress, not linearly; axes turned by 0.5° at most",
        f"K0 = {at_low} and {at_high}; from 50 kPa on the major axis is {angle.text('.2f')}° off the vertical on average",
    )


def active_height(member: Result, loss: float) -> float:
    """The height above the crown over C up to which the ground on the axis settles by half of the crown's settlement or
    more [-]; nodes between the crown and the surface are interpolated."""
    increment = member.loss_increments[int(np.argmin(np.abs(member.volume_loss - loss)))]
    x, y = member.coordinates.T
    axis = np.flatnonzero((np.abs(x) < 1e-9) & (y >= member.crown_height - 1e-9))
    axis = axis[np.argsort(y[axis])]
    settled = -increment.field("node/displacement")[axis, 1]
    height = (y[axis] - member.crown_height) / member.cover
    below = np.flatnonzero(settled < 0.5 * settled[0])
    if len(below) == 0:
        return float(height[-1])
    k = int(below[0])
    return float(np.interp(0.5 * settled[0], [settled[k], settled[k - 1]], [height[k], height[k - 1]]))


def active_zone(study: Study) -> str:
    tunnels = study.covers()
    last = end(tunnels)
    found = [t.number(lambda member: active_height(member, last)) for t in tunnels]
    falls = all(a.mean > b.mean for a, b in zip(found, found[1:]))
    text = each(tunnels, lambda t: f"{found[tunnels.index(t)]} C")
    holds = falls and (found[0].mean > 0.9 or tunnels[0].cover_ratio > 2.5)
    return says(
        holds,
        "the active soil reaches the surface at C/D = 2 and stays near the crown at C/D = 4",
        f"soil on the axis that settles by half of the crown's settlement or more reaches, above the crown, at V_l = "
        f"{percent(last)} {text}",
    )


def band_reach(member: Result, loss: float) -> float:
    """How far the shear band (eps_q from 5 % on) reaches above the crown, over C [-]."""
    (diameter,) = member.need("diameter")
    where = original_points(member)
    increment = member.loss_increments[int(np.argmin(np.abs(member.volume_loss - loss)))]
    strain = increment.field("gauss/deviatoric_strain").ravel()
    height = (where[:, 1] - member.crown_height) / member.cover
    return max(trends.band_height(height, where[:, 0], strain, member.settings.aside * diameter, BAND))


def _bands(tunnels: Sequence[Tunnel], by: str) -> tuple[list[float], str]:
    last = end(tunnels)
    found = {t.name: t.number(lambda member: band_reach(member, last)) for t in tunnels}
    text = each(tunnels, lambda t: f"{found[t.name]} C", by)
    means = [found[t.name].mean for t in tunnels]
    return means, f"soil with 5 % of shear strain and more reaches, above the crown, at V_l = {percent(last)} {text}"


def bands_by_cover(study: Study) -> str:
    tunnels = study.covers()
    means, text = _bands(tunnels, "cover")
    falls = all(a > b for a, b in zip(means, means[1:]))
    holds = falls and (tunnels[0].cover_ratio > 2.5 or means[0] > 0.9)
    return says(holds, "bands reach the surface at C/D = 2, an arch at C/D = 3, slow bands at C/D = 4", text)


def bands_by_soil(study: Study) -> str:
    tunnels = study.soils()
    means, text = _bands(tunnels, "soil")
    found = dict(zip((t.soil for t in tunnels), means))
    dense = found.get("dense sand", np.nan)
    holds = not (found.get("medium dense sand", np.inf) < dense) and not (found.get("gravel", 0.0) > dense)
    return says(holds, "bands go up farther in CPS_MD, less far in CPG_D", text)


def growth(study: Study) -> str:
    tunnels = study.covers()
    windows = ((0.0, 0.02), (0.08, 0.10), (0.175, 0.20))

    def rates(tunnel: Tunnel) -> list[float]:
        (diameter,) = tunnel.members[0].need("diameter")
        return [
            tunnel.number(
                lambda m, low=low, high=high: trends.slope(m.volume_loss, largest(m, 0.0), low, high) / diameter
            ).mean
            for low, high in windows
        ]

    found = {t.name: rates(t) for t in tunnels}
    slows = all(b < 0.9 * a for a, b, _ in found.values())
    again = found[tunnels[0].name][2] > 1.25 * found[tunnels[0].name][1]
    last = end(tunnels)
    share = {t.name: t.number(lambda m: at(m, largest(m, 0.0), last)) for t in tunnels}

    def text(tunnel: Tunnel) -> str:
        rate = ", ".join(f"{value:.3f}" for value in found[tunnel.name])
        return f"{rate}, S = {share[tunnel.name].text('.0f', 1e3, 'mm')} at {percent(last)}"

    return says(
        slows and again,
        "growth slows up to V_l = 10 %; at C/D = 2 the surface accelerates again from 15 % on",
        f"growth of the surface's settlement dS/dV_l / D at V_l = 0 to 2, 8 to 10 and 17.5 to 20 %: "
        f"{each(tunnels, text)}" + ("" if slows and again else f"; it {'slows' if slows else 'does not slow'}, and at "
        f"C/D = {tunnels[0].cover_ratio:.3g} {'accelerates' if again else 'does not accelerate'} again"),
    )


def trough_shapes(study: Study) -> str:
    covers = study.covers()
    tunnels = [covers[0], covers[-1]] if len(covers) > 1 else covers
    last = end(tunnels)
    worst, spread = 0.0, {}
    for tunnel in tunnels:
        fits = {
            (z, v): trough_fit.fit(*_mean_trough(tunnel, z, v)) for z in (0.0, SUBSURFACE) for v in (0.25 * last, last)
        }
        worst = max(worst, *(fit.misfit for fit in fits.values()))
        spread[tunnel.name] = [fits[0.0, v].inflection for v in (0.25 * last, last)]
    narrows = all(b < a for a, b in spread.values())
    widens = spread[tunnels[0].name][1] <= spread[tunnels[-1].name][1]
    text = each(tunnels, lambda t: " to ".join(f"{i:.2f}" for i in spread[t.name]) + " m")
    return says(
        worst < 0.05 and narrows and widens,
        "the curve fits well; troughs widen with C/D and narrow with V_l",
        f"largest rms misfit of the mean troughs at z/C = 0 and {SUBSURFACE:g} is {percent(worst)} of S_max; inflection at "
        f"the surface from V_l = {percent(0.25 * last)} to {percent(last)}: {text}",
    )


def _mean_trough(tunnel: Tunnel, ratio: float, loss: float) -> tuple[np.ndarray, np.ndarray]:
    x, bands = normalised_trough(tunnel, ratio, loss)
    return x, bands.mean


def trough_widths(study: Study) -> str:
    tunnels = study.covers()
    low, high = settings.Settings().range_of_k

    def share(member: Result) -> float:
        width = widths(member, 0.0)
        width = width[np.isfinite(width)]
        return float(np.mean((width >= low) & (width <= high)))

    last = end(tunnels)
    inside = {t.name: t.number(share) for t in tunnels}
    width = {t.name: t.number(lambda m: at(m, widths(m, 0.0), last)) for t in tunnels}
    text = each(tunnels, lambda t: f"{inside[t.name].text('.0f', 100, '%')}, K_s = {width[t.name]} at {percent(last)}")
    return says(
        all(found.mean > 0.5 for found in inside.values()),
        f"K_s lies mostly in Mair and Taylor's range, {low:g} to {high:g}",
        f"states with K_s in this range: {text}",
    )


def soils_settle(study: Study) -> str:
    tunnels = study.soils()
    last = end(tunnels)
    found = {t.soil: t.number(lambda m: at(m, largest(m, 0.0), last)) for t in tunnels}
    dense = found.get("dense sand")
    if dense is None or len(found) < 2:
        raise Missing("needs dense sand and another soil at the same cover")
    loose = found.get("medium dense sand", dense)
    late = {
        t.soil: t.number(
            lambda m: trends.slope(m.volume_loss, largest(m, 0.0), last / 2, last)
            / trends.slope(m.volume_loss, of_one.on_axis(m, SUBSURFACE), last / 2, last)
        )
        for t in tunnels
    }
    text = each(
        tunnels,
        lambda t: f"{found[t.soil].text('.0f', 1e3, 'mm')}, growth of the surface over that at z/C = {SUBSURFACE:g} in "
        f"the second half {late[t.soil]}",
        "soil",
    )
    holds = loose.mean >= dense.mean and late.get("medium dense sand", late["dense sand"]).mean > 0.8
    return says(
        holds,
        "CPS_MD settles more, at similar rates at all depths; CPG_D like CPS_D, but more locally",
        f"settlement of the surface at V_l = {percent(last)}: {text}",
    )


def reaction(study: Study) -> str:
    tunnels = study.soils()
    least = {t.soil: t.number(lambda m: float(curve(m)[1].min())) for t in tunnels}
    when = {t.soil: t.number(lambda m: float(m.volume_loss[curve(m)[1].argmin()])) for t in tunnels}
    final = {t.soil: t.number(lambda m: float(curve(m)[1][-1])) for t in tunnels}
    recovered = {soil: final[soil].mean - least[soil].mean for soil in least}
    loose = "medium dense sand"
    holds = all(r >= 0.02 for soil, r in recovered.items() if soil != loose) and recovered.get(loose, 0.0) < 0.02
    if {"gravel", "dense sand"} <= set(least):
        holds = holds and least["gravel"].mean < least["dense sand"].mean
    text = each(
        tunnels,
        lambda t: f"least {least[t.soil].text('.3f')} at V_l = {when[t.soil].text('.1f', 100, '%')}, "
        f"{final[t.soil].text('.3f')} at the end",
        "soil",
    )
    return says(holds, "dense soils have a minimum and recover, CPG_D lower, CPS_MD falls monotonically", text)


Profile = Callable[[Result, Increment], tuple[np.ndarray, np.ndarray, np.ndarray]]


def _change(member: Result, profile: Profile, near: float, loss: float) -> tuple[float, float]:
    """Means of both stresses within `near` D of the line's begin, over those before the loss."""
    (diameter,) = member.need("diameter")
    increment = member.loss_increments[int(np.argmin(np.abs(member.volume_loss - loss)))]
    means = []
    for state in (member.start, increment):
        place, xx, yy = profile(member, state)
        inside = place <= near * diameter
        means.append((xx[inside].mean(), yy[inside].mean()))
    return means[1][0] / means[0][0], means[1][1] / means[0][1]


def stresses(study: Study) -> str:
    tunnel = study.main()
    above = [tunnel.number(lambda m, k=k: _change(m, profiles.above, 1.0, 0.05)[k]) for k in (0, 1)]
    beside = [tunnel.number(lambda m, k=k: _change(m, profiles.beside, 1.5, 0.02)[k]) for k in (0, 1)]
    holds = above[0].mean > 1 > above[1].mean and beside[1].mean > 1 > beside[0].mean
    return says(
        holds,
        "above the crown the horizontal stress rises and the vertical one falls, beside the tunnel the opposite",
        f"over the values before the loss, horizontal and vertical stress are {above[0]} and {above[1]} in the first D "
        f"above the crown at V_l = 5 %, {beside[0]} and {beside[1]} in the first D beside the tunnel at 2 %",
    )
