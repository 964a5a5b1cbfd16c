"""One sentence for each figure of the RVEs: our numbers over the members, and whether they show what the paper
reports."""

import itertools
from functools import partial

import numpy as np

from .. import chains as networks
from .. import points, trends
from ..resolution import percent
from ..result import Missing, Result
from .bands import Number, all_hold, exceeds, number
from .data import Study
from .microstructure import NETWORK_LOSS, arch_points, fabric_at, near_aa, strong_contacts, strong_share
from .paths import STRONG, at_point, followed, point, ratio_at, strong_at
from .sentences import Claim, each, says
from .settlements import wanted_losses
from .stresses import directions, mean_axis, mean_difference


def fabric(study: Study) -> str:
    tunnel = study.main()

    def found(member: Result, name: str, when: int) -> tuple[float, float]:
        index = {p.name: p.index for p in arch_points(member)}[name]
        return fabric_at((member.start, member.loss_increments[-1])[when], index)

    parts, turned = [], {}
    for name in ("A", "B", "C"):
        both = [[found(member, name, when) for member in tunnel.members] for when in (0, 1)]
        before, after = (number([a for a, _ in one]) for one in both)
        axes = [float(np.degrees(mean_axis(np.array([angle for _, angle in one])))) for one in both]
        turned[name] = (before, after, axes[1])
        parts.append(f"{name}: a from {before} to {after}, direction from {axes[0]:.0f}° to {axes[1]:.0f}°")
    return says(
        f"the fabric before the loss and at V_l = {percent(float(tunnel.loss[-1]))}, directions from the horizontal: "
        + "; ".join(parts),
        (
            all_hold(exceeds(after, before) for before, after, _ in turned.values()),
            "the anisotropy a grows at A, B and C",
        ),
        (abs(turned["A"][2]) < 30, "contacts turn level at A"),
        (30 < abs(turned["B"][2]) < 75, "contacts turn at B"),
        (abs(turned["C"][2]) > 60, "contacts stay vertical at C"),
    )


def rotation(study: Study) -> str:
    tunnel = study.main()
    found = {
        loss: number(mean_difference(*directions(tunnel, loss)[1:]))
        for loss in wanted_losses(tunnel, study.settings.field_losses)
    }
    text = ", ".join(f"{value.text('.1f')}° at V_l = {percent(loss)}" for loss, value in found.items())
    return says(
        f"along the line {study.settings.line:g} D above the crown both differ on average by {text}",
        (
            all(value.mean < 20 for value in found.values()),
            "the turn of the stress matches the direction of the fabric",
        ),
    )


def localisation(study: Study) -> str:
    tunnel = study.main()

    def share(member: Result, which: int) -> float:
        first, last = member.start, member.loss_increments[-1]
        turn, dilation = (
            (last.field(f"gauss/{name}") - first.field(f"gauss/{name}")).ravel()
            for name in ("grain_rotation", "void_ratio")
        )
        return trends.overlaps(last.field("gauss/deviatoric_strain").ravel(), turn, dilation)[which]

    turned, dilated = (tunnel.number(partial(share, which=k)) for k in (0, 1))
    return says(
        f"of the 5 % most sheared points {turned.text('.0f', 100, '%')} are among the 5 % most turned and "
        f"{dilated.text('.0f', 100, '%')} among the 5 % most dilated",
        (turned.mean > 0.5, "grain rotation localises where the shear strain does"),
        (dilated.mean > 0.5, "the void ratio localises where the shear strain does"),
    )


