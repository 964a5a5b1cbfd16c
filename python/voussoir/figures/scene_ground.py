"""The mesh of a scene with its names, and its fields at the ends of the stages."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import Stroke

from . import panels, q8, regions, scene, scene_holds
from .result import Increment, Missing, Result
from .style import CYCLE, LINES, save

PALE = ("#eef3f7", "#f7ead0", "#dcefe6", "#f6e0ea", "#d9ebf8", "#e8e3d4")  # of regions, below coloured boundaries
MOST_STATES = 4
FIELDS = [*panels.FIELDS, ("gauss/mean_stress", 1e-3, "mean stress  $p$  [kPa]", "viridis", False)]


def draw_mesh(result: Result, path: Path) -> None:
    """The mesh before anything moves: elements in the colour of their region, boundaries, recorded places."""
    outlines = q8.outlines(result.coordinates, result.connectivity)
    wide, high = np.ptp(result.coordinates, axis=0)
    figure, axis = plt.subplots(figsize=(9.6, float(np.clip(7.5 * high / wide, 2.4, 9.6)) + 1.0), layout="constrained")
    region = result.regions if result.regions is not None else np.zeros(len(result.connectivity), dtype=int)
    shades = [PALE[k % len(PALE)] for k in region]
    axis.add_collection(PolyCollection(list(outlines), facecolors=shades, edgecolors="0.6", linewidths=0.4))
    named: list[Artist] = [
        Patch(facecolor=PALE[k % len(PALE)], edgecolor="0.6", label=f"region {name}") for k, name in _regions(result)
    ]
    held = scene_holds.holds(result)
    of_boundary = {hold.name: hold for hold in held if hold.place is None}
    named += [
        _draw_boundary(axis, result, name, of_boundary.get(name), k) for k, name in enumerate(sorted(result.boundaries))
    ]
    named += [_draw_held_point(axis, result, hold) for hold in held if hold.place is not None]
    named += _draw_records(axis, result)
    axis.set_aspect("equal")
    axis.margins(0.03)
    axis.grid(False)
    axis.set_xlabel("$x$  [m]")
    axis.set_ylabel("$y$  [m]")
    axis.set_title(f"{len(result.connectivity)} elements, {len(result.coordinates)} nodes, {wide:.4g} × {high:.4g} m")
    figure.legend(handles=named, loc="outside right upper", fontsize=9)
    save(figure, path)


def _regions(result: Result) -> list[tuple[int, str]]:
    if result.region_names:
        return list(enumerate(result.region_names))
    return [(0, name) for region in result.case.get("region", [])[:1] for name in regions.names_of(region)[:1]]


def _stages(result: Result) -> list[str]:
    return [str(stage.get("name", "")) for stage in result.case.get("stage", [])]


def _draw_boundary(axis: Axes, result: Result, name: str, hold: scene_holds.Hold | None, k: int) -> Line2D:
    """A named boundary, which may be in several pieces: the sides of elements of which all three nodes are named. One
    that only a later stage holds is hollow."""
    named = np.zeros(len(result.coordinates), dtype=bool)
    named[result.boundaries[name]] = True
    sides = regions.all_sides(result)
    along = sides[named[sides].all(axis=1)]
    colour, style = CYCLE[k % len(CYCLE)], LINES[k // len(CYCLE) % len(LINES)]
    is_hollow = hold is not None and not hold.from_start
    width = 4.5 if is_hollow else 3
    axis.add_collection(
        LineCollection(list(result.coordinates[along]), colors=colour, linewidths=width, linestyles=style, zorder=3)
    )
    handle = Line2D([], [], color=colour, linestyle=style, linewidth=width, label=name)
    if hold is not None:
        handle.set_label(f"{name}, {hold.words(_stages(result))}")
    if is_hollow:
        axis.add_collection(LineCollection(list(result.coordinates[along]), colors="white", linewidths=2, zorder=3))
        handle.set_path_effects([Stroke(linewidth=width, foreground=colour), Stroke(linewidth=2, foreground="white")])
    return handle


def _draw_held_point(axis: Axes, result: Result, hold: scene_holds.Hold) -> Line2D:
    """A triangle below the point, which is hollow where only a later stage holds it."""
    assert hold.place is not None
    inside = "black" if hold.from_start else "white"
    label = f"{hold.name}, {hold.words(_stages(result))}"
    x, y = (float(value) for value in hold.place)
    return axis.plot(x, y, "^", color="black", markerfacecolor=inside, markersize=9, zorder=5, label=label)[0]


def _draw_records(axis: Axes, result: Result) -> list[Line2D]:
    found = []
    for record in scene.records(result, "point"):
        place = scene.place_of(result, record["point"])
        if place is not None:
            found += axis.plot(*place, "o", color="black", markersize=6, zorder=4, label=f"point {record['name']}")
            here = (float(place[0]), float(place[1]))
            axis.annotate(str(record["name"]), here, xytext=(6, 6), textcoords="offset points", fontsize=9, zorder=4)
    for record in scene.records(result, "line"):
        ends = [scene.place_of(result, end) for end in record["line"]]
        if all(end is not None for end in ends):
            x, y = np.array(ends).T
            found += axis.plot(x, y, "k--", linewidth=1.2, zorder=4, label=f"line {record['name']}")
    return found


def states(result: Result) -> list[Increment]:
    """The ends of the last four stages; where there are fewer stages, also the middle of the last one."""
    shown = scene.stages(result)
    last = shown[-1].increments
    found = [stage.increments[-1] for stage in shown][-MOST_STATES:]
    if len(found) < MOST_STATES and len(last) > 2:
        found.insert(-1, last[(len(last) - 1) // 2])
    return found


def draw_fields(result: Result, path: Path) -> None:
    """Strain, rotation, void ratio and mean stress over the deformed mesh at the ends of stages."""
    chosen = states(result)
    fields = [entry for entry in FIELDS if entry[0] in set.intersection(*(i.names for i in chosen))]
    if not fields:
        raise Missing("there is no field of the Gauss points")
    wide, high = np.ptp(result.coordinates, axis=0)
    titles = [f"{i['stage'].replace('_', ' ')}, {i['load_parameter']:.3g}" for i in chosen]
    figure, axes = panels.draw_rows(
        result, fields, chosen, titles, (4.4, float(np.clip(3.8 * high / wide, 1.8, 5.0)) + 0.5)
    )
    axes[0, 0].autoscale_view()
    figure.suptitle("Stage and load parameter, on the deformed mesh", fontsize=12)
    save(figure, path)
