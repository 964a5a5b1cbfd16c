"""The records of a scene over its stages: displacements and stresses of points, means over regions."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from . import scene
from .result import Missing, Result
from .style import save


def draw_points(result: Result, path: Path) -> None:
    """A row for each point: displacement and stress, over the load parameters of all stages."""
    names = [str(record["name"]) for record in scene.records(result, "point")]
    names = [name for name in names if scene.has(result, f"stress_{name}_xx")]
    if not names:
        raise Missing("the scene has no record of a point")
    figure, axes = plt.subplots(len(names), 2, figsize=(13, 4.2 * len(names)), squeeze=False, layout="constrained")
    for name, (moved, stress) in zip(names, axes):
        for axis, label, colour in (("x", "to the right", "C1"), ("y", "upwards", "C0")):
            _over_stages(moved, result, f"displacement_{name}_{axis}", 1e3, label, colour)
        moved.set_ylabel("displacement  [mm]")
        for part, sign, colour in (("xx", -1, "C1"), ("yy", -1, "C0"), ("xy", 1, "C2")):
            symbol = r"\tau" if part == "xy" else r"\sigma"
            _over_stages(stress, result, f"stress_{name}_{part}", sign * 1e-3, rf"${symbol}_{{{part}}}$", colour)
        stress.set_ylabel("stress of the nearest Gauss point,\ncompression positive  [kPa]")
        for axis in (moved, stress):
            _finish(axis, result)
            axis.set_title(f"point {name}", pad=22)
    save(figure, path)


def draw_regions(result: Result, path: Path) -> None:
    """A row for each region: stress ratio, mean stress and volumetric strain over the load parameters of all stages."""
    names = [str(record["name"]) for record in scene.records(result, "region")]
    names = [name for name in names if scene.has(result, f"q_over_p_{name}")]
    if not names:
        raise Missing("the scene has no record of a region")
    figure, axes = plt.subplots(len(names), 3, figsize=(16, 4.2 * len(names)), squeeze=False, layout="constrained")
    for name, row in zip(names, axes):
        shown = (
            ("q_over_p", 1.0, "stress ratio of the mean stress  $q / p$  [-]"),
            ("p", 1e-3, "mean stress  $p$  [kPa]"),
            ("volumetric_strain", 100.0, "volumetric strain,\ncontraction positive  [%]"),
        )
        for axis, (part, factor, label) in zip(row, shown):
            _over_stages(axis, result, f"{part}_{name}", factor, "", "C0")
            axis.set_ylabel(label)
            _finish(axis, result)
            axis.set_title(f"region of the record {name}", pad=22)
    save(figure, path)


def _over_stages(axis: Axes, result: Result, name: str, factor: float, label: str, colour: str) -> None:
    for stage in scene.stages(result):
        y = factor * scene.column(stage.increments, name)
        if np.isfinite(y).any():
            axis.plot(scene.progress(stage), y, color=colour, label=label if stage.number == 0 and label else "_")


def _finish(axis: Axes, result: Result) -> None:
    scene.mark_stages(axis, scene.stages(result))
    axis.axhline(0, color="0.4", linewidth=0.8)
    if axis.get_legend_handles_labels()[1]:
        axis.legend()
