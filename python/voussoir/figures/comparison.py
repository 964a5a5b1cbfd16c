"""Compares several tunnels, as the study compares covers and soils."""

import itertools
from collections.abc import Callable, Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from . import paths, points, resolution, settlements, trends, troughs, widths
from .reaction import curve
from .resolution import percent
from .result import Missing, Result
from .style import save


def name(result: Result) -> str:
    """ "dense sand, C/D = 3", for legends."""
    (diameter,) = result.need("diameter")
    return f"{result.soil}, $C/D$ = {result.cover / diameter:.3g}"


def cover_ratio(result: Result) -> float:
    (diameter,) = result.need("diameter")
    return result.cover / diameter


def draw(results: Sequence[Result], path: Path) -> None:
    figure, axes = plt.subplots(2, 3, figsize=(16.5, 9.2))
    for k, result in enumerate(results):
        style = {"color": f"C{k}", "label": name(result), "linewidth": 1.5}
        loss = 100 * result.volume_loss
        axes[0, 0].plot(loss, curve(result)[1], **style)
        for depth, line in ((0.0, "-"), (0.75, "--")):
            axes[0, 1].plot(
                loss,
                1e3 * settlements.on_axis(result, depth),
                line,
                **{**style, "label": f"{style['label']}, z/C = {depth:g}"},
            )
        width_loss, width, _ = widths.surface_width(result)
        axes[0, 2].plot(100 * width_loss, width, **style)
        for axis, point, height in zip(axes[1], points.above_crown(result), points.heights_above_crown(result)):
            axis.plot(loss, paths.stress_ratio(result, point), **style)
            axis.set_title(f"{point.name}, {height:g} $D$ above the crown")
            axis.set_ylabel("stress ratio  $q/p$  [-]")
            axis.set_ylim(0, 1.05)
    axes[0, 0].set_ylabel(r"$\sigma_v / \sigma_{v,0}$ above the crown  [-]")
    axes[0, 0].set_ylim(bottom=0)
    axes[0, 0].set_title("ground reaction curve")
    axes[0, 1].set_ylabel("settlement at $x$ = 0  [mm]")
    axes[0, 1].set_title("settlement above the crown")
    axes[0, 2].set_ylabel("width of the surface trough  $K_s$  [-]")
    axes[0, 2].axhspan(*results[0].settings.range_of_k, color="0.88", zorder=0)
    axes[0, 2].set_ylim(bottom=0)
    axes[0, 2].set_title("grey: Mair and Taylor's range")
    for axis in axes.flat:
        axis.set_xlabel("volume loss  $V_l$  [%]")
        axis.set_xlim(left=0)
        axis.legend(fontsize=8)
    figure.tight_layout()
    save(figure, path)


def common_loss(results: Sequence[Result]) -> float:
    """The largest V_l that all runs reached [-]."""
    return min(result.volume_loss[-1] for result in results)


def widening(results: Sequence[Result]) -> trends.Trend:
    """Troughs widen with C/D: inflection of the surface trough of the dense sands, by cover."""
    chosen = sorted((r for r in results if r.nearest_soil == "dense sand"), key=cover_ratio)
    if len({round(cover_ratio(r), 2) for r in chosen}) < 2:
        raise Missing("needs two covers of dense sand")
    loss = common_loss(chosen)
    found = [(cover_ratio(r), np.interp(loss, *_inflection(r))) for r in chosen]
    holds = all(a[1] < b[1] for a, b in itertools.pairwise(found))
    return trends.Trend(
        "Troughs widen with C/D",
        trends.verdict(holds),
        f"inflection of the surface trough at V_l = {percent(loss)}: "
        + ", ".join(f"C/D = {c:.3g}: {i:.2f} m" for c, i in found),
    )


def _inflection(result: Result) -> tuple[np.ndarray, np.ndarray]:
    surface = [t for (ratio, _), t in troughs.all_troughs(result).items() if ratio == 0]
    return np.array([t.loss for t in surface]), np.array([t.fit.inflection for t in surface])


def depth_dependence(results: Sequence[Result]) -> trends.Trend:
    """K varies less with depth for shallow tunnels: measured is the largest minus the least K, z/C from 0 to 0.75."""
    chosen = sorted((r for r in results if r.nearest_soil == "dense sand"), key=cover_ratio)
    if len({round(cover_ratio(r), 2) for r in chosen}) < 2:
        raise Missing("needs two covers of dense sand")
    loss, found = common_loss(chosen), []
    for result in chosen:
        near = result.nearest([loss])
        if not near:
            raise Missing(f"{result.folder} has no state near V_l = {percent(loss)}")
        increment = near[-1]
        width = [
            t.width
            for (ratio, v), t in troughs.all_troughs(result).items()
            if v == increment["volume_loss"] and ratio < 1
        ]
        if not width:
            raise Missing("no depth above the crown was asked for (--depths)")
        found.append((cover_ratio(result), max(width) - min(width)))
    holds = all(a[1] < b[1] for a, b in itertools.pairwise(found))
    return trends.Trend(
        "K varies less with depth for shallow tunnels",
        trends.verdict(holds),
        f"largest less least K above the crown at V_l = {percent(loss)}: "
        + ", ".join(f"C/D = {c:.3g}: {k:.2f}" for c, k in found),
    )


def pair(results: Sequence[Result], soil: str) -> tuple[Result, Result]:
    """Dense sand and another soil at the same cover."""
    for other in (r for r in results if r.soil == soil):
        for dense in (r for r in results if r.soil == "dense sand" and abs(cover_ratio(r) - cover_ratio(other)) < 0.01):
            return dense, other
    raise Missing(f"needs dense sand and {soil} at the same cover")