def chains(study: Study) -> str:
    tunnel = study.main()

    def drop(member: Result, name: str) -> float:
        where = points.in_the_band(member) if name == "B" else point(member, name)
        history = points.history(member, "gauss/mechanical_coordination", where)
        return float(history[-1] - history[0])

    def level(member: Result, name: str) -> float:
        """V_l from which the fabric is within 30° of the horizontal [-]; NaN where it never is."""
        angle = np.abs(at_point(name, "fabric_direction", member))
        strong = at_point(name, "fabric_anisotropy", member) > 0.1
        turned = np.flatnonzero((angle < np.pi / 6) & strong)
        return float(member.volume_loss[turned[0]]) if len(turned) else np.nan

    names = [p.name for p in followed(tunnel.representative)]
    when = {name: tunnel.number(partial(level, name=name)) for name in names}
    drops = {name: tunnel.number(partial(drop, name=name)) for name in ("Aa", "B")}
    known = [w.mean for w in when.values()]
    ordered = all(np.isfinite(known)) and all(a < b for a, b in itertools.pairwise(known))
    turned = ", ".join(f"{name} {_loss(value)}" for name, value in when.items())
    none = Number(0.0, 0.0, 0)
    return says(
        f"the fabric is within 30° of the horizontal, with a above 0.1, from these V_l on: {turned}; Z_m changes by "
        f"{drops['Aa']} at Aa and by {drops['B']} at B until the end",
        (ordered, "contacts turn level one after another from the crown upwards"),
        (all_hold(exceeds(none, value) for value in drops.values()), "contacts get lost at Aa and B"),
    )


def _loss(value: Number) -> str:
    return f"at V_l = {value.text('.1f', 100, '%')}" if np.isfinite(value.mean) else "never"


def paths(study: Study) -> str:
    tunnel = study.main()
    names = [p.name for p in followed(tunnel.representative)]

    def least(member: Result, name: str) -> float:
        return float(member.volume_loss[np.nanargmin(_known(ratio_at(name, member)))])

    def peak(member: Result, name: str, which: int) -> float:
        return float(trends.peak_after_unloading(member.volume_loss, _known(ratio_at(name, member)))[which])

    lowest = {n: tunnel.number(partial(least, name=n)) for n in names}
    peaks = {n: [tunnel.number(partial(peak, name=n, which=k)) for k in (0, 1, 2)] for n in names}
    text = "; ".join(
        f"{n}: least q/p at V_l = {lowest[n].text('.1f', 100, '%')}, peak {peaks[n][1]} at "
        f"{peaks[n][0].text('.1f', 100, '%')}, softening after it in {round(peaks[n][2].mean * peaks[n][2].count)} of "
        f"{peaks[n][2].count}"
        for n in names
    )
    order = [peaks[n][0].mean for n in names]
    return says(
        text,
        (min(low.mean for low in lowest.values()) > 0.01, "q/p falls at first"),
        (peaks[names[0]][2].mean > 0.5, "Aa softens after its peak"),
        (_follow(order), "the peaks follow one another from Aa upwards"),
    )


def _follow(order: list[float]) -> bool:
    """Whether Aa peaks first and no point before the one below it; two that still rise at the end have no order."""
    return order[0] < order[-1] and all(a <= b for a, b in itertools.pairwise(order))


def _known(ratio: np.ndarray) -> np.ndarray:
    if not np.isfinite(ratio).any():
        raise Missing("the point is hardly compressed at any time")
    return ratio


def _most(member: Result, name: str) -> float:
    """The largest q/p of a point [-]."""
    return float(np.nanmax(_known(ratio_at(name, member))))


def _final_volume(member: Result, name: str) -> float:
    """The volumetric strain of a point at the end [-], contraction positive."""
    return float(at_point(name, "volumetric_strain", member)[-1])


def _mean_strong(member: Result, field: str) -> float:
    """Z_m of a strong network at Aa, mean over the volume loss [-]."""
    return float(np.nanmean(strong_at("Aa", field, member)))


