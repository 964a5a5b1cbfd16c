"""The whole ground in one picture: settlement left of the tunnel's axis, shear strain right of it, the trough above."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from matplotlib.tri import Triangulation

from . import q8, troughs
from .fields import last_increment
from .panels import limits
from .resolution import percent
from .result import Increment, Missing, Result
from .style import STRAIN, colours, save

SHOWN = 0.035  # the largest displacement that is drawn, over the width of the picture [-]


def draw(result: Result, path: Path) -> None:
    diameter, surface = result.need("diameter", "surface_y")
    increment = last_increment(result)
    if increment["volume_loss"] <= 0:
        raise Missing("no increment has a volume loss")
    strain = 100 * increment.field("gauss/deviatoric_strain")
    half_width = min(result.coordinates[:, 0].max(), 4 * diameter)
    displacement = increment.field("node/displacement")
    factor = magnification(displacement, 2 * half_width)
    deformed = result.coordinates + factor * displacement

    figure, (above, below) = plt.subplots(
        2, 1, figsize=(8.2, 5.2), sharex=True, height_ratios=(1, 2.2), layout="constrained"
    )
    _add_trough(above, result)
    _add_settlement(figure, below, result, deformed, -1e3 * displacement[:, 1])
    _add_strain(figure, below, result, deformed, strain)
    _add_lines(below, result, deformed, diameter)
    below.set_xlim(-half_width, half_width)
    below.set_ylim(result.crown_height - 1.7 * diameter, surface + 0.02 * diameter)
    below.set_xlabel("distance from the tunnel axis  $x$  [m]")
    figure.suptitle(title(result, increment, factor), fontsize=11)
    save(figure, path, few_colours=True)  # it opens README.md


def title(result: Result, increment: Increment, factor: float) -> str:
    (diameter,) = result.need("diameter")
    scale = "" if factor == 1 else f"; deformation × {factor:g}"
    return (
        f"Ground above a tunnel in {result.soil}: $D$ = {diameter:g} m, $C/D$ = {result.cover / diameter:.2g}, volume "
        f"loss {percent(increment['volume_loss'])}\n"
        f"(the right half was computed, the left half is its mirror image{scale})"
    )


def magnification(displacement: np.ndarray, width: float) -> float:
    """A round factor with which the largest displacement is about SHOWN of the width; 1 where it is more already."""
    largest = np.max(np.linalg.norm(displacement, axis=1))
    if not np.isfinite(largest):
        raise Missing("the displacement is not finite")
    return float(max([m for m in (1, 2, 5, 10, 20, 50, 100, 200, 500) if m * largest <= SHOWN * width], default=1))


def _add_trough(axis: Axes, result: Result) -> None:
    losses = result.losses
    for increment, colour in zip(losses, colours("viridis_r", len(losses) + 1)[1:]):
        line = troughs.line_at(result, 0.0)
        axis.plot(
            *troughs.mirrored(line.x, 1e3 * line.settlement(increment)),
            color=colour,
            label=percent(increment["volume_loss"]),
        )
    axis.invert_yaxis()
    axis.set_ylabel("settlement of\nthe surface [mm]")
    axis.legend(title="volume loss", loc="lower right", ncols=2, fontsize=8.5, title_fontsize=8.5)


def _add_settlement(figure: Figure, axis: Axes, result: Result, deformed: np.ndarray, settlement: np.ndarray) -> None:
    triangles = Triangulation(-deformed[:, 0], deformed[:, 1], q8.triangles(result.connectivity))
    levels = MaxNLocator(16, steps=[1, 2, 2.5, 5, 10]).tick_values(settlement.min(), settlement.max())
    filled = axis.tricontourf(triangles, settlement, levels=levels, cmap="YlGnBu", zorder=1)
    figure.colorbar(filled, ax=axis, location="left", label="settlement  [mm]", pad=0.02, aspect=16, ticks=levels[::4])


def _add_strain(figure: Figure, axis: Axes, result: Result, deformed: np.ndarray, strain: np.ndarray) -> None:
    patches = q8.gauss_patches(deformed, result.connectivity).reshape(-1, 4, 2)
    drawn = PolyCollection(
        list(patches), array=strain.ravel(), cmap=STRAIN, edgecolors="face", linewidths=0.3, zorder=1
    )
    drawn.set_clim(*limits(strain, False))
    axis.add_collection(drawn)
    figure.colorbar(drawn, ax=axis, label=r"deviatoric strain  $\varepsilon_q$  [%]", pad=0.02, aspect=16, extend="max")


def _add_lines(axis: Axes, result: Result, deformed: np.ndarray, diameter: float) -> None:
    """Edges of the elements on both sides, and the opening as it was."""
    for side in (-1, 1):
        outlines = q8.outlines(deformed * (side, 1), result.connectivity)
        axis.add_collection(LineCollection(list(outlines), colors="0.6", linewidths=0.3, zorder=2))
    angle = np.linspace(0, 2 * np.pi, 181)
    centre = result.crown_height - diameter / 2
    axis.plot(
        diameter / 2 * np.cos(angle), centre + diameter / 2 * np.sin(angle), "--", color="0.2", linewidth=0.9, zorder=3
    )
    axis.set_aspect("equal")
    axis.grid(False)
    axis.set_ylabel("height above the base  $y$  [m]")
