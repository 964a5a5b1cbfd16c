"""One sentence for each figure of the ground: our numbers over the members (mean ± half width of the 95 % band of the
mean), and whether they show what the paper reports."""

import itertools
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from .. import profiles, settings, tensors, trends, trough_fit
from .. import settlements as of_one
from .. import stresses as geostatic
from ..points import original_points
from ..q8 import gauss_coordinates
from ..reaction import curve
from ..resolution import percent, recovery_factor
from ..result import Increment, Missing, Result
from ..trend_table import BAND
from ..trends import MONOTONE, RECOVERS
from .bands import Number, all_hold, exceeds, number
from .data import Study, Tunnel
from .initial import ratio_curve
from .settlements import SUBSURFACE, largest, normalised_trough, widths

HIGH_STRESS, LOW_STRESS = 200e3, 20e3  # of K0 [Pa]


Claim = tuple[bool | np.bool_ | None, str]  # whether our results show it (None: the members do not decide), and what


def says(ours: str, *claims: Claim) -> str:
    """What the paper reports, by whether our results show it, and our numbers."""
    parts = []
    for wanted, begin in (
        (True, "As in the paper: "),
        (False, "Not seen here: "),
        (None, "Open, as the members scatter: "),
    ):
        found = [text for holds, text in claims if (holds is None) == (wanted is None) and bool(holds) == bool(wanted)]
        if found:
            parts.append(begin + "; ".join(found))
    return ". ".join([*parts, f"Here {ours}."])


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

    def ratio(wanted: float) -> Number:
        return number([np.interp(wanted, stress, member) for member in bands.members])

    def deflection(member: Result) -> float:
        tensor = geostatic.after_gravity(member).field("gauss/stress")
        far = geostatic.far_from_opening(member, gauss_coordinates(member.coordinates, member.connectivity))
        deep = far & (-tensor[..., 1] > 50e3)
        if not deep.any():
            raise Missing("no point has more than 50 kPa")
        return float(np.degrees(np.abs(tensors.major_from_vertical(tensor[deep])).mean()))

    angle = tunnel.number(deflection)
    low, high = ratio(LOW_STRESS), ratio(HIGH_STRESS)
    return says(
        f"K0 = {low} at {LOW_STRESS / 1e3:g} kPa and {high} at {HIGH_STRESS / 1e3:g} kPa; from 50 kPa on the major "
        f"axis is {angle.text('.2f')}° off the vertical on average",
        (exceeds(low, high), "K0 falls with the vertical stress"),
        (angle.mean <= 0.5, "the principal axes are turned by 0.5° at most"),
    )


def active_height(member: Result, loss: float) -> float:
    """The height above the crown over C up to which the ground on the axis settles by half of the crown's settlement or
    more [-]; nodes between the crown and the surface are interpolated."""
    increment = member.next_to(loss)
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
    text = each(tunnels, lambda t: f"{found[tunnels.index(t)]} C")
    claims: list[Claim] = [(_falling(found), "the active soil reaches less far at a larger cover")]
    if tunnels[0].cover_ratio < 2.5:
        claims.append((found[0].mean > 0.9, "the active soil of C/D = 2 reaches the surface"))
    return says(
        f"soil on the axis that settles by half of the crown's settlement or more reaches, above the crown, at V_l = "
        f"{percent(last)} {text}",
        *claims,
    )


def _falling(found: Sequence[Number]) -> bool | None:
    """Whether each number exceeds the next one."""
    if len(found) < 2:
        raise Missing("needs dense sand at two covers")
    return all_hold(exceeds(a, b) for a, b in itertools.pairwise(found))


def band_reach(member: Result, loss: float) -> float:
    """How far the shear band (eps_q from 5 % on) reaches above the crown, over C [-]."""
    (diameter,) = member.need("diameter")
    where = original_points(member)
    increment = member.next_to(loss)
    strain = increment.field("gauss/deviatoric_strain").ravel()
    height = (where[:, 1] - member.crown_height) / member.cover
    return max(trends.band_height(height, where[:, 0], strain, member.settings.aside * diameter, BAND))


def _bands(tunnels: Sequence[Tunnel], by: str) -> tuple[dict[str, Number], str]:
    """The reach of the bands by the names of the tunnels, and as text."""
    last = end(tunnels)
    found = {t.name: t.number(lambda member: band_reach(member, last)) for t in tunnels}
    text = each(tunnels, lambda t: f"{found[t.name]} C", by)
    return found, f"soil with 5 % of shear strain and more reaches, above the crown, at V_l = {percent(last)} {text}"


