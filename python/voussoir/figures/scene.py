"""What a scene's case and increments say of its stages, its moved boundaries and its records.

A scene is a run of the kind `scene`: stages one after another, in which boundaries are held, moved, pressed or
released, and regions are dug out.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from .result import Increment, Missing, Result, remembered
from .style import CYCLE, LINES
from .units import quantity

AXES = ("x", "y")
TOWARDS = {("x", True): "to the right", ("x", False): "to the left", ("y", True): "upwards", ("y", False): "downwards"}


@dataclass
class Stage:
    """The increments of one stage, the first of which may be the state at its start."""

    name: str
    number: int  # counted from 0 over the stages that the run has begun
    increments: list[Increment]
    case: dict[str, Any]

    @property
    def colour(self) -> str:
        return CYCLE[self.number % len(CYCLE)]

    @property
    def line(self) -> str:
        return LINES[self.number % len(LINES)]

    @property
    def title(self) -> str:
        return self.name.replace("_", " ")


def stages(result: Result) -> list[Stage]:
    """The stages in the order in which they were run."""
    cases = {str(stage.get("name", "")): stage for stage in result.case.get("stage", [])}
    runs = groupby(result.increments, key=lambda increment: increment["stage"])
    return [Stage(name, k, list(group), cases.get(name, {})) for k, (name, group) in enumerate(runs)]


def start_of_displacements(result: Result, increment: Increment) -> Increment | None:
    """The last state up to an increment at which displacements begin: the start of a stage whose displacements are all
    zero; None where the run did not write it."""
    starts = [i for i in result.increments if i["index"] <= increment["index"] and i.attributes.get("stage_index") == 0]
    return next((i for i in reversed(starts) if not np.any(i.field("node/displacement"))), None)


def column(increments: Sequence[Increment], name: str) -> np.ndarray:
    """A column of the table of increments; NaN where an increment does not have it."""
    return np.array([float(i.attributes.get(name, np.nan)) for i in increments])


def has(result: Result, name: str) -> bool:
    return any(name in i.attributes for i in result.increments)


def progress(stage: Stage) -> np.ndarray:
    """How far the scene has come at the stage's increments: the number of the stages before and the load parameter,
    which goes from 0 to 1 [-]."""
    return stage.number + column(stage.increments, "load_parameter")


def is_written(table: dict[str, Any], key: str) -> bool:
    return table.get(key) not in (None, "", [])


@dataclass
class Motion:
    """A boundary that the case moves or releases in some stage."""

    name: str
    axis: str  # "x" or "y", along which it moves most
    with_area: bool  # its enclosed area is changed
    about: Any = None  # centre of a change of the area, as the case writes it
    forward: bool = True  # it moves to the right or upwards

    @property
    def movement(self) -> str:
        """Where the boundary goes, for labels."""
        return TOWARDS[self.axis, self.forward]


def motions(result: Result) -> list[Motion]:
    """The boundaries that any stage moves or releases, in the order of the case. At least one, or Missing is raised."""

    def values(name: str) -> np.ndarray | None:
        return column(result.increments, name) if has(result, name) else None

    return remembered(result, "motions", lambda: motions_of(result.case, values))


def motions_of(case: dict[str, Any], values: Callable[[str], np.ndarray | None]) -> list[Motion]:
    """The same from a case and a function that gives a column over the increments, or None."""
    known: dict[str, list[dict[str, Any]]] = {}
    for stage in case.get("stage", []):
        for change in [*stage.get("move", []), *stage.get("release", [])]:
            for name in names_in(change):
                known.setdefault(name, []).append(change)
    found = [
        _motion(name, changes, values)
        for name, changes in known.items()
        if values(f"displacement_{name}_y") is not None
    ]
    if not found:
        raise Missing("no boundary of the scene is moved or released")
    return found


def first_sign(reaction: np.ndarray) -> float:
    """The sign of the first values that are not nearly zero; 1 where there are none."""
    reaction = np.nan_to_num(reaction)
    there = np.flatnonzero(np.abs(reaction) > 1e-6 * np.abs(reaction).max(initial=0))
    return float(np.sign(reaction[there[0]])) if len(there) else 1.0


def names_in(table: dict[str, Any]) -> list[str]:
    """The boundaries that a table of the case names: one, several or none."""
    written = table.get("boundary", [])
    return [str(name) for name in written] if isinstance(written, list) else [str(written)] if written else []


def _motion(name: str, changes: list[dict[str, Any]], values: Callable[[str], np.ndarray | None]) -> Motion:
    areas = [change for change in changes if is_written(change, "area")]
    columns = {axis: values(f"displacement_{name}_{axis}") for axis in AXES}
    moved = {axis: np.nan_to_num(np.zeros(0) if found is None else found) for axis, found in columns.items()}
    named = [axis for axis in AXES if any(is_written(change, axis) for change in changes)]
    axis = max(named or AXES, key=lambda a: np.abs(moved[a]).max(initial=0))
    furthest = moved[axis][np.argmax(np.abs(moved[axis]))] if len(moved[axis]) else 0.0
    with_area = bool(areas) and values(f"area_{name}") is not None
    return Motion(name, axis, with_area, areas[0].get("about") if areas else None, bool(furthest >= 0))


def released_share(stage: Stage, boundary: str) -> float:
    """The share of the forces on a boundary that a stage takes off [-]; 0 where it does not release it."""
    for release in stage.case.get("release", []):
        if boundary in names_in(release):
            return quantity(release.get("share", 1.0))
    return 0.0


def held_boundaries(result: Result) -> list[str]:
    """The boundaries and recorded points that have columns of reactions, by their names."""
    first, last = "reaction_", "_y"
    names = {n for i in result.increments for n in i.attributes if n.startswith(first) and n.endswith(last)}
    return sorted(name[len(first) : -len(last)] for name in names)


def records(result: Result, key: str) -> list[dict[str, Any]]:
    """The records of the case that have a "point", a "line" or a "region"."""
    return [record for record in result.case.get("record", []) if is_written(record, key)]


def mark_stages(axis: Axes, shown: Sequence[Stage], named: bool = True) -> None:
    """Lines between the stages on an axis of progress, and their names above it."""
    for stage in shown:
        if stage.number:
            axis.axvline(stage.number, color="0.4", linewidth=0.8, linestyle="--")
    if named:
        ticks = [stage.number + 0.5 for stage in shown]
        above = axis.secondary_xaxis("top")
        above.set_xticks(ticks, [stage.title for stage in shown], fontsize=9)
        above.tick_params(length=0)
    axis.set_xlim(0, len(shown))
    axis.set_xlabel("stage, and its load parameter  [-]")


def place_of(result: Result, written: Any) -> np.ndarray | None:
    """The coordinates [m] of a point of the case: given as such, or a name that run.h5 has; else None. A file without
    points, as the first versions wrote them, still has those of the built-in shapes."""
    if isinstance(written, list) and len(written) == 2:
        return np.array([quantity(value) for value in written])
    if str(written) in result.points:
        return np.asarray(result.coordinates[result.points[str(written)]])
    low, high = result.coordinates.min(axis=0), result.coordinates.max(axis=0)
    corners = {
        "base_left": low,
        "base_right": np.array([high[0], low[1]]),
        "top_left": np.array([low[0], high[1]]),
        "top_right": high,
    }
    opening = result.boundaries.get("opening", result.boundaries.get("tunnel"))
    if opening is not None:
        nodes = result.coordinates[opening]
        corners |= {"crown": nodes[np.argmax(nodes[:, 1])], "invert": nodes[np.argmin(nodes[:, 1])]}
    return corners.get(str(written))
