"""Stresses beside one another: ground reaction by soil (fig. 15b), changes of stress and axes of the major principal
stress (fig. 16), and their turn beside the turn of the fabric (fig. 18)."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure

from .. import points, q8, rotation, tensors
from ..reaction import curve
from ..resolution import percent
from ..result import Missing, Result
from ..style import CYCLE, DIVERGING
from .data import Study, Tunnel
from .drawing import about_bands, about_singles, colour_of_soil, draw_bands, finish, line_of_soil, over_the_loss
from .settlements import wanted_losses

STRESS_LOSSES = (0.02, 0.05, 0.20)  # V_l of the changes of stress [-]
REACH = 2.0  # how far the pictures of stress reach from the tunnel's axis, in D
LOWEST = -60  # [deg]: axes above the crown are level, and must not jump between 90° and -90°
SPACING = 0.3  # of the axes of principal stress, in D


def draw_reaction(study: Study, path: Path) -> None:
    """Figure 15b: the ground reaction curves of several soils."""
    tunnels = study.soils()
    figure, axis = plt.subplots(figsize=(7.6, 5.2))
    for tunnel in tunnels:
        bands = tunnel.over_loss(lambda member: curve(member)[1])
        draw_bands(axis, 100 * tunnel.loss, bands, colour_of_soil(tunnel), tunnel.label, line=line_of_soil(tunnel))
    over_the_loss(axis, r"vertical stress above the crown  $\sigma_v / \sigma_{v,0}$  [-]", zero=True)
    axis.set_title("Ground reaction curves by soil")
    axis.legend()
    finish(figure, path, about_bands(tunnels))


def mean_stress(tunnel: Tunnel, loss: float) -> np.ndarray:
    """The stress tensor at the Gauss points, mean over the members (element, 4, 3) [Pa], tension positive. A tensor's
    components are averaged, so that its axes are those of the mean."""
    found = [member.next_to(loss).field("gauss/stress") for member in tunnel.members]
    if any(len(one) != len(found[0]) for one in found):
        raise Missing(f"the members of {tunnel.name} have different meshes")
    return np.mean(found, axis=0)


def draw_changes(study: Study, path: Path) -> None:
    """Figure 16: stresses over those before the loss, and the axes of the major principal stress."""
    tunnel = study.main()
    losses = [0.0, *wanted_losses(tunnel, STRESS_LOSSES)]
    result = tunnel.representative
    before = mean_stress(tunnel, 0.0)
    figure, axes = plt.subplots(
        3,
        len(losses),
        figsize=(3.5 * len(losses) + 0.8, 12.4),
        squeeze=False,
        sharex=True,
        sharey=True,
        layout="constrained",
    )
    norm = TwoSlopeNorm(1.0, 0.0, 2.0)
    for column, loss in zip(axes.T, losses):
        stress = mean_stress(tunnel, loss)
        for axis, component in zip(column[:2], (0, 1)):
            drawn = _add_ratio(axis, result, _over(stress[..., component], before[..., component]), norm)
        _add_axes(column[2], result, stress)
        column[0].set_title(f"$V_l$ = {percent(loss)}", fontsize=11)
    _label_changes(figure, axes, drawn)
    figure.suptitle(f"Stresses around the tunnel, {tunnel.label}", fontsize=12)
    shown = f"Stress tensors are means of {tunnel.count} members." if tunnel.count > 1 else ""
    finish(
        figure,
        path,
        shown,
        "Drawn on the ground as it was before the loss. The length of an axis grows with the major principal stress "
        "less the minor one over their sum; orange: more than 45° from the vertical.",
        about_singles([tunnel]),
    )


def _over(stress: np.ndarray, before: np.ndarray) -> np.ndarray:
    """A stress over the one before the loss; 1 at points that were not compressed then."""
    return np.divide(stress, before, out=np.ones(before.shape), where=before < 0)


def _label_changes(figure: Figure, axes: np.ndarray, drawn: plt.cm.ScalarMappable) -> None:
    figure.colorbar(
        drawn,
        ax=axes,
        label="stress over its value at $V_l$ = 0  [-]",
        extend="max",
        shrink=0.5,
        aspect=30,
        ticks=[0, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2],
    )
    names = (r"horizontal  $\sigma_{xx}$", r"vertical  $\sigma_{yy}$", "axes of major stress")
    for row, name in zip(axes, names):
        row[0].set_ylabel(f"{name}\nheight above the axis  $y/D$  [-]")
    for axis in axes[-1]:
        axis.set_xlabel("$x/D$  [-]")


def _scaled(result: Result, places: np.ndarray) -> np.ndarray:
    """Places from the tunnel's axis, over D."""
    axis_depth, diameter, surface_y = result.need("axis_depth", "diameter", "surface_y")
    return (places - np.array([0.0, surface_y - axis_depth])) / diameter


def _frame(axis: Axes, result: Result) -> None:
    axis_depth, diameter = result.need("axis_depth", "diameter")
    axis.set_xlim(0, REACH)
    axis.set_ylim(-0.9, min(REACH + 0.5, axis_depth / diameter))
    axis.set_aspect("equal")
    axis.grid(False)


def _add_ratio(axis: Axes, result: Result, ratio: np.ndarray, norm: TwoSlopeNorm) -> plt.cm.ScalarMappable:
    patches = _scaled(result, q8.gauss_patches(result.coordinates, result.connectivity).reshape(-1, 4, 2))
    drawn = PolyCollection(
        list(patches), array=ratio.ravel(), cmap=DIVERGING, norm=norm, edgecolors="face", linewidths=0.3
    )
    axis.add_collection(drawn)
    _frame(axis, result)
    return drawn


