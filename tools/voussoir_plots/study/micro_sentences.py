"""One sentence for each figure of the RVEs: our numbers over the members, and whether they show what the paper
reports."""

from functools import partial

import numpy as np

from .. import chains as networks
from .. import points, tensors, trends
from ..resolution import percent
from ..result import Missing, Result
from .bands import Number, number
from .data import Study
from .microstructure import NEAR, NETWORK_LOSS, arch_points, fabric_at, nearest_snapshot, strong_contacts, strong_share
from .paths import STRONG, at_point, followed, point, ratio_at, strong_at
from .sentences import each, says
from .settlements import wanted_losses
from .stresses import directions, mean_difference


def fabric(study: Study) -> str:
    tunnel = study.main()

    def found(member: Result, name: str, when: int) -> tuple[float, float]:
        index = {p.name: p.index for p in arch_points(member)}[name]
        return fabric_at((member.start, member.loss_increments[-1])[when], index)

    parts, turned = [], {}
    for name in ("A", "B", "C"):
        both = [[found(member, name, when) for member in tunnel.members] for when in (0, 1)]
        before, after = (number([a for a, _ in one]) for one in both)
        axes = [_mean_axis([angle for _, angle in one]) for one in both]
        turned[name] = (before.mean, after.mean, axes[1])
        parts.append(f"{name}: a from {before} to {after}, direction from {axes[0]:.0f}° to {axes[1]:.0f}°")
    holds = (
        all(after > before for before, after, _ in turned.values())
        and abs(turned["A"][2]) < 30
        and abs(abs(turned["C"][2]) - 90) < 30
    )
    return says(
        holds,
        "anisotropy grows at all three points, contacts turn level at A and stay vertical at C",
        f"fabric before the loss and at V_l = {percent(float(tunnel.loss[-1]))}, directions from the horizontal: "
        + "; ".join(parts),
    )


def _mean_axis(angles: list[float]) -> float:
    """The mean of directions without an arrow [deg], in (-90, 90]."""
    return float(np.degrees(tensors.axis_angle(0.5 * np.angle(np.mean(np.exp(2j * np.array(angles)))))))


