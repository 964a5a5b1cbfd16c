"""Pictures of RVEs: fabric before and after the loss at three points of the arch (fig. 17), localisation (fig. 19),
force chains (fig. 20) and strong networks by soil (fig. 24)."""

import re
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.projections.polar import PolarAxes

from .. import chains, panels, points
from ..resolution import percent
from ..result import Increment, Missing, Result, Snapshot
from ..style import CYCLE, STRONG_FORCE, STRONGEST_FORCE
from .data import Study
from .drawing import about_members, finish, noted
from .paths import point

LOCALISATION_LOSSES = (0.10, 0.15, 0.20)  # V_l of fig. 19 [-]
CHAIN_LOSSES = (0.05, 0.125, 0.20)  # of fig. 20
NETWORK_LOSS = 0.10  # of fig. 24
NEAR = 0.25  # an RVE that was written within this distance of a point stands for it, in D
SHOULDER, FOOT = (0.55, 0.55), (0.85, 0.0)  # B and C of fig. 17 from the tunnel's axis, in D
ROSE = 0.28  # density at the rim of a rose [1/rad]; it is 0.16 where contacts have no direction
BINS = 18  # of a rose, over half a turn


@dataclass
class Place:
    """A point of the arch: its Gauss point, and the RVE that was written there or nearby."""

    name: str
    where: str
    index: int
    snapshot: str | None


def arch_points(result: Result) -> list[Place]:
    """A above the crown (Aa), B at the shoulder, C beside the tunnel, where the arch stands: the paper gives their
    places in a picture only. A point takes the place of an RVE that was written within D/4 of it."""
    axis_depth, diameter, surface_y = result.need("axis_depth", "diameter", "surface_y")
    centre = np.array([0.0, surface_y - axis_depth])
    above = point(result, "Aa").position
    wanted = {"A": above, "B": centre + diameter * np.array(SHOULDER), "C": centre + diameter * np.array(FOOT)}
    where = points.original_points(result)
    found = []
    for name, place in wanted.items():
        index, snapshot = nearest_snapshot(result, place, NEAR * diameter)
        if snapshot is None:
            index = points.nearest(result, name, *place).index
        x, y = (where[index] - centre) / diameter
        found.append(Place(name, f"$x$ = {x:.2f} $D$, $y$ = {y:.2f} $D$", index, snapshot))
    return found


def nearest_snapshot(result: Result, place: np.ndarray, reach: float) -> tuple[int, str | None]:
    """Gauss point and name of the RVE that was written next to a place; no name where none is within reach [m]."""
    names = result.loss_increments[-1].snapshots
    numbers = {name: int(found[1]) for name in names if (found := re.search(r"(\d+)$", name))}
    where = points.original_points(result)
    away = {name: float(np.linalg.norm(where[number] - place)) for name, number in numbers.items()}
    best = min(away, key=away.__getitem__, default=None)
    if best is None or away[best] > reach:
        return -1, None
    return numbers[best], best


def draw_fabric(study: Study, path: Path) -> None:
    """Figure 17: the RVEs at A, B, C before and after the loss, with the roses of their contact normals."""
    tunnel = study.main()
    result = tunnel.representative
    states = (result.start, result.loss_increments[-1])
    places = arch_points(result)
    for name in ("gauss/fabric_anisotropy", "gauss/fabric_direction"):
        _ = states[-1].field(name)  # raises where the fabric was not written
    figure = plt.figure(figsize=(14.5, 4.1 * len(places)), layout="constrained")
    grid = figure.add_gridspec(len(places), 4)
    for row, place in enumerate(places):
        for k, increment in enumerate(states):
            axis = figure.add_subplot(grid[row, 2 * k])
            _add_rve(axis, increment, place)
            title = f"{place.name}, $V_l$ = {percent(increment['volume_loss'])}"
            axis.set_title(title if k else f"{title}\n{place.where}", fontsize=10)
            rose = figure.add_subplot(grid[row, 2 * k + 1], projection="polar")
            _add_rose(rose, increment, place)
    figure.suptitle(
        f"Contact networks and their fabric, {tunnel.label}; width of a bar by normal force, "
        f"{chains.COLOURS_OF_FORCES}\nroses: share of the contact normals, line: eq. (22)",
        fontsize=12,
    )
    finish(figure, path, about_members([tunnel]))


def _add_rve(axis: Axes, increment: Increment, place: Place) -> None:
    if place.snapshot is None or place.snapshot not in increment.snapshots:
        axis.set_axis_off()
        axis.text(
            0.5,
            0.5,
            "No RVE was written\ngrain by grain near this point\n(output.rves).",
            ha="center",
            va="center",
            transform=axis.transAxes,
        )
        return
    chains.draw_rve(axis, increment.snapshot(place.snapshot))


def contact_angles(snapshot: Snapshot) -> np.ndarray:
    """Directions of the contact normals from x, without an arrow: in [0, pi) [rad]."""
    branch = snapshot["branch"]
    return np.mod(np.arctan2(branch[:, 1], branch[:, 0]), np.pi)


def fourier(angle: np.ndarray, anisotropy: float, direction: float) -> np.ndarray:
    """E of eq. (22): the density of contact normals over a whole turn [1/rad]."""
    return (1 + anisotropy * np.cos(2 * (angle - direction))) / (2 * np.pi)