def bands_by_cover(study: Study) -> str:
    tunnels = study.covers()
    found, text = _bands(tunnels, "cover")
    claims: list[Claim] = []
    for tunnel in tunnels:
        reach = found[tunnel.name].mean
        if tunnel.cover_ratio < 2.5:
            claims.append((reach > 0.9, "shear bands reach the surface at C/D = 2"))
        elif tunnel.cover_ratio < 3.5:
            claims.append((0.1 < reach < 0.9, "shear bands close below the surface at C/D = 3"))
        else:
            claims.append((reach < 0.7, "shear bands stay low at C/D = 4"))
    return says(text, *claims)


def bands_by_soil(study: Study) -> str:
    dense, others = _beside_dense(study)
    found, text = _bands(study.soils(), "soil")
    claims: list[Claim] = []
    if loose := others.get("medium dense sand"):
        claims.append(
            (exceeds(found[loose.name], found[dense.name]), "shear bands go up farther in CPS_MD than in CPS_D")
        )
    if gravel := others.get("gravel"):
        claims.append(
            (exceeds(found[dense.name], found[gravel.name]), "shear bands go up less far in CPG_D than in CPS_D")
        )
    return says(text, *claims)


def _beside_dense(study: Study) -> tuple[Tunnel, dict[str, Tunnel]]:
    """The tunnel in dense sand, and those in other soils by their names."""
    others = {t.soil: t for t in study.soils() if t.soil != "dense sand"}
    if not others:
        raise Missing("needs dense sand and another soil at the same cover")
    return study.soil("dense sand"), others


def _growth(member: Result, window: tuple[float, float]) -> float:
    """dS/dV_l / D of the surface between two V_l [-]."""
    (diameter,) = member.need("diameter")
    return float(trends.slope(member.volume_loss, largest(member, 0.0), *window) / diameter)


