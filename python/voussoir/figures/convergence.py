"""The convergence of the increments and their cost."""

from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from .result import Increment, Result
from .style import save


def draw(result: Result, path: Path) -> None:
    increments = result.increments
    index = np.array([i["index"] for i in increments])
    column = {
        name: np.array([float(i[name]) for i in increments])
        for name in ("residual", "evaluations", "iterations", "converged", "wall_s")
    }
    figure, (top, middle, bottom) = plt.subplots(3, 1, figsize=(8.4, 7.8), sharex=True)
    # A residual of exactly zero (a stage's first state) has no place on a logarithmic axis.
    shown = column["residual"] > 0
    good = column["converged"] > 0
    top.semilogy(
        index[shown & good], column["residual"][shown & good], "o", markersize=3.5, color="C0", label="converged"
    )
    if not good.all():
        top.semilogy(index[shown & ~good], column["residual"][shown & ~good], "X", color="C3", label="not converged")
    if all("residual_bound" in i.attributes for i, s in zip(increments, shown) if s) and shown.any():
        bound = np.array([float(i.attributes.get("residual_bound", np.nan)) for i in increments])
        top.semilogy(index[shown], bound[shown], "_", color="black", label="allowed: tolerance and noise floor")
        top.legend(loc="lower right")
    if shown.any():
        top.set_ylim(column["residual"][shown].min() / 3, 3 * column["residual"][shown].max())
    top.set_ylabel("relative residual  [-]")
    middle.bar(index, column["evaluations"], width=0.85, color="0.75", label="evaluations, cut tries included")
    middle.bar(index, column["iterations"], width=0.5, color="C0", label="iterations")
    relaxed = np.array([float(i.attributes.get("relaxations", 0)) for i in increments])
    cuts = np.array([float(i["cuts"]) for i in increments])
    for number, marker, label in ((relaxed, ".", "substeps of relaxation"), (cuts, "x", "cuts")):
        if number.any():
            middle.plot(
                index[number > 0],
                number[number > 0],
                marker,
                color="C3",
                markersize=5,
                label=f"{label}, {number.sum():.0f} in all",
            )
    middle.set_ylabel("number  [-]")
    middle.legend()
    _draw_times(bottom, index, increments, column["wall_s"])
    bottom.set_ylabel("wall time so far  [min]")
    bottom.set_xlabel("increment")
    bottom.xaxis.set_major_locator(MaxNLocator(integer=True))
    _mark_stages(top, (middle, bottom), increments)
    figure.suptitle(f"Convergence: {int(good.sum())} of {len(increments)} increments converged", fontsize=12)
    figure.tight_layout()
    save(figure, path)


def _draw_times(axis: Axes, index: np.ndarray, increments: Sequence[Increment], wall: np.ndarray) -> None:
    """Draws the wall time so far, by part where parts are recorded; an increment's output counts with the next one."""
    parts = [
        ("time_grains", "grains", "C0"),
        ("time_tangents", "tangents", "C4"),
        ("time_solve", "solution", "C1"),
        ("time_assembly", "assembly", "C2"),
        ("time_output", "output", "C3"),
    ]
    times = {name: np.cumsum([float(i.attributes.get(name, 0.0)) for i in increments]) / 60 for name, _, _ in parts}
    base: np.ndarray = np.zeros(len(index))
    for name, label, colour in parts:
        if times[name][-1] > 0:
            axis.fill_between(
                index,
                base,
                base + times[name],
                color=colour,
                alpha=0.75,
                linewidth=0,
                label=f"{label}: {times[name][-1]:.2g} min",
            )
            base = base + times[name]
    total = np.cumsum(wall) / 60 + times["time_output"]
    axis.plot(index, total, color="black", linewidth=1.2, label=f"all: {total[-1]:.3g} min")
    axis.legend(loc="upper left")


def _mark_stages(named: Axes, others: Sequence[Axes], increments: Sequence[Increment]) -> None:
    previous = None
    for increment in increments:
        if increment["stage"] != previous:
            previous = increment["stage"]
            for axis in (named, *others):
                axis.axvline(increment["index"] - 0.5, color="0.4", linewidth=0.8, linestyle="--")
            named.text(
                increment["index"] - 0.3,
                1.03,
                previous.replace("_", " "),
                transform=named.get_xaxis_transform(),
                fontsize=10,
            )
