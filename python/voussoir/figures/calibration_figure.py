"""The picture of a calibration: the misfit and each observable over the parameters, and whether the targets are met."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

from .calibration import PARAMETERS, Observable, Search, misfit
from .result import RunIndex
from .style import CYCLE, SEQUENTIAL, save

Sets = dict[str, np.ndarray]


def draw(run: RunIndex, path: Path) -> None:
    search = Search(run)
    figure, axes = plt.subplots(2, 3, figsize=(16.5, 9))
    draw_one = _draw_line if len(search.searched) == 1 else _draw_plane
    sets = search.plane()
    found = search.surfaces(sets)
    draw_one(axes.flat[0], search, sets, None if found is None else misfit(found, run), None)
    axes.flat[0].set_title("misfit: squared differences over tolerances")
    for axis, one in zip(axes.flat[1:], search.observables):
        draw_one(axis, search, sets, None if found is None else one.factor * found[one.name], one)
        axis.set_title(f"{one.symbol}, accepted {one.factor * one.low:.3g} to {one.factor * one.high:.3g} {one.unit}")
    _write_verdicts(axes.flat[5], search)
    figure.suptitle(_title(search, found is None), fontsize=12)
    figure.tight_layout()
    save(figure, path)


def _title(search: Search, bare: bool) -> str:
    parts = [f"{int(search.usable.sum())} of {len(search.usable)} sets usable (circles; crosses: not)"]
    if bare:
        parts.append("too few for a surface")
    fixed = [f"{_symbol(name)} = {search.best(name):.3g}" for name in search.searched[2:]]
    if fixed:
        parts.append(f"surfaces at {', '.join(fixed)}")
    return f"Calibration {search.run.case.get('title', '')}: " + "; ".join(parts)


def _symbol(parameter: str) -> str:
    return PARAMETERS[parameter].split("  ")[1]


def _measured(search: Search, one: Observable | None) -> np.ndarray:
    return search.sets["misfit"] if one is None else one.factor * search.sets[one.name]


def _label(one: Observable | None) -> str:
    return "misfit  [-]" if one is None else f"{one.symbol}  [{one.unit}]"


def _draw_line(axis: Axes, search: Search, sets: Sets, values: np.ndarray | None, one: Observable | None) -> None:
    """One parameter: the sets with their standard deviations over the packings, and the curve through them."""
    (name,) = search.searched
    measured, usable = _measured(search, one), search.usable
    error = None if one is None else one.factor * search.sets[f"{one.name}_deviation"][usable]
    axis.errorbar(search.sets[name][usable], measured[usable], yerr=error, fmt="o", color=CYCLE[0], capsize=3)
    if values is not None:
        axis.plot(sets[name], values, color=CYCLE[0])
    if one is not None:
        axis.axhspan(one.factor * one.low, one.factor * one.high, color=CYCLE[2], alpha=0.2, zorder=0)
    axis.axvline(search.best(name), color="black", linestyle="--", linewidth=1)
    axis.set_xscale("log")
    _plain_ticks(axis, search)
    axis.set_xlabel(PARAMETERS[name])
    axis.set_ylabel(_label(one))


def _draw_plane(axis: Axes, search: Search, sets: Sets, values: np.ndarray | None, one: Observable | None) -> None:
    """Two parameters: the surface, the range that the case accepts, and the sets in the same colours."""
    first, second = search.searched[:2]
    measured = _measured(search, one)[search.usable]
    x, y = search.sets[first], search.sets[second]
    shown = measured if values is None else np.concatenate([values, measured])
    if one is None:  # a misfit spans decades
        shown, measured = np.log10(np.maximum(shown, 1e-3)), np.log10(np.maximum(measured, 1e-3))
    limits = shown.min(), max(shown.max(), shown.min() + 1e-9)
    if values is not None:
        _draw_surface(axis, [sets[first], sets[second], values], limits, one)
    colours = ScalarMappable(Normalize(*limits), SEQUENTIAL)
    axis.scatter(x[search.usable], y[search.usable], s=70, c=colours.to_rgba(measured), edgecolors="white", zorder=3)
    axis.plot(x[~search.usable], y[~search.usable], "x", color="black", markersize=7, zorder=3)
    axis.plot(search.best(first), search.best(second), "*", color="white", mec="black", markersize=16, zorder=4)
    plt.colorbar(colours, ax=axis, label=r"$\log_{10}$ misfit  [-]" if one is None else _label(one))
    axis.use_sticky_edges = False  # the sets at the rim of the surface are shown whole
    axis.margins(0.06)
    axis.set_xscale("log")
    axis.set_yscale("log")
    _plain_ticks(axis, search)
    axis.set_xlabel(PARAMETERS[first])
    axis.set_ylabel(PARAMETERS[second])
    axis.grid(False)


def _draw_surface(axis: Axes, flat: list[np.ndarray], limits: tuple[float, float], one: Observable | None) -> None:
    side = int(np.sqrt(len(flat[0])))
    x, y, values = (array.reshape(side, side) for array in flat)
    coloured = np.log10(np.maximum(values, 1e-3)) if one is None else values
    axis.pcolormesh(x, y, coloured, cmap=SEQUENTIAL, shading="gouraud", rasterized=True, vmin=limits[0], vmax=limits[1])
    if one is None:
        return
    edges = [one.factor * one.low, one.factor * one.high]
    if values.max() > edges[0] and values.min() < edges[1]:
        axis.contourf(x, y, values, levels=edges, colors="none", hatches=["//"])
        if any(values.min() < edge < values.max() for edge in edges):
            axis.contour(x, y, values, levels=edges, colors="white", linestyles="--", linewidths=1.4)


def _plain_ticks(axis: Axes, search: Search) -> None:
    """The values of the grid as ticks."""
    grid = search.sets.get("round", np.zeros(len(search.usable))) == 0
    for name, one in zip(search.searched[:2], (axis.xaxis, axis.yaxis)):
        values = np.unique(search.sets[name][grid])
        one.set_ticks(values, [f"{value:g}" for value in values])
        one.set_ticks([], minor=True)


def _write_verdicts(axis: Axes, search: Search) -> None:
    """The fit beside the targets, as text."""
    axis.set_axis_off()
    if search.fit is None:
        axis.text(0, 0.9, "no fit was tested", transform=axis.transAxes)
        return
    line = len(search.searched) == 1
    tested = search.fit["usable"][0] > 0
    lines = [f"Fit ({'dashed' if line else 'star'}), with standard deviations over the packings:"]
    lines += [f"{_symbol(name)} = {search.fit[name][0]:.4g}" for name in PARAMETERS]
    if not tested:
        lines.append("The tests of the fit were not usable.")
    for one in search.observables if tested else ():
        value, scatter = search.fit[one.name][0], search.fit[f"{one.name}_deviation"][0]
        lines.append(
            f"{one.symbol} = {one.factor * value:.1f} ± {one.factor * scatter:.1f} {one.unit}, accepted "
            f"{one.factor * one.low:.3g} to {one.factor * one.high:.3g}: {'met' if one.met(value) else 'missed'}"
        )
    if tested:
        lines.append(f"misfit {search.fit['misfit'][0]:.3g}")
    lines.append(f"{'Green' if line else 'Hatched'} in the pictures: what is accepted.")
    axis.text(0, 0.97, "\n\n".join(lines), transform=axis.transAxes, va="top", fontsize=11)
