"""The paths of the RVEs above the crown: stress ratio, strains and settlement (fig. 21), by soil (fig. 22), and their
contact networks (fig. 23)."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import paths, points, troughs
from ..result import Missing, Result
from ..style import CYCLE, LINES
from .data import Study, Tunnel
from .drawing import about_bands, colour_of_soil, draw_bands, finish, line_of_soil, over_the_loss

STRAINS = {  # label: colour, line
    r"$\varepsilon_v$": (CYCLE[6], LINES[0]),
    r"$\varepsilon_x$": (CYCLE[0], LINES[1]),
    r"$\varepsilon_y$": (CYCLE[3], LINES[2]),
}
STRONG = {1.0: "strong_coordination_1", 2.0: "strong_coordination_2", 2.5: "strong_coordination_2_5"}  # xi: field
CONTRACTION = "strain, contraction positive  [%]"


def followed(result: Result) -> list[points.Point]:
    """Aa, Ab and Ac, as far as they exist."""
    found = points.above_crown(result)
    if not found:
        raise Missing("no point lies above the crown")
    return found


def point(result: Result, name: str) -> points.Point:
    for found in followed(result):
        if found.name == name:
            return found
    raise Missing(f"the point {name} does not exist")


def at_point(name: str, field: str, result: Result) -> np.ndarray:
    """A field of the Gauss points at a followed point over the volume loss."""
    return points.history(result, f"gauss/{field}", point(result, name))


def strong_at(name: str, field: str, result: Result) -> np.ndarray:
    """Z_m of a strong network at a followed point; NaN where no grain has two of its contacts (files have 0)."""
    found = at_point(name, field, result)
    return np.where(found > 0, found, np.nan)


def ratio_at(name: str, result: Result) -> np.ndarray:
    """q/p [-]."""
    return paths.stress_ratio(result, point(result, name))


def strain_at(name: str, component: int, result: Result) -> np.ndarray:
    """The strain along x (0) or y (1) [-], contraction positive."""
    return -at_point(name, "strain", result)[:, component]


def settlement_at(name: str, result: Result) -> np.ndarray:
    """The settlement of the axis at the depth of a followed point [m]."""
    height = point(result, name).position[1] - result.crown_height
    line = troughs.line_at(result, round(1 - height / result.cover, 4))
    return np.array([line.settlement(i)[0] for i in result.loss_increments])


def draw_main(study: Study, path: Path) -> None:
    """Figure 21: q/p, strains and settlement at Aa, Ab, Ac against V_l."""
    tunnel = study.main()
    names = [p.name for p in followed(tunnel.representative)]
    figure, axes = _grid(3, names)
    for column, name in zip(axes.T, names):
        colour, loss = paths.COLOURS[name], 100 * tunnel.loss
        draw_bands(column[0], loss, tunnel.over_loss(partial(ratio_at, name)), colour)
        curves: list[Callable[[Result], np.ndarray]] = [
            partial(at_point, name, "volumetric_strain"),
            partial(strain_at, name, 0),
            partial(strain_at, name, 1),
        ]
        for (label, (shade, line)), curve in zip(STRAINS.items(), curves):
            draw_bands(column[1], loss, tunnel.over_loss(curve), shade, label, 100, line)
        draw_bands(column[2], loss, tunnel.over_loss(partial(settlement_at, name)), colour, scale=1e3)
        column[0].set_title(_where(tunnel, name))
    _label(axes[0], "stress ratio  $q/p$  [-]", (0, 1.05))
    _label(axes[1], CONTRACTION)
    _label(axes[2], "settlement at $x$ = 0  [mm]")
    for axis in axes[1]:
        axis.axhline(0, color="0.4", linewidth=0.8)
    axes[1, 0].legend()
    figure.suptitle(f"RVEs above the crown and the settlement at their depth, {tunnel.label}", fontsize=12)
    finish(figure, path, about_bands([tunnel]), _about_ratio())


def draw_soils(study: Study, path: Path) -> None:
    """Figure 22: q/p and volumetric strain at Aa, Ab, Ac by soil."""
    tunnels = study.soils()
    names = [p.name for p in followed(tunnels[0].representative)]
    figure, axes = _grid(2, names)
    for column, name in zip(axes.T, names):
        for tunnel in tunnels:
            colour, line, loss = colour_of_soil(tunnel), line_of_soil(tunnel), 100 * tunnel.loss
            ratio = tunnel.over_loss(partial(ratio_at, name))
            draw_bands(column[0], loss, ratio, colour, tunnel.label, line=line)
            volume = tunnel.over_loss(partial(at_point, name, "volumetric_strain"))
            draw_bands(column[1], loss, volume, colour, tunnel.label, 100, line)
        column[0].set_title(_where(tunnels[0], name))
    _label(axes[0], "stress ratio  $q/p$  [-]", (0, 1.05))
    _label(axes[1], r"$\varepsilon_v$, contraction positive  [%]")
    for axis in axes[1]:
        axis.axhline(0, color="0.4", linewidth=0.8)
    axes[0, 0].legend(loc="lower right")
    figure.suptitle("RVEs above the crown by soil", fontsize=12)
    finish(figure, path, about_bands(tunnels), _about_ratio())


def draw_networks(study: Study, path: Path) -> None:
    """Figure 23: (a) Z_m of eq. (23) at Aa by soil; (b) the same of the strong networks."""
    tunnels = study.soils()
    figure, (left, right) = plt.subplots(1, 2, figsize=(13.0, 5.2), layout="constrained")
    for tunnel in tunnels:
        bands = tunnel.over_loss(partial(at_point, "Aa", "mechanical_coordination"))
        draw_bands(left, 100 * tunnel.loss, bands, colour_of_soil(tunnel), tunnel.label, line=line_of_soil(tunnel))
    over_the_loss(left, "mechanical coordination  $Z_m$  [-]")
    left.set_title("(a) whole network at Aa")
    left.legend()
    for tunnel in (t for t in tunnels if t.nearest_soil != "medium dense sand"):
        for (threshold, field), line in zip(STRONG.items(), LINES):
            bands = tunnel.over_loss(partial(strong_at, "Aa", field))
            label = rf"{tunnel.code}, $\xi$ = {threshold:g}"
            draw_bands(right, 100 * tunnel.loss, bands, colour_of_soil(tunnel), label, line=line)
    over_the_loss(right, "mechanical coordination of the strong network  [-]")
    right.set_title(r"(b) contacts with $f_n \geq \xi \langle f_n \rangle$ at Aa")
    right.legend(ncol=2)
    finish(
        figure, path, about_bands(tunnels), "(b) has gaps where in a member no grain has two contacts of the network."
    )


def _grid(rows: int, names: list[str]) -> tuple[Figure, np.ndarray]:
    return plt.subplots(
        rows,
        len(names),
        figsize=(4.9 * len(names) + 0.4, 3.5 * rows + 0.6),
        squeeze=False,
        sharex=True,
        sharey="row",
        layout="constrained",
    )


def _label(row: np.ndarray, label: str, limits: tuple[float, float] | None = None) -> None:
    axis: Axes
    for axis in row:
        over_the_loss(axis, "")
        axis.set_xlabel("")
        if limits:
            axis.set_ylim(*limits)
    row[0].set_ylabel(label)
    for axis in row[0].figure.axes[-len(row) :]:
        axis.set_xlabel("volume loss  $V_l$  [%]")


def _where(tunnel: Tunnel, name: str) -> str:
    result = tunnel.representative
    (diameter,) = result.need("diameter")
    height = (point(result, name).position[1] - result.crown_height) / diameter
    return f"{name}, {height:.2f} $D$ above the crown"


def _about_ratio() -> str:
    return f"q/p is left out where a member has p below {paths.LEAST_PRESSURE / 1e3:g} kPa there."
