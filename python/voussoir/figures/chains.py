"""Force chains of RVEs that were written grain by grain (output.rves): normal forces as bars between grains."""

import re
from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection

from . import points
from .packings import Packing, Packings, branches
from .resolution import percent
from .result import Increment, Missing, Result, Snapshot
from .style import STRONG_FORCE, STRONGEST_FORCE, WEAK_FORCE, save

STRONG = 1.0  # a contact with at least this multiple of the mean normal force is strong (C1 of the study's pictures)
STRONGEST = 2.0  # the same for the strongest contacts (C2)
COLOURS_OF_FORCES = "orange from the RVE's mean on, dark from twice the mean on"
MOST_PACKINGS = 6  # that are all drawn


def normal_forces(snapshot: Snapshot) -> np.ndarray:
    """Compression at each contact [N]: `force` acts on grain i, the branch points from i to j."""
    branch = snapshot["branch"]
    unit = branch / np.linalg.norm(branch, axis=1, keepdims=True)
    return -np.einsum("ck,ck->c", snapshot["force"], unit)


def rows(result: Result, increment: Increment) -> list[tuple[str, str]]:
    """(label, snapshot) of the RVEs that were written. An RVE within D/4 of a followed point has the name of this
    point; such RVEs come first."""
    numbers = {name: int(found[1]) for name in increment.snapshots if (found := re.search(r"(\d+)$", name))}
    if not numbers:
        raise Missing("no RVE was written grain by grain (output.rves)")
    (diameter,) = result.need("diameter")
    where = points.original_points(result)
    near, rest = [], dict(numbers)
    for point in points.all_points(result):
        away = {name: np.linalg.norm(where[number] - point.position) for name, number in numbers.items()}
        name = min(away, key=away.__getitem__)
        if away[name] < 0.25 * diameter:
            near.append((point.name + (f"\n(RVE {away[name]:.2f} m away)" if away[name] > 1e-9 else ""), name))
            rest.pop(name, None)
    return near + [
        (f"x = {where[number][0]:.1f} m, {(where[number][1] - result.crown_height) / diameter:+.2f} D", name)
        for name, number in rest.items()
    ]


def draw(result: Result, path: Path, losses: Sequence[float] = (), followed: Sequence[str] = ()) -> None:
    """`losses`: V_l of the columns [-], in place of those of the settings; `followed`: only RVEs at these points."""
    chosen = [
        result.loss_increments[0],
        *(result.nearest(losses or result.settings.field_losses) or [result.loss_increments[-1]]),
    ]
    found = [row for row in rows(result, chosen[-1]) if not followed or row[0].split("\n")[0] in followed]
    if not found:
        raise Missing(f"no RVE near {', '.join(followed)} was written grain by grain (output.rves)")
    figure, axes = plt.subplots(
        len(found),
        len(chosen),
        figsize=(3.6 * len(chosen), 3.9 * len(found)),
        squeeze=False,
        layout="constrained",
    )
    for row, (label, name) in zip(axes, found):
        for axis, increment in zip(row, chosen):
            draw_rve(axis, increment.snapshot(name))
            axis.set_title(f"$V_l$ = {percent(increment['volume_loss'])}", fontsize=10)
        row[0].set_ylabel(label, fontsize=11)
    figure.suptitle(
        f"Force chains: width of a bar by normal force;\n{COLOURS_OF_FORCES}",
        fontsize=12,
    )
    save(figure, path)