def paths_by_soil(study: Study) -> str:
    tunnels = study.soils()
    names = [p.name for p in followed(tunnels[0].representative)]
    most = {t.soil: {n: t.number(partial(_most, name=n)) for n in names} for t in tunnels}
    volume = {t.soil: {n: t.number(partial(_final_volume, name=n)) for n in names} for t in tunnels}
    claims: list[Claim] = []
    if "dense sand" in most and "medium dense sand" in most:
        pairs = [(most["dense sand"][n], most["medium dense sand"][n]) for n in names]
        claims.append((all_hold(exceeds(*pair) for pair in pairs), "q/p stays lower in CPS_MD"))
        loose = [volume["medium dense sand"][n] for n in names if n != "Aa"]
        none = Number(0.0, 0.0, 0)
        claims.append((all_hold(exceeds(value, none) for value in loose), "the RVEs Ab and Ac of CPS_MD contract"))
    if "dense sand" in most and "gravel" in most:
        pairs = [(most["gravel"][n], most["dense sand"][n]) for n in names]
        claims.append((all_hold(exceeds(*pair) for pair in pairs), "q/p grows higher in CPG_D"))
        dilates = [exceeds(volume["dense sand"][n], volume["gravel"][n]) for n in names if n != "Ac"]
        claims.append((all_hold(dilates), "the RVEs Aa and Ab of CPG_D dilate more"))
    if not claims:
        raise Missing("needs dense sand and another soil at the same cover")
    text = each(
        tunnels,
        lambda t: ", ".join(f"{n} {most[t.soil][n]} and {volume[t.soil][n].text('.2f', 100, '%')}" for n in names),
        "soil",
    )
    return says(f"the largest q/p, and the volumetric strain at the end (contraction positive): {text}", *claims)


def connectivity(study: Study) -> str:
    tunnels = study.soils()
    first = {t.soil: t.number(lambda m: float(at_point("Aa", "mechanical_coordination", m)[0])) for t in tunnels}
    strong = {t.soil: [t.number(partial(_mean_strong, field=field)) for field in STRONG.values()] for t in tunnels}
    claims: list[Claim] = []
    if {"dense sand", "medium dense sand"} <= set(first):
        claims.append((exceeds(first["dense sand"], first["medium dense sand"]), "Z_m is lower in CPS_MD at first"))
    if {"dense sand", "gravel"} <= set(strong):
        near = abs(first["gravel"].mean - first["dense sand"].mean) < 0.1 * first["dense sand"].mean
        claims.append((near, "Z_m hardly differs between CPS_D and CPG_D"))
        pairs = zip(strong["gravel"], strong["dense sand"])
        claims.append((all_hold(exceeds(*p) for p in pairs), "the strong network of CPG_D is better connected"))
    text = each(tunnels, lambda t: f"{first[t.soil]}; {', '.join(str(value) for value in strong[t.soil])}", "soil")
    return says(
        "at Aa, Z_m at V_l = 0, and Z_m of the contacts with f_n of 1, 2 and 2.5 times the mean and more, on average "
        f"over V_l, are {text}",
        *claims,
    )


def strong_networks(study: Study) -> str:
    tunnels = study.soils()
    found = {t.soil: [t.number(partial(_strong, which=k)) for k in (0, 1, 2)] for t in tunnels}
    text = each(tunnels, lambda t: _networks(found[t.soil]), "soil")
    dense, gravel, loose = (found.get(soil) for soil in ("dense sand", "gravel", "medium dense sand"))
    claims: list[Claim] = []
    if dense and gravel:
        claims.append((exceeds(gravel[0], dense[0]), "more grains of CPG_D than of CPS_D are in the strong network"))
    if dense and loose:
        claims.append((exceeds(dense[2], loose[2]), "the strong network of CPS_MD is less level than that of CPS_D"))
    return says(f"at Aa near V_l = {percent(NETWORK_LOSS)} {text}", *claims)


def _strong(member: Result, which: int) -> float:
    """Of the RVE that was written near Aa: the share of its grains in the strong network (0) and in its strongest part
    (1), and the share of the strong contacts within 45° of the horizontal (2)."""
    increment, name = near_aa(member)
    if name is None:
        raise Missing("no RVE near Aa was written grain by grain (output.rves)")
    snapshot = increment.snapshot(name)
    if which < 2:
        return strong_share(snapshot, (networks.STRONG, networks.STRONGEST)[which])
    branch = snapshot["branch"][strong_contacts(snapshot, networks.STRONG)]
    return float(np.mean(np.abs(branch[:, 0]) > np.abs(branch[:, 1]))) if len(branch) else np.nan


def _networks(values: list[Number]) -> str:
    strong, strongest, level = (value.text(".0f", 100, "%") for value in values)
    return f"{strong} of the grains are in C1 or C2, {strongest} in C2, {level} of these contacts are level"
