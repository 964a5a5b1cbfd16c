"""What holds the boundaries and points of a scene, from the start or from a later stage on, as its case says it."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from . import scene
from .result import Result

START = -1  # stands for the number of a stage where something is held before the first one


@dataclass
class Hold:
    """A boundary, or a point, and the stages between which it is held along each axis."""

    name: str
    place: np.ndarray | None = None  # of a point [m]; a boundary has none
    first: dict[str, int] = field(default_factory=dict)  # number of the stage by axis, or START
    end: dict[str, int] = field(default_factory=dict)  # number of the stage that releases it first

    @property
    def from_start(self) -> bool:
        return START in self.first.values()

    def words(self, stages: list[str]) -> str:
        """ "held x and y", "held x, y from stage dig on", "held x from stage dig until stage free"."""
        axes: dict[tuple[int, int | None], list[str]] = {}
        for axis in sorted(self.first):
            axes.setdefault((self.first[axis], self.end.get(axis)), []).append(axis)
        parts = []
        for (first, end), named in sorted(axes.items(), key=lambda entry: entry[0][0]):
            part = " and ".join(named)
            if first != START:
                part += f" from stage {stages[first]}" + (" on" if end is None else "")
            if end is not None:
                part += f" until stage {stages[end]}"
            parts.append(part)
        return "held " + ", ".join(parts) if parts else ""


def holds(result: Result) -> list[Hold]:
    """All that a support or a stage holds: boundaries and points, in the order of the case."""
    known: dict[Any, Hold] = {}
    for support in result.case.get("support", []):
        for key, hold in _targets(result, support):
            _begin(known.setdefault(key, hold), set(str(support.get("fix", ""))), START)
    for number, stage in enumerate(result.case.get("stage", [])):
        for release in stage.get("release", []):
            for key, hold in _targets(result, release):
                _end(known.setdefault(key, hold), number)
        for move in stage.get("move", []):
            for key, hold in _targets(result, move):
                _begin(known.setdefault(key, hold), _axes(move), number)
    return [hold for hold in known.values() if hold.first]


def _begin(hold: Hold, axes: set[str], number: int) -> None:
    for axis in axes & set(scene.AXES):
        hold.first.setdefault(axis, number)


def _end(hold: Hold, number: int) -> None:
    for axis in hold.first:
        hold.end.setdefault(axis, number)


def _axes(move: dict[str, Any]) -> set[str]:
    if scene.is_written(move, "rotation") or scene.is_written(move, "area"):
        return set(scene.AXES)
    return {axis for axis in scene.AXES if scene.is_written(move, axis)}


def _targets(result: Result, table: dict[str, Any]) -> Iterator[tuple[Any, Hold]]:
    """What a table of the case names, with a key by which it is known again: points by their place."""
    for name in scene.names_in(table):
        yield name, Hold(name)
    if not scene.is_written(table, "point"):
        return
    place = scene.place_of(result, table["point"])
    if place is not None:
        x, y = (float(value) for value in place)
        name = table["point"] if isinstance(table["point"], str) else f"({x:.4g}, {y:.4g}) m"
        yield (round(x, 9), round(y, 9)), Hold(f"point {name}", place)