def draw_packings(packings: Packings, path: Path) -> None:
    """Each packing with the normal forces of its overlaps; of many packings the first of each recipe."""
    chosen = packings.all
    if len(chosen) > MOST_PACKINGS:
        chosen = [group[0] for group in packings.groups()][:MOST_PACKINGS]
    columns = min(3, len(chosen))
    rows_needed = -(-len(chosen) // columns)
    figure, axes = plt.subplots(
        rows_needed, columns, figsize=(4.6 * columns, 4.9 * rows_needed), squeeze=False, layout="constrained"
    )
    for axis in axes.flat[len(chosen) :]:
        axis.set_axis_off()
    for axis, packing in zip(axes.flat, chosen):
        draw_rve(axis, packing.snapshot())
        axis.set_title(_title(packing), fontsize=10)
    shown = "" if len(chosen) == len(packings.all) else f"{len(chosen)} of {len(packings.all)} packings, one a recipe. "
    figure.suptitle(f"{shown}Width of a bar by normal force;\n{COLOURS_OF_FORCES}", fontsize=11)
    save(figure, path)


def _title(packing: Packing) -> str:
    width = float(np.linalg.norm(packing.cell[:, 0]))
    return (
        f"{packing.soil}, {len(packing.radius)} grains, seed {packing.seed}\n"
        f"$e$ = {packing.void_ratio:.3f}, $p$ = {packing.pressure() / 1e3:.3g} kPa, cell {1e3 * width:.3g} mm wide"
    )


def draw_rve(axis: Axes, snapshot: Snapshot) -> None:
    inside = draw_grains(axis, snapshot, face="0.9", edge="0.6")
    if len(snapshot["contact_i"]):
        force = normal_forces(snapshot)
        share = force / (force.mean() or 1.0)
        order = np.argsort(share)
        bars = branches_from(inside, snapshot, order)
        colour = np.where(share >= STRONGEST, STRONGEST_FORCE, np.where(share >= STRONG, STRONG_FORCE, WEAK_FORCE))
        axis.add_collection(LineCollection(bars, linewidths=np.clip(0.9 * share[order], 0.1, 6), colors=colour[order]))
    frame_cell(axis, snapshot["cell"])


def draw_packing(
    axis: Axes, radius: np.ndarray, position: np.ndarray, cell: np.ndarray, contacts: np.ndarray | None = None
) -> None:
    """Draws the grains of a packing in its cell: radius (grain), position (grain, 2), cell (2, 2; columns are the
    periodic vectors), all in m; contacts (contact, 2), where they are given, as lines between the grains."""
    snapshot = {"cell": cell, "x": position[:, 0], "y": position[:, 1], "radius": radius}
    inside = draw_grains(axis, snapshot, face="0.85", edge="0.45")
    if contacts is not None and len(contacts):
        i, j = contacts.T
        start = inside[i]
        lines = np.stack([start, start + branches(position, cell, i, j)], axis=1)
        axis.add_collection(LineCollection(list(lines), linewidths=0.7, colors=STRONG_FORCE))
    frame_cell(axis, cell)


def branches_from(inside: np.ndarray, snapshot: Snapshot, chosen: np.ndarray) -> list[np.ndarray]:
    """Lines from grain to grain of these contacts; `inside` are the places of the grains."""
    start = inside[snapshot["contact_i"][chosen]]
    return list(np.stack([start, start + snapshot["branch"][chosen]], axis=1))


def draw_grains(axis: Axes, snapshot: Snapshot, face: str, edge: str) -> np.ndarray:
    """Draws all grains and returns their places within the cell (grain, 2) [m], to which files pay no regard."""
    cell, position = snapshot["cell"], np.column_stack([snapshot["x"], snapshot["y"]])
    inside = position - (cell @ np.floor(np.linalg.solve(cell, position.T))).T
    diameter = 2 * snapshot["radius"]
    axis.add_collection(
        EllipseCollection(
            diameter,
            diameter,
            np.zeros_like(diameter),
            units="xy",
            offsets=inside,
            offset_transform=axis.transData,
            facecolors=face,
            edgecolors=edge,
            linewidths=0.3,
        )
    )
    return inside


def frame_cell(axis: Axes, cell: np.ndarray) -> None:
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]) @ cell.T
    axis.plot(*corners.T, color="black", linewidth=0.8)
    axis.set_aspect("equal")
    axis.grid(False)
    axis.set_xticks([])
    axis.set_yticks([])
    axis.autoscale_view()