def looser_settles_more(results: Sequence[Result]) -> trends.Trend:
    """Medium dense sand settles more than dense sand, at the surface and below it at similar rates."""
    dense, loose = pair(results, "medium dense sand")
    loss = common_loss((dense, loose))
    both = {
        z: [float(np.interp(loss, r.volume_loss, settlements.on_axis(r, z))) for r in (dense, loose)]
        for z in (0.0, 0.5)
    }
    text = "; ".join(f"z/C = {z:g}: {1e3 * a:.0f} and {1e3 * b:.0f} mm" for z, (a, b) in both.items())
    late = {z: trends.slope(loose.volume_loss, settlements.on_axis(loose, z), loss / 2, loss) for z in (0.0, 0.5)}
    if not all(np.isfinite(rate) and rate > 0 for rate in late.values()):
        raise Missing(f"{loose.folder} has too few states from V_l = {percent(loss / 2)} on, or does not settle")
    similar = 0.8 < late[0.0] / late[0.5] < 1.25
    return trends.Trend(
        "Medium dense sand settles more, surface and subsurface at similar rates",
        trends.verdict(all(b > a for a, b in both.values()) and similar),
        f"dense and medium dense at V_l = {percent(loss)}: {text}; slopes of surface over subsurface in the "
        f"second half {late[0.0] / late[0.5]:.2f}",
    )


def gravel_reacts(results: Sequence[Result]) -> trends.Trend:
    """The ground reaction curve of gravel is steeper, goes lower and recovers later."""
    dense, gravel = pair(results, "gravel")
    numbers = []
    for result in (dense, gravel):
        loss, ratio, _ = curve(result)
        if resolution.coarse_path(loss) or resolution.few_states(loss, 0, 0.01, 2):
            raise Missing(f"the states of {result.folder} lie too far from one another")
        least = int(np.argmin(ratio))
        numbers.append((trends.slope(loss, ratio, 0, 0.01), ratio[least], loss[least]))
    (slope_a, low_a, at_a), (slope_b, low_b, at_b) = numbers
    return trends.Trend(
        "Ground reaction of gravel: steeper, lower, slower to recover than dense sand's",
        trends.verdict(slope_b < slope_a and low_b < low_a and at_b >= at_a),
        f"dense sand and gravel: slope to V_l = 1 % {slope_a:.1f} and {slope_b:.1f}; minimum {low_a:.3f} at "
        f"{percent(at_a)} and {low_b:.3f} at {percent(at_b)}",
    )


def gravel_is_stronger(results: Sequence[Result]) -> trends.Trend:
    """RVEs of gravel reach a higher q/p than those of dense sand."""
    dense, gravel = pair(results, "gravel")
    ratios = [
        trends.compressed({p.name: paths.stress_ratio(r, p) for p in points.above_crown(r)}) for r in (dense, gravel)
    ]
    most = [{name: float(np.nanmax(ratio)) for name, ratio in of_one.items()} for of_one in ratios]
    common = [name for name in most[0] if name in most[1]]
    if not common:
        raise Missing("no point above the crown is compressed in both runs")
    text = "; ".join(f"{name}: {most[0][name]:.2f} and {most[1][name]:.2f}" for name in common)
    return trends.Trend(
        "RVEs of gravel reach a higher q/p",
        trends.verdict(all(most[1][n] > most[0][n] for n in common)),
        f"largest q/p, dense sand and gravel: {text}",
    )


def looser_is_less_connected(results: Sequence[Result]) -> trends.Trend:
    """Z_m is lower in medium dense sand only at first."""
    dense, loose = pair(results, "medium dense sand")
    loss, field = common_loss((dense, loose)), "gauss/mechanical_coordination"
    early, late = [], []
    for result in (dense, loose):
        history = np.mean([points.history(result, field, p) for p in points.above_crown(result)], axis=0)
        early.append(history[0])
        late.append(float(np.interp(loss, result.volume_loss, history)))
    holds = early[1] < early[0] - 0.05 and abs(late[1] - late[0]) < abs(early[1] - early[0])
    return trends.Trend(
        "Z_m is lower in medium dense sand early only",
        trends.verdict(holds),
        f"mean of Aa, Ab, Ac, dense and medium dense: {early[0]:.2f} and {early[1]:.2f} at V_l = 0, {late[0]:.2f} and "
        f"{late[1]:.2f} at {percent(loss)}",
    )


def gravel_is_as_connected(results: Sequence[Result]) -> trends.Trend:
    """Z_m of gravel equals that of dense sand, but the strong network of gravel is better connected."""
    dense, gravel = pair(results, "gravel")
    means = {}
    for field in ("mechanical_coordination", "strong_coordination_1", "strong_coordination_2"):
        means[field] = [
            float(np.mean([points.history(r, f"gauss/{field}", p) for p in points.above_crown(r)]))
            for r in (dense, gravel)
        ]
    a, b = means["mechanical_coordination"]
    holds = abs(a - b) < 0.1 * a and all(means[f][1] > means[f][0] for f in means if f.startswith("strong"))
    text = "; ".join(f"{field}: {x:.2f} and {y:.2f}" for field, (x, y) in means.items())
    return trends.Trend(
        "Z_m of gravel is that of dense sand, its strong network better connected",
        trends.verdict(holds),
        f"means over Aa, Ab, Ac and V_l, dense sand and gravel: {text}",
    )


TRENDS = (
    widening,
    depth_dependence,
    looser_settles_more,
    gravel_reacts,
    gravel_is_stronger,
    looser_is_less_connected,
    gravel_is_as_connected,
)


def statement(judge: Callable[[Sequence[Result]], trends.Trend]) -> str:
    return (judge.__doc__ or "").split(":")[0].rstrip(".")
