"""The boundary curves of all scenes of a sweep over one another."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from ..sweeps import Member
from . import scene_boundaries
from .result import Missing, Result
from .scene import motions, stages
from .scene_boundaries import Curve
from .style import CYCLE, LINES, colours, save
from .sweep import Sweep

MANY = len(CYCLE)  # more runs than these have the colours of a sequence


def draw(sweep: Sweep, path: Path) -> None:
    """A panel for each boundary; a colour for each run."""
    panels: dict[str, list[tuple[str, Result, Curve]]] = {}
    reasons = []
    for member in sweep.of_kind("scene"):
        try:
            result = Result(member.folder, sweep.settings)
            for motion in motions(result):
                curve = scene_boundaries.curves_of(result, motion)[0]
                panels.setdefault(f"{motion.name}: {curve.xlabel}", []).append((_name(member), result, curve))
        except (Missing, IndexError) as reason:
            reasons.append(f"{member.name}: {reason}")
    if not panels:
        raise Missing(f"no scene of the sweep has boundary curves ({'; '.join(reasons)})")
    names = list(dict.fromkeys(name for runs in panels.values() for name, _, _ in runs))
    shades = list(CYCLE) if len(names) <= MANY else list(colours("viridis", len(names)))
    styles = {name: (shades[k], LINES[k % len(LINES)]) for k, name in enumerate(names)}
    figure, axes = plt.subplots(1, len(panels), figsize=(7.4 * len(panels), 5), squeeze=False, layout="constrained")
    for axis, runs in zip(axes.flat, panels.values()):
        for name, result, curve in runs:
            _add(axis, result, curve, name, styles[name])
        axis.axhline(0, color="0.4", linewidth=0.8)
        axis.set_title(curve.title)
        axis.set_xlabel(curve.xlabel)
        axis.set_ylabel(curve.ylabel)
    figure.legend(*axes.flat[0].get_legend_handles_labels(), loc="outside right upper", fontsize=8.5)
    save(figure, path)


def _name(member: Member) -> str:
    """The values of the run's axes, else its folder; a member of an ensemble with its number."""
    axes = ", ".join(f"{name} = {value}" for name, value in member.axes.items())
    last = member.name.rsplit("/", 1)[-1]
    return (f"{axes}, {last}" if last.startswith("member_") else axes) if axes else member.name


def _add(axis: Axes, result: Result, curve: Curve, name: str, style: tuple) -> None:
    """The stages in which the boundary moves; those before rest at one place."""
    label = name
    for _, x, y in zip(stages(result), curve.x, curve.y):
        there = np.isfinite(x) & np.isfinite(y)
        if there.any() and np.ptp(x[there]) > 0:
            axis.plot(x[there], y[there], style[1], color=style[0], label=label)
            label = "_"
