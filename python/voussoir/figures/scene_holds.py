"""What holds the boundaries and points of a scene, from the start or from a later stage on, as its case says it."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from . import scene
from .result import Result

START = -1  # stands for the number of a stage where something is held before the first one


Span = tuple[int, int | None]  # numbers of the stage that holds, or START, and of the one that releases, if one does


@dataclass
class Hold:
    """A boundary, or a point, and the stages between which it is held along each axis."""

    name: str
    place: np.ndarray | None = None  # of a point [m]; a boundary has none
    spans: dict[str, tuple[Span, ...]] = field(default_factory=dict)  # by axis, one after the other

    @property
    def from_start(self) -> bool:
        return any(spans[0][0] == START for spans in self.spans.values())

    def words(self, stages: list[str]) -> str:
        """ "held x and y", "held x, y from stage dig on", "held x until stage dig and from stage prop on"."""
        axes: dict[tuple[Span, ...], list[str]] = {}
        for axis in sorted(self.spans):
            axes.setdefault(self.spans[axis], []).append(axis)
        parts = []
        for spans, named in sorted(axes.items(), key=lambda entry: entry[0][0][0]):
            parts.append(" and ".join(named) + " and".join(_span_words(span, stages) for span in spans))
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
    return [hold for hold in known.values() if hold.spans]


def _begin(hold: Hold, axes: set[str], number: int) -> None:
    """What a stage releases and holds again is held all the time."""
    for axis in axes & set(scene.AXES):
        *earlier, (first, end) = hold.spans.get(axis, ((number, number),))
        if end == number:
            hold.spans[axis] = (*earlier, (first, None))
        elif end is not None:
            hold.spans[axis] = (*earlier, (first, end), (number, None))


def _end(hold: Hold, number: int) -> None:
    for axis, (*earlier, (first, end)) in hold.spans.items():
        hold.spans[axis] = (*earlier, (first, number if end is None else end))


def _span_words(span: Span, stages: list[str]) -> str:
    first, end = span
    words = "" if first == START else f" from stage {stages[first]}"
    if end is not None:
        return words + f" until stage {stages[end]}"
    return words + " on" if words else ""


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
