"""Settlement troughs at the surface and below it, with their modified Gauss curves."""

import csv

import matplotlib.pyplot as plt
import numpy as np

from . import q8, trough_fit
from .result import Missing
from .style import percent, save

DEPTHS = (0.0, 0.25, 0.5, 0.75, 1.0)  # z/C
COLUMNS = ("z_over_C", "depth_m", "volume_loss", "settlement_max_m", "inflection_m", "alpha", "n", "K", "rms_misfit",
           "trough_area_over_lost_area")


def surface_profile(result, increment):
    """Distance from the axis and settlement [m] at the nodes of the surface."""
    if "top" not in result.boundaries:
        raise Missing("run.h5 has no boundary top")
    top = result.boundaries["top"]
    top = top[np.argsort(result.coordinates[top, 0])]
    return result.coordinates[top, 0], -increment.field("node/displacement")[top, 1]


def profile(result, increment, depth):
    """The same along a horizontal line at a depth [m], interpolated in the finite elements."""
    if depth == 0:
        return surface_profile(result, increment)
    (surface_y,) = result.need("surface_y")
    x = np.linspace(0, result.coordinates[:, 0].max(), 61)
    line = np.column_stack([x, np.full_like(x, surface_y - depth)])
    u = q8.sample(result.coordinates, result.connectivity, increment.field("node/displacement"), line)
    inside = np.isfinite(u[:, 1])
    return x[inside], -u[inside, 1]


def mirrored(x, y):
    return np.concatenate([-x[::-1], x]), np.concatenate([y[::-1], y])


def draw(result, path):
    axis_depth, diameter = result.need("axis_depth", "diameter")
    losses = result.losses
    figure, axes = plt.subplots(1, 2, figsize=(12.5, 4.8))
    rows = []
    colours = plt.get_cmap("viridis")(np.linspace(0.0, 0.85, max(len(losses), 2)))
    for increment, colour in zip(losses, colours):
        rows.append(_add(axes[0], result, increment, 0.0, colour, percent(increment["volume_loss"])))
    last = losses[-1]
    colours = plt.get_cmap("cividis")(np.linspace(0.0, 0.9, len(DEPTHS)))
    for ratio, colour in zip(DEPTHS, colours):
        row = _add(axes[1], result, last, ratio, colour, f"{ratio:g}")
        if ratio > 0:  # the surface at this volume loss is a row already
            rows.append(row)
    axes[0].set_title("Settlement of the surface")
    axes[1].set_title(f"Settlement at depth, $V_l$ = {percent(last['volume_loss'])}")
    for axis, title in zip(axes, ("$V_l$", "$z/C$")):
        axis.invert_yaxis()
        axis.set_xlabel("distance from the tunnel axis  $x$  [m]")
        axis.set_ylabel("settlement  $S$  [m]")
        axis.legend(title=title, loc="lower right")
    figure.suptitle(f"Settlement troughs, $C/D$ = {result.cover / diameter:.2g}, $D$ = {diameter:g} m"
                    "   (symbols: computed, lines: modified Gauss curve)", fontsize=12)
    figure.tight_layout()
    save(figure, path)
    _write_table(path.with_suffix(".csv"), rows, axis_depth, diameter)


def _add(axis, result, increment, ratio, colour, label):
    x, settlement = profile(result, increment, ratio * result.cover)
    if len(x) < 4:
        raise Missing(f"the mesh has too few points at z/C = {ratio:g}")
    fit = trough_fit.fit(x, settlement)
    fine = np.linspace(-x.max(), x.max(), 400)
    axis.plot(fine, fit(fine), color=colour, label=label)
    axis.plot(*mirrored(x, settlement), "o", color=colour, markersize=3.5, markerfacecolor="none", markeredgewidth=0.8)
    area = 2 * np.trapezoid(settlement, x)
    return ratio, ratio * result.cover, increment["volume_loss"], fit, area


def _write_table(path, rows, axis_depth, diameter):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        for ratio, depth, loss, fit, area in rows:
            numbers = (ratio, depth, loss, fit.largest, fit.inflection, fit.alpha, fit.n,
                       fit.inflection / (axis_depth - depth), fit.misfit, area / (loss * np.pi * diameter**2 / 4))
            writer.writerow([f"{value:.6g}" for value in numbers])