def growth(study: Study) -> str:
    tunnels = study.covers()
    windows = ((0.0, 0.02), (0.08, 0.10), (0.175, 0.20))

    def rates(tunnel: Tunnel) -> list[Number]:
        return [tunnel.number(partial(_growth, window=window)) for window in windows]

    found = {t.name: rates(t) for t in tunnels}
    last = end(tunnels)
    settled = {t.name: t.number(lambda m: at(m, largest(m, 0.0), last)) for t in tunnels}

    def text(tunnel: Tunnel) -> str:
        rate = ", ".join(value.text(".3f") for value in found[tunnel.name])
        return f"{rate}, S = {settled[tunnel.name].text('.0f', 1e3, 'mm')} at {percent(last)}"

    claims: list[Claim] = [
        (all_hold(exceeds(a, b) for a, b, _ in found.values()), "the settlement slows until V_l = 10 %")
    ]
    for tunnel in tunnels:
        _, middle, late = found[tunnel.name]
        if tunnel.cover_ratio < 2.5:
            claims.append((exceeds(late, middle), "the surface of C/D = 2 accelerates again from 15 % on"))
        else:
            held = late.mean < 1.25 * middle.mean
            claims.append((held, f"the surface of C/D = {tunnel.cover_ratio:.3g} does not accelerate again"))
    return says(
        "the surface's settlement grows by dS/dV_l / D at V_l = 0 to 2, 8 to 10 and 17.5 to 20 %: "
        f"{each(tunnels, text)}",
        *claims,
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
    text = each(tunnels, lambda t: " to ".join(f"{i:.2f}" for i in spread[t.name]) + " m")
    claims: list[Claim] = [
        (worst < 0.05, "the curve fits the troughs well"),
        (all(b < a for a, b in spread.values()), "troughs narrow with V_l"),
    ]
    if len(tunnels) > 1:
        claims.append((spread[tunnels[0].name][1] < spread[tunnels[1].name][1], "troughs widen with C/D"))
    return says(
        f"the largest rms misfit of the mean troughs at z/C = 0 and {SUBSURFACE:g} is {percent(worst)} of S_max; the "
        f"inflection at the surface goes from V_l = {percent(0.25 * last)} to {percent(last)}: {text}",
        *claims,
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
    gradient = {t.name: t.number(lambda m: at(m, widths(m, 0.75), last) - at(m, widths(m, 0.0), last)) for t in tunnels}
    claims: list[Claim] = [
        (all(found.mean > 0.5 for found in inside.values()), f"K_s lies mostly between {low:g} and {high:g}")
    ]
    if len(tunnels) > 1:
        deep, shallow = gradient[tunnels[-1].name], gradient[tunnels[0].name]
        claims.append((exceeds(deep, shallow), "K varies less with depth in shallow ground"))
    rise = each(tunnels, lambda t: str(gradient[t.name]))
    return says(f"states with K_s in this range: {text}; K at z/C = 0.75 less K_s: {rise}", *claims)


def soils_settle(study: Study) -> str:
    tunnels = study.soils()
    last = end(tunnels)
    dense, others = _beside_dense(study)
    found = {t.soil: t.number(lambda m: at(m, largest(m, 0.0), last)) for t in tunnels}
    late = {
        t.soil: t.number(
            lambda m: (
                trends.slope(m.volume_loss, largest(m, 0.0), last / 2, last)
                / trends.slope(m.volume_loss, of_one.on_axis(m, SUBSURFACE), last / 2, last)
            )
        )
        for t in tunnels
    }
    text = each(
        tunnels,
        lambda t: (
            f"{found[t.soil].text('.0f', 1e3, 'mm')}, its growth in the second half over that at z/C = "
            f"{SUBSURFACE:g} {late[t.soil]}"
        ),
        "soil",
    )
    claims: list[Claim] = []
    if "medium dense sand" in others:
        claims.append((exceeds(found["medium dense sand"], found[dense.soil]), "CPS_MD settles more than CPS_D"))
        similar = 0.8 < late["medium dense sand"].mean < 1.25
        claims.append((similar, "the surface and the subsurface of CPS_MD settle at similar rates"))
    if "gravel" in others:
        claims.append((exceeds(late[dense.soil], late["gravel"]), "the settlement of CPG_D is more local than CPS_D's"))
    return says(f"settlement of the surface at V_l = {percent(last)}: {text}", *claims)


def reaction(study: Study) -> str:
    tunnels = study.soils()
    least = {t.soil: t.number(lambda m: float(curve(m)[1].min())) for t in tunnels}
    when = {t.soil: t.number(lambda m: float(m.volume_loss[curve(m)[1].argmin()])) for t in tunnels}
    final = {t.soil: t.number(lambda m: float(curve(m)[1][-1])) for t in tunnels}
    recovery = {t.soil: t.number(lambda m: recovery_factor(*curve(m)[:2])) for t in tunnels}
    claims: list[Claim] = []
    for tunnel in tunnels:
        gain = recovery[tunnel.soil]
        if tunnel.soil == "medium dense sand":
            claims.append((exceeds(Number(MONOTONE, 0.0, 0), gain), "CPS_MD falls monotonically to its end value"))
        else:
            claims.append((exceeds(gain, Number(RECOVERS, 0.0, 0)), f"{tunnel.code} has a minimum and recovers"))
    if {"gravel", "dense sand"} <= set(least):
        claims.append((exceeds(least["dense sand"], least["gravel"]), "the minimum of CPG_D is lower"))
    text = each(
        tunnels,
        lambda t: (
            f"least {least[t.soil].text('.3f')} at V_l = {when[t.soil].text('.1f', 100, '%')}, "
            f"{final[t.soil].text('.3f')} at the end, end over minimum of running means {recovery[t.soil].text('.2f')}"
        ),
        "soil",
    )
    return says(f"over the stress before the loss: {text}", *claims)


Profile = Callable[[Result, Increment], tuple[np.ndarray, np.ndarray, np.ndarray]]


def _change(member: Result, profile: Profile, near: float, loss: float, which: int) -> float:
    """The mean of the horizontal (0) or vertical (1) stress where the place along the line is within `near` D, over the
    one before the loss [-]."""
    (diameter,) = member.need("diameter")
    increment = member.next_to(loss)
    means = []
    for state in (member.start, increment):
        place, xx, yy = profile(member, state)
        inside = place <= near * diameter
        means.append(float((xx, yy)[which][inside].mean()))
    return means[1] / means[0]


def stresses(study: Study) -> str:
    tunnel = study.main()
    above = [tunnel.number(partial(_change, profile=profiles.above, near=1.0, loss=0.05, which=k)) for k in (0, 1)]
    beside = [tunnel.number(partial(_change, profile=profiles.beside, near=1.5, loss=0.02, which=k)) for k in (0, 1)]
    one = Number(1.0, 0.0, 0)
    return says(
        f"over the values before the loss, horizontal and vertical stress are {above[0]} and {above[1]} in the first D "
        f"above the crown at V_l = 5 %, {beside[0]} and {beside[1]} in the first D beside the tunnel at 2 %",
        (exceeds(above[0], one), "the horizontal stress rises above the crown"),
        (exceeds(one, above[1]), "the vertical stress falls above the crown"),
        (exceeds(one, beside[0]), "the horizontal stress falls beside the tunnel"),
        (exceeds(beside[1], one), "the vertical stress rises beside the tunnel"),
    )
