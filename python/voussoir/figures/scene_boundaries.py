"""What the boundaries of a scene bear: against their own displacement, and over all stages.

Reactions are those of the support on the ground, as run.h5 has them. A moved boundary is shown in the direction in
which it goes, and its reaction in the direction in which it pushes the ground, so that both axes begin at zero.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from . import openings, scene
from .result import Increment, Missing, Result
from .scene import Motion, Stage
from .style import CYCLE, LINES, save

KILO = 1e-3


@dataclass
class Curve:
    """What a moved boundary bears, as the figures and the page of a report show it."""

    title: str
    xlabel: str
    ylabel: str
    x: list[np.ndarray]  # an array for each stage
    y: list[np.ndarray]


def push(result: Result, motion: Motion) -> float:
    """1 where the support at first pushes the ground to the right or upwards, -1 where it pushes the other way."""
    return scene.first_sign(scene.column(result.increments, f"reaction_{motion.name}_{motion.axis}"))


def reaction_curve(result: Result, motion: Motion, kind: str = "reaction") -> Curve:
    """Reaction [kN/m] or, with the kind "traction", traction [kPa] of a boundary over its displacement [mm]."""
    shown = scene.stages(result)
    name, axis = motion.name, motion.axis
    sign = push(result, motion)
    side = scene.TOWARDS[axis, sign > 0]
    unit = "kN/m" if kind == "reaction" else "kPa"
    return Curve(
        title=name,
        xlabel=f"displacement {motion.movement}  [mm]",
        ylabel=f"{kind} on the ground, {side}  [{unit}]",
        x=[displacement(motion, stage.increments) for stage in shown],
        y=[
            sign * KILO * held(stage, motion, scene.column(stage.increments, f"{kind}_{name}_{axis}"))
            for stage in shown
        ],
    )


def held(stage: Stage, motion: Motion, values: np.ndarray) -> np.ndarray:
    """Values of a boundary where it is held; NaN where nothing holds it, so that it has no reaction."""
    reactions = [scene.column(stage.increments, f"reaction_{motion.name}_{axis}") for axis in scene.AXES]
    return np.where(np.all(np.array(reactions) == 0, axis=0), np.nan, values)


def release_curve(result: Result, motion: Motion) -> Curve:
    """The share that is left of the forces which held a boundary, over its displacement or the change of its area."""
    moved = pressure_curve(result, motion) if motion.with_area else reaction_curve(result, motion)
    shares = [scene.released_share(stage, motion.name) for stage in scene.stages(result)]
    loads = [scene.column(stage.increments, "load_parameter") for stage in scene.stages(result)]
    left = [100 * (1 - share * load) if share else np.full_like(load, np.nan) for share, load in zip(shares, loads)]
    return Curve(motion.name, moved.xlabel, "left of the forces that held it  [%]", moved.x, left)


def displacement(motion: Motion, increments: Sequence[Increment]) -> np.ndarray:
    """Mean displacement of the boundary in the direction in which it goes [mm]."""
    return (1e3 if motion.forward else -1e3) * scene.column(increments, f"displacement_{motion.name}_{motion.axis}")


def pressure_curve(result: Result, motion: Motion) -> Curve:
    """The pressure of an opening [kPa] over the change of its area [%]."""
    shown = scene.stages(result)
    lost = scene.column(result.increments, f"area_{motion.name}")
    shrinks = bool(np.nansum(lost) >= 0)
    sign = 100.0 if shrinks else -100.0
    return Curve(
        title=motion.name,
        xlabel=f"area of the opening {'lost' if shrinks else 'gained'}  [%]",
        ylabel="pressure on the ground  [kPa]",
        x=[sign * scene.column(stage.increments, f"area_{motion.name}") for stage in shown],
        y=[KILO * held(stage, motion, openings.pressure(result, motion, stage.increments)) for stage in shown],
    )


def curves_of(result: Result, motion: Motion) -> list[Curve]:
    """The curves of one boundary: of an opening whose area is changed the pressure, of others reaction and traction."""
    if motion.with_area:
        found = [pressure_curve(result, motion)]
    else:
        found = [reaction_curve(result, motion)]
        if scene.has(result, f"traction_{motion.name}_{motion.axis}"):
            found.append(reaction_curve(result, motion, "traction"))
    if any(scene.released_share(stage, motion.name) for stage in scene.stages(result)):
        found.append(release_curve(result, motion))
    return [curve for curve in found if any(np.isfinite(y).any() for y in curve.y)]


def draw(result: Result, path: Path) -> None:
    """A column of panels for each boundary that a stage moves or releases."""
    found = scene.motions(result)
    shown = scene.stages(result)
    columns = [curves_of(result, motion) for motion in found]
    rows = max(len(curves) for curves in columns)
    figure, axes = plt.subplots(
        rows, len(found), figsize=(6.4 * len(found), 4.2 * rows + 0.3), squeeze=False, layout="constrained"
    )
    for curves, column in zip(columns, axes.T):
        for curve, axis in zip(curves, column):
            draw_curve(axis, curve, shown)
        for axis in column[len(curves) :]:
            axis.set_axis_off()
    for axis in axes.flat:
        if axis.get_legend_handles_labels()[1]:
            axis.legend(title="stage", fontsize=8.5)
    figure.suptitle("What the moved boundaries bear", fontsize=12)
    save(figure, path)


def draw_curve(axis: Axes, curve: Curve, shown: Sequence[Stage]) -> None:
    for stage, x, y in zip(shown, curve.x, curve.y):
        if not np.isfinite(y).any():
            continue
        dots = "o" if len(x) < 80 else ""
        axis.plot(x, y, stage.line, marker=dots, markersize=2.5, color=stage.colour, label=stage.title)
        unconverged = scene.column(stage.increments, "converged") == 0
        if unconverged.any():
            axis.plot(x[unconverged], y[unconverged], "x", color="C3", label="not converged")
    axis.axhline(0, color="0.4", linewidth=0.8)
    axis.set_title(curve.title)
    axis.set_xlabel(curve.xlabel)
    axis.set_ylabel(curve.ylabel)


def draw_reactions(result: Result, path: Path) -> None:
    """The reactions of all held boundaries over all stages: together they carry the loads."""
    names = scene.held_boundaries(result)
    if not names:
        raise Missing("no boundary of the scene has a reaction")
    shown = scene.stages(result)
    figure, axes = plt.subplots(1, 2, figsize=(13, 4.8), layout="constrained")
    for axis, component, direction in zip(axes, scene.AXES, ("to the right", "upwards")):
        for k, name in enumerate(names):
            for stage in shown:
                y = KILO * scene.column(stage.increments, f"reaction_{name}_{component}")
                label = name if stage is shown[0] else "_"
                style = {"color": CYCLE[k % len(CYCLE)], "linestyle": LINES[k // len(CYCLE) % len(LINES)]}
                axis.plot(scene.progress(stage), y, label=label, **style)
        scene.mark_stages(axis, shown)
        axis.axhline(0, color="0.4", linewidth=0.8)
        axis.set_ylabel(f"reaction on the ground, {direction}  [kN/m]")
    axes[0].legend(fontsize=9)
    figure.suptitle("Reactions of the supports", fontsize=12)
    save(figure, path)
