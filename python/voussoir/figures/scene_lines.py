"""Displacements and stresses along the lines that a scene records: settlement troughs, walls, rays."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from . import scene
from .result import Increment, Missing, Result
from .style import colours, save

MOST = 6  # increments that are shown of a line


@dataclass
class Line:
    """The table `line_NAME` of run.h5, whose rows are places within increments."""

    name: str
    table: dict[str, np.ndarray]

    def at(self, increment: Increment) -> np.ndarray:
        """The rows of an increment."""
        return np.flatnonzero(np.round(self.table["increment"]) == increment["index"])

    @property
    def along(self) -> tuple[str, str]:
        """The column that tells places apart, and its label: x of a level line, y of an upright one, else s."""
        level = {axis: np.ptp(self.table[axis]) < 1e-6 * max(np.ptp(self.table["s"]), 1e-12) for axis in ("x", "y")}
        if level["y"]:
            return "x", "$x$  [m]"
        return ("y", "height  $y$  [m]") if level["x"] else ("s", "distance along the line  $s$  [m]")


def lines(result: Result) -> list[Line]:
    prefix = "line_"
    wanted = ("increment", "s", "x", "y", "displacement_x", "displacement_y", "stress_xx", "stress_yy", "stress_xy")
    found = [name for name in sorted(result.tables) if name.startswith(prefix)]
    if not found:
        raise Missing("run.h5 has no table of a line: the scene records none, or has not ended")
    return [Line(name[len(prefix) :], result.table(name, *wanted)) for name in found]


def chosen(result: Result) -> list[tuple[Increment, str]]:
    """The increments that are shown with their names: the end of each stage and, of the last one, quarters."""
    shown = scene.stages(result)
    ends = [(stage, stage.increments[-1]) for stage in shown[:-1]][-2:]
    last = shown[-1].increments
    steps = np.unique(np.round(np.linspace(0, len(last) - 1, min(len(last), MOST - 1))).astype(int))
    parts = [(shown[-1], last[k]) for k in steps if k > 0 or len(steps) == 1]
    return [(i, f"{stage.title}, {i['load_parameter']:.3g}") for stage, i in [*ends, *parts]]


PANELS: tuple[tuple[str, Callable[[dict[str, np.ndarray]], np.ndarray]], ...] = (
    ("settlement  $-u_y$  [mm]", lambda t: -1e3 * t["displacement_y"]),
    ("displacement to the right  $u_x$  [mm]", lambda t: 1e3 * t["displacement_x"]),
    (r"$\sigma_{yy}$, compression positive  [kPa]", lambda t: -1e-3 * t["stress_yy"]),
    (r"$\sigma_{xx}$, compression positive  [kPa]", lambda t: -1e-3 * t["stress_xx"]),
)


def draw(result: Result, path: Path) -> None:
    """A row of panels for each line. Places of an upright line are on the upright axis."""
    found, states = lines(result), chosen(result)
    figure, axes = plt.subplots(
        len(found),
        len(PANELS),
        figsize=(4.6 * len(PANELS), 4.2 * len(found) + 0.4),
        squeeze=False,
        layout="constrained",
    )
    for line, row in zip(found, axes):
        place, label = line.along
        for axis, (quantity, values_of) in zip(row, PANELS):
            values = values_of(line.table)
            for (increment, name), colour in zip(states, colours("viridis", len(states))):
                rows = line.at(increment)
                xy = (line.table[place][rows], values[rows])
                axis.plot(*(xy[::-1] if place == "y" else xy), color=colour, label=name)
            if place == "y":
                axis.set_xlabel(quantity)
                axis.set_ylabel(label)
            else:
                axis.set_ylabel(quantity)
                axis.set_xlabel(label)
                if quantity.startswith("settlement"):
                    axis.invert_yaxis()
            axis.set_title(f"line {line.name}")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), title="stage, load parameter", loc="outside right upper")
    save(figure, path)