def fabric_at(increment: Increment, index: int) -> tuple[float, float]:
    """a and theta_a [rad, from x] of eq. (22) at a Gauss point."""
    anisotropy = increment.field("gauss/fabric_anisotropy").ravel()[index]
    return float(anisotropy), float(increment.field("gauss/fabric_direction").ravel()[index])


def _add_rose(axis: Axes, increment: Increment, place: Place) -> None:
    assert isinstance(axis, PolarAxes)
    anisotropy, direction = fabric_at(increment, place.index)
    if place.snapshot is not None and place.snapshot in increment.snapshots:
        angles = contact_angles(increment.snapshot(place.snapshot))
        edges = np.linspace(0, np.pi, BINS + 1)
        density = np.histogram(angles, edges)[0] / max(1, len(angles)) / (2 * np.diff(edges))
        centres = (edges[1:] + edges[:-1]) / 2
        both = np.concatenate([centres, centres + np.pi])
        axis.bar(
            both, np.tile(density, 2), width=np.pi / BINS, color=CYCLE[5], alpha=0.6, edgecolor="0.4", linewidth=0.4
        )
    turn = np.linspace(0, 2 * np.pi, 361)
    axis.plot(turn, fourier(turn, anisotropy, direction), color=CYCLE[3], linewidth=1.8)
    axis.set_ylim(0, ROSE)
    axis.set_yticklabels([])
    axis.set_xticks(np.radians(range(0, 360, 45)))
    axis.tick_params(labelsize=8)
    axis.set_title(rf"$a$ = {anisotropy:.2f},  $\theta_a$ = {np.degrees(direction):.0f}°", fontsize=10)


def draw_localisation(study: Study, path: Path) -> None:
    """Figure 19: strain, grain rotation and void ratio."""
    tunnel = study.main()
    with noted(about_members([tunnel])):
        panels.draw(tunnel.representative, path, LOCALISATION_LOSSES)


def draw_chains(study: Study, path: Path) -> None:
    """Figure 20: force chains at Aa, Ab, Ac and B."""
    tunnel = study.main()
    with noted(about_members([tunnel])):
        chains.draw(tunnel.representative, path, CHAIN_LOSSES, ("Aa", "Ab", "Ac", "B"))


def draw_strong(study: Study, path: Path) -> None:
    """Figure 24: the strong networks C1 and C2 at Aa by soil."""
    found = [(tunnel, *near_aa(tunnel.representative)) for tunnel in study.soils()]
    shown = [(tunnel, increment, name) for tunnel, increment, name in found if name is not None]
    if not shown:
        raise Missing("no RVE near Aa was written grain by grain (output.rves)")
    figure, axes = plt.subplots(1, len(shown), figsize=(5.2 * len(shown), 6.0), squeeze=False, layout="constrained")
    for axis, (tunnel, increment, name) in zip(axes[0], shown):
        snapshot = increment.snapshot(name)
        draw_network(axis, snapshot)
        strong, strongest = (strong_share(snapshot, least) for least in (chains.STRONG, chains.STRONGEST))
        width = 1e3 * float(np.linalg.norm(snapshot["cell"][:, 0]))
        axis.set_title(
            f"{tunnel.label}, $V_l$ = {percent(increment['volume_loss'])}\n{len(snapshot['radius'])} grains, cell "
            f"{width:.0f} mm wide\nin $C_1$ or $C_2$: {percent(strong)} of the grains, in $C_2$: {percent(strongest)}",
            fontsize=10,
        )
    figure.suptitle(
        "Strong contact networks at Aa; orange: $C_1$, from the mean normal force on, dark: $C_2$, from twice on",
        fontsize=12,
    )
    finish(figure, path, about_members([tunnel for tunnel, _, _ in shown]))


def near_aa(result: Result) -> tuple[Increment, str | None]:
    """The state of a run next to V_l = 10 %, and the RVE that was written near Aa."""
    (diameter,) = result.need("diameter")
    return result.next_to(NETWORK_LOSS), nearest_snapshot(result, point(result, "Aa").position, NEAR * diameter)[1]


def strong_contacts(snapshot: Snapshot, least: float) -> np.ndarray:
    """True for contacts whose normal force is at least this multiple of the mean."""
    force = chains.normal_forces(snapshot)
    return force >= least * force.mean() if len(force) else np.zeros(0, dtype=bool)


def strong_share(snapshot: Snapshot, least: float) -> float:
    """The share of the grains that have a contact of the strong network."""
    chosen = strong_contacts(snapshot, least)
    grains = np.union1d(snapshot["contact_i"][chosen], snapshot["contact_j"][chosen])
    return len(grains) / len(snapshot["radius"])


def draw_network(axis: Axes, snapshot: Snapshot) -> None:
    """The strong contacts alone, over faint grains."""
    inside = chains.draw_grains(axis, snapshot, face="0.96", edge="0.8")
    for least, colour, thick in ((chains.STRONG, STRONG_FORCE, 1.6), (chains.STRONGEST, STRONGEST_FORCE, 3.6)):
        bars = chains.branches_from(inside, snapshot, strong_contacts(snapshot, least))
        axis.add_collection(LineCollection(bars, colors=colour, linewidths=thick, capstyle="round"))
    chains.frame_cell(axis, snapshot["cell"])
