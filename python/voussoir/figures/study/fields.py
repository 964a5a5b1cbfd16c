"""Fields beside one another, tunnels by volume losses: displacement (fig. 8) and shear strain (figs. 9, 14)."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation

from .. import q8, settlements
from ..resolution import percent
from ..result import Increment, Missing, Result
from ..style import SEQUENTIAL, STRAIN
from .data import Study, Tunnel
from .drawing import about_members, finish

WIDE, BELOW = 2.6, 1.5  # how far the pictures reach beside the axis, and below the crown, in D


@dataclass
class Cell:
    """One picture of a grid."""

    tunnel: Tunnel
    result: Result  # the member that is shown
    increment: Increment

    @property
    def deformed(self) -> np.ndarray:
        """Coordinates of the nodes [m]; the surface is at 0, downwards negative."""
        (surface_y,) = self.result.need("surface_y")
        moved = self.result.coordinates + self.increment.field("node/displacement")
        return moved - np.array([0.0, surface_y])


def grid(tunnels: Sequence[Tunnel], losses: Sequence[float]) -> list[list[Cell]]:
    """The pictures, a row a tunnel, at the wanted V_l that all tunnels reached."""
    last = min(tunnel.loss[-1] for tunnel in tunnels)
    wanted = [loss for loss in losses if loss <= last + 1e-9] or [last]
    rows = []
    for tunnel in tunnels:
        result = tunnel.representative
        found = [result.next_to(loss) for loss in wanted]
        rows.append([Cell(tunnel, result, increment) for increment in found])
    return rows


def _canvas(rows: list[list[Cell]]) -> tuple[Figure, np.ndarray]:
    depths = []
    for row in rows:
        (diameter,) = row[0].result.need("diameter")
        depths.append(row[0].result.cover + BELOW * diameter)
    (diameter,) = rows[0][0].result.need("diameter")
    wide = WIDE * diameter
    inches = 2.5  # of a picture's width
    figure, axes = plt.subplots(
        len(rows),
        len(rows[0]),
        squeeze=False,
        sharex=True,
        height_ratios=depths,
        layout="constrained",
        figsize=(inches * len(rows[0]) + 0.9, inches / wide * sum(depths) + 0.35 * len(rows) + 1.5),
    )
    for row, of_row, depth in zip(axes, rows, depths):
        for axis in row:
            axis.set_xlim(0, wide)
            axis.set_ylim(-depth, 0.06 * wide)
            axis.set_aspect("equal")
            axis.grid(False)
            axis.tick_params(labelleft=axis is row[0])
        row[0].set_ylabel(f"{of_row[0].tunnel.label}\nheight above surface  [m]", fontsize=10)
    for axis in axes[-1]:
        axis.set_xlabel("$x$  [m]")
    return figure, axes


def crown_displacement(cell: Cell) -> float:
    """The settlement of the crown [m]."""
    row = cell.result.loss_increments.index(cell.increment)
    return float(settlements.on_axis(cell.result, 1.0)[row])


def draw_displacement(study: Study, path: Path) -> None:
    """Figure 8: the displacement of the ground in dense sand, by cover and V_l; full colour is the crown's."""
    tunnels = study.covers()
    rows = grid(tunnels, study.settings.field_losses)
    figure, axes = _canvas(rows)
    levels = np.linspace(0, 1, 21)
    for row, of_row in zip(axes, rows):
        for axis, cell in zip(row, of_row):
            crown = crown_displacement(cell)
            share = np.linalg.norm(cell.increment.field("node/displacement"), axis=1) / crown
            triangles = Triangulation(cell.deformed[:, 0], cell.deformed[:, 1], q8.triangles(cell.result.connectivity))
            filled = axis.tricontourf(triangles, np.clip(share, 0, 1), levels=levels, cmap=SEQUENTIAL)
            axis.tricontour(triangles, share, levels=[0.5], colors="white", linewidths=0.9)
            axis.set_title(f"$V_l$ = {percent(cell.increment['volume_loss'])}, crown {1e3 * crown:.0f} mm", fontsize=9)
    bar = figure.colorbar(
        filled,
        ax=axes,
        label="displacement over the crown's  $|u| / u_{crown}$  [-]",
        location="bottom",
        shrink=0.6,
        aspect=40,
        pad=0.01,
    )
    bar.set_ticks([0, 0.2, 0.4, 0.6, 0.8, 1])
    figure.suptitle("Displacement of the ground by cover; white line: half of the crown's", fontsize=12)
    finish(figure, path, about_members(tunnels))


def draw_shear_by_cover(study: Study, path: Path) -> None:
    """Figure 9: the deviatoric strain in dense sand, by cover and V_l."""
    _draw_shear(study, study.covers(), path, "Deviatoric strain by cover")


def draw_shear_by_soil(study: Study, path: Path) -> None:
    """Figure 14: the same by soil at one cover."""
    _draw_shear(study, study.soils(), path, "Deviatoric strain by soil")


def _draw_shear(study: Study, tunnels: Sequence[Tunnel], path: Path, title: str) -> None:
    rows = grid(tunnels, study.settings.field_losses)
    figure, axes = _canvas(rows)
    for k, column in enumerate(axes.T):
        values = [100 * row[k].increment.field("gauss/deviatoric_strain") for row in rows]
        limit = _limit(values)
        for axis, row, value in zip(column, rows, values):
            draw_points(axis, row[k], value, STRAIN, (0, limit))
            axis.set_title(f"$V_l$ = {percent(row[k].increment['volume_loss'])}", fontsize=10)
        bar = ScalarMappable(Normalize(0, limit), STRAIN)
        figure.colorbar(
            bar, ax=list(column), location="bottom", label=r"$\varepsilon_q$  [%]", extend="max", shrink=0.85, pad=0.01
        )
    figure.suptitle(f"{title}; each volume loss has its own scale", fontsize=12)
    finish(figure, path, about_members(tunnels))


def _limit(values: Sequence[np.ndarray]) -> float:
    """The strain of full colour [%]: the 99.5 % quantile of all tunnels. RVEs at the wall of the opening, which lose
    their contacts, must not dim the bands."""
    finite = np.concatenate([value[np.isfinite(value)] for value in values])
    if finite.size == 0:
        raise Missing("the deviatoric strain has no finite value")
    return float(np.quantile(finite, 0.995)) or 1.0


def draw_points(axis: Axes, cell: Cell, values: np.ndarray, colour_map: str, limits: tuple[float, float]) -> None:
    """A field of the Gauss points, one colour a point."""
    patches = q8.gauss_patches(cell.deformed, cell.result.connectivity).reshape(-1, 4, 2)
    drawn = PolyCollection(
        list(patches), array=values.ravel(), cmap=colour_map, edgecolors="face", linewidths=0.3, clim=limits
    )
    axis.add_collection(drawn)