def _add_axes(axis: Axes, result: Result, stress: np.ndarray) -> None:
    """A line along the major principal stress at one Gauss point of each square of a grid."""
    stress = stress.reshape(-1, 3)
    places = _scaled(result, points.original_points(result))
    cells = np.floor(places / SPACING).astype(int)
    centres = (cells + 0.5) * SPACING
    order = np.argsort(np.linalg.norm(places - centres, axis=1))
    _, first = np.unique(cells[order], axis=0, return_index=True)
    chosen = order[first]
    angle = tensors.major_from_vertical(stress[chosen])
    xx, yy, xy = stress[chosen].T
    sum_, difference = -(xx + yy), np.hypot(xx - yy, 2 * xy)
    size = np.divide(difference, sum_, out=np.zeros_like(sum_), where=sum_ > 0)
    half = (0.5 * SPACING * np.clip(0.3 + size, 0, 1))[:, None] * np.column_stack([-np.sin(angle), np.cos(angle)])
    flat = np.abs(angle) > np.pi / 4
    lines = np.stack([places[chosen] - half, places[chosen] + half], axis=1)
    axis.add_collection(
        LineCollection(list(lines), colors=np.where(flat, CYCLE[3], "0.25"), linewidths=np.where(flat, 1.9, 1.1))
    )
    _frame(axis, result)


def draw_rotation(study: Study, path: Path) -> None:
    """Figure 18: the major principal stress beside the direction of the fabric along a line above the crown."""
    tunnel = study.main()
    losses = wanted_losses(tunnel, study.settings.field_losses)
    columns = min(2, len(losses))
    rows = -(-len(losses) // columns)
    figure, axes = plt.subplots(
        rows,
        columns,
        figsize=(6.4 * columns, 3.9 * rows + 0.4),
        squeeze=False,
        sharex=True,
        sharey=True,
        layout="constrained",
    )
    for axis in axes.flat[len(losses) :]:
        axis.set_axis_off()
    for axis, loss in zip(axes.flat, losses):
        x, stress, fabric = directions(tunnel, loss)
        _add_directions(axis, x, stress, CYCLE[0], "-", "major principal stress")
        _add_directions(axis, x, fabric, CYCLE[3], "s", r"fabric direction  $\theta_a$, eq. (22)")
        away = mean_difference(stress, fabric)
        axis.set_title(f"$V_l$ = {percent(loss)};  mean difference {np.mean(away):.0f}°", fontsize=11)
        axis.set_ylim(LOWEST, LOWEST + 180)
        axis.set_yticks(range(LOWEST, LOWEST + 181, 30))
        axis.set_xlim(0, 3)
    for axis in axes[:, 0]:
        axis.set_ylabel("angle from the vertical  [deg]")
    for axis in axes[-1]:
        axis.set_xlabel("distance from the tunnel axis  $x/D$  [-]")
    axes[0, 0].legend(loc="lower right")
    line = study.settings.line
    figure.suptitle(
        f"Along the line {line:g} $D$ above the crown, {tunnel.label}; counter-clockwise positive", fontsize=12
    )
    many = f"Thick: mean axis of {tunnel.count} members; thin: the members." if tunnel.count > 1 else ""
    finish(figure, path, many, about_singles([tunnel]))


def directions(tunnel: Tunnel, loss: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x/D, and the angles of the major principal stress and of the fabric (member, point) [rad]."""
    stress, fabric = [], []
    (diameter,) = tunnel.members[0].need("diameter")
    for member in tunnel.members:
        increment = member.next_to(loss)
        x, angle = rotation.stress_angles(member, increment)
        stress.append(angle)
        fabric.append(rotation.fabric_angles(member, increment))
    return x / diameter, np.array(stress), np.array(fabric)


def mean_axis(angles: np.ndarray) -> np.ndarray:
    """The mean over the members of directions without an arrow [rad]: doubled angles are averaged as vectors."""
    return tensors.axis_angle(0.5 * np.angle(np.mean(np.exp(2j * angles), axis=0)))


def mean_difference(stress: np.ndarray, fabric: np.ndarray) -> np.ndarray:
    """The mean angle between both along the line, of each member [deg]."""
    return np.degrees(np.abs(tensors.axis_angle(stress - fabric))).mean(axis=1)


def _add_directions(axis: Axes, x: np.ndarray, angles: np.ndarray, colour: str, symbol: str, label: str) -> None:
    """The mean thick, the members thin; a line is cut where the axis passes through the ends of the scale."""
    if len(angles) > 1:
        for member in angles:
            axis.plot(*_cut(x, _degrees(member)), color=colour, linewidth=0.4, alpha=0.8)
    mean = _degrees(mean_axis(angles))
    if symbol == "-":
        axis.plot(*_cut(x, mean), "-", color=colour, linewidth=2.0, label=label)
    else:
        axis.plot(x, mean, symbol, color=colour, markersize=4.5, label=label)


def _degrees(angle: np.ndarray) -> np.ndarray:
    """Axes [deg] from LOWEST on."""
    return np.mod(np.degrees(angle) - LOWEST, 180) + LOWEST


def _cut(x: np.ndarray, degrees: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    cuts = np.flatnonzero(np.abs(np.diff(degrees)) > 90) + 1
    return np.insert(x, cuts, np.nan), np.insert(degrees, cuts, np.nan)
