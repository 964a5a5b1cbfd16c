"""Fields over the deformed mesh at several volume losses: which of them localise, and whether in the same places."""

from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from . import q8, regions
from .fields import draw_interfaces, since_start
from .resolution import percent
from .result import Increment, Missing, Result
from .style import DIVERGING, STRAIN, save

# Field, factor, label, colour map, symmetric about the value at V_l = 0.
FIELDS = [
    ("gauss/deviatoric_strain", 100, r"deviatoric strain  $\varepsilon_q$  [%]", STRAIN, False),
    ("gauss/grain_rotation", 180 / np.pi, "mean grain rotation, counter-\nclockwise positive  [deg]", DIVERGING, True),
    ("gauss/void_ratio", 1, "void ratio  $e$  [-]", "viridis", False),
]


def limits(values: np.ndarray, symmetric: bool) -> tuple[float, float]:
    """Limits of the colours, without the most extreme 0.01 % of the values: one RVE must not dim the others."""
    finite = values[np.isfinite(values)]
    if finite.size == 0:
        raise Missing("a field has no finite value")
    low, high = np.quantile(finite, [0.0, 0.999])
    if symmetric:
        high = np.quantile(np.abs(finite), 0.999) or 1.0
        low = -high
    return (low, high) if high > low else (low, low + 1e-12)


def largest(values: np.ndarray) -> float:
    """The largest size of a field's finite values; NaN where it has none."""
    finite = values[np.isfinite(values)]
    return float(np.max(np.abs(finite))) if finite.size else np.nan


def draw(result: Result, path: Path, losses: Sequence[float] = ()) -> None:
    """`losses`: V_l of the columns [-], in place of those of the settings."""
    chosen = result.nearest(losses or result.settings.field_losses) or [result.loss_increments[-1]]
    fields = [entry for entry in FIELDS if entry[0] in chosen[0].names]
    if not fields:
        raise Missing("there is no field of the Gauss points")
    (diameter, surface_y) = result.need("diameter", "surface_y")
    titles = [f"$V_l$ = {percent(i['volume_loss'])}" for i in chosen]
    figure, axes = draw_rows(result, fields, chosen, titles, (4.0, 4.0))
    reach = min(result.coordinates[:, 0].max(), 4 * diameter)
    axes[0, 0].set_xlim(-reach if result.is_whole else 0, reach)
    axes[0, 0].set_ylim(result.crown_height - 1.6 * diameter, surface_y * 1.01)
    figure.suptitle("Localisation, on the deformed mesh", fontsize=12)
    save(figure, path)


def draw_rows(
    result: Result,
    fields: Sequence[tuple[str, float, str, str, bool]],
    chosen: Sequence[Increment],
    titles: Sequence[str],
    size: tuple[float, float],
) -> tuple[Figure, np.ndarray]:
    """A row for each field and a column for each increment; `size` of a panel [inches]. Returns figure and axes."""
    figure, axes = plt.subplots(
        len(fields),
        len(chosen),
        figsize=(size[0] * len(chosen) + 1.2, size[1] * len(fields)),
        squeeze=False,
        sharex=True,
        sharey=True,
        layout="constrained",
    )
    ground = regions.ground(result)  # a wall bears some hundred kPa beside ground that bears some ten
    for row, (name, factor, label, colour_map, symmetric) in zip(axes, fields):
        values = [factor * since_start(result, name, i) for i in chosen]
        range_of = limits(np.concatenate([v[ground].ravel() for v in values]), symmetric)
        for axis, increment, value, title in zip(row, chosen, values, titles):
            there = regions.alive(result, increment)
            moved = result.coordinates + increment.field("node/displacement")
            patches = q8.gauss_patches(moved, result.connectivity)[there].reshape(-1, 4, 2)
            drawn = PolyCollection(
                list(patches), array=value[there].ravel(), cmap=colour_map, edgecolors="face", linewidths=0.3
            )
            drawn.set_clim(*range_of)
            axis.add_collection(drawn)
            axis.set_aspect("equal")
            axis.grid(False)
            draw_interfaces(axis, result, moved, there)
            axis.set_title(f"{title},  largest {largest(value[ground]):.3g}", fontsize=10)
        figure.colorbar(
            drawn, ax=list(row), label=label, shrink=0.85, extend="max" if not symmetric else "both", pad=0.01
        )
        row[0].set_ylabel("$y$  [m]")
    for axis in axes[-1]:
        axis.set_xlabel("$x$  [m]")
    return figure, axes