def rotation(study: Study) -> str:
    tunnel = study.main()
    found = {
        loss: number(mean_difference(*directions(tunnel, loss)[1:]))
        for loss in wanted_losses(tunnel, study.settings.field_losses)
    }
    text = ", ".join(f"{value.text('.1f')}° at V_l = {percent(loss)}" for loss, value in found.items())
    return says(
        all(value.mean < 20 for value in found.values()),
        "the turn of the stress closely matches the direction of the fabric",
        f"along the line {study.settings.line:g} D above the crown both differ on average by {text}",
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
        min(turned.mean, dilated.mean) > 0.5,
        "strain, grain rotation and void ratio localise in the same places",
        f"of the 5 % most sheared points {turned.text('.0f', 100, '%')} are among the 5 % most turned and "
        f"{dilated.text('.0f', 100, '%')} among the 5 % most dilated",
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
    ordered = all(np.isfinite(known)) and all(a < b for a, b in zip(known, known[1:]))
    turned = ", ".join(f"{name} {_loss(value)}" for name, value in when.items())
    return says(
        ordered and all(value.mean < 0 for value in drops.values()),
        "contacts turn level one after another from the crown upwards, and get lost at Aa and B",
        f"the fabric turns within 30° of the horizontal, with a above 0.1, at {turned}; Z_m changes by {drops['Aa']} at "
        f"Aa and by {drops['B']} at B until the end",
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
    order = [peaks[n][0].mean for n in names]
    text = "; ".join(
        f"{n}: least q/p at V_l = {lowest[n].text('.1f', 100, '%')}, peak {peaks[n][1]} at "
        f"{peaks[n][0].text('.1f', 100, '%')}, softening after it in {round(peaks[n][2].mean * peaks[n][2].count)} of "
        f"{peaks[n][2].count}"
        for n in names
    )
    return says(
        all(a < b for a, b in zip(order, order[1:])) and peaks[names[0]][2].mean > 0.5,
        "q/p falls first, Aa softens first, then Ab peaks, Ac last",
        text,
    )


def _known(ratio: np.ndarray) -> np.ndarray:
    if not np.isfinite(ratio).any():
        raise Missing("the point is hardly compressed at any time")
    return ratio


def paths_by_soil(study: Study) -> str:
    tunnels = study.soils()
    names = [p.name for p in followed(tunnels[0].representative)]
    most = {
        t.soil: {n: t.number(lambda m, n=n: float(np.nanmax(_known(ratio_at(n, m))))) for n in names} for t in tunnels
    }
    volume = {
        t.soil: {n: t.number(lambda m, n=n: float(at_point(n, "volumetric_strain", m)[-1])) for n in names}
        for t in tunnels
    }
    if "dense sand" not in most or len(most) < 2:
        raise Missing("needs dense sand and another soil at the same cover")
    dense = most["dense sand"]
    holds = all(most.get("gravel", dense)[n].mean >= dense[n].mean for n in names) and all(
        most.get("medium dense sand", dense)[n].mean <= dense[n].mean for n in names
    )
    text = each(
        tunnels,
        lambda t: ", ".join(
            f"{n} {most[t.soil][n]} and {volume[t.soil][n].text('.2f', 100, '%')}" for n in names
        ),
        "soil",
    )
    return says(
        holds,
        "lower q/p and contraction at Ab, Ac in CPS_MD, higher q/p and more dilation in CPG_D",
        f"largest q/p, and volumetric strain at the end (contraction positive): {text}",
    )


def connectivity(study: Study) -> str:
    tunnels = study.soils()
    first = {t.soil: t.number(lambda m: float(at_point("Aa", "mechanical_coordination", m)[0])) for t in tunnels}
    strong = {
        t.soil: [
            t.number(lambda m, field=field: float(np.nanmean(strong_at("Aa", field, m)))) for field in STRONG.values()
        ]
        for t in tunnels
    }
    dense, loose = first.get("dense sand"), first.get("medium dense sand")
    holds = dense is None or loose is None or loose.mean < dense.mean
    if {"dense sand", "gravel"} <= set(strong):
        holds = holds and all(g.mean > d.mean for g, d in zip(strong["gravel"], strong["dense sand"]))
    text = each(
        tunnels, lambda t: f"{first[t.soil]}; {', '.join(str(value) for value in strong[t.soil])}", "soil"
    )
    return says(
        holds,
        "Z_m is lower in CPS_MD at first; the strong network of CPG_D is better connected",
        f"at Aa, Z_m at V_l = 0, and Z_m of the contacts with f_n of 1, 2 and 2.5 times the mean and more, on average over "
        f"V_l: {text}",
    )


def strong_networks(study: Study) -> str:
    tunnels = study.soils()
    found = {t.soil: [t.number(partial(_strong, which=k)) for k in (0, 1, 2)] for t in tunnels}
    text = each(tunnels, lambda t: _networks(found[t.soil]), "soil")
    dense, gravel, loose = (found.get(soil) for soil in ("dense sand", "gravel", "medium dense sand"))
    holds = (dense is None or gravel is None or gravel[0].mean > dense[0].mean) and (
        dense is None or loose is None or loose[2].mean < dense[2].mean
    )
    return says(
        holds,
        "in CPG_D the strong network spans the whole RVE, in sand it is sparser, in CPS_MD less level",
        f"at Aa near V_l = {percent(NETWORK_LOSS)} {text}",
    )


def _strong(member: Result, which: int) -> float:
    """Of the RVE that was written near Aa: the share of its grains in the strong network (0) and in its strongest part
    (1), and the share of the strong contacts within 45° of the horizontal (2)."""
    (diameter,) = member.need("diameter")
    increment = member.loss_increments[int(np.argmin(np.abs(member.volume_loss - NETWORK_LOSS)))]
    name = nearest_snapshot(member, point(member, "Aa").position, NEAR * diameter)[1]
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

