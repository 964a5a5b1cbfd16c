"""The curves of a scene as the page's charts: what moved boundaries bear, recorded points and regions."""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from voussoir.figures import scene, scene_boundaries
from voussoir.figures.ensemble import Ensemble, boundary_bands, motions
from voussoir.figures.result import Increment, Missing, Result
from voussoir.figures.scene import Motion
from voussoir.figures.style import CYCLE

from .curves import BLUE, GREY, Chart, line
from .pack import numbers

ALONG = "stage and load parameter [-]"


def of_scene(result: Result, shown: Sequence[Increment]) -> list[Callable[[], Chart]]:
    """The charts of a scene; `shown` are the increments of the slider. Each function may raise Missing."""
    frames = {increment["index"]: k for k, increment in enumerate(shown)}
    made: list[Callable[[], Chart]] = []
    try:
        for motion in scene.motions(result):
            made += _of_boundary(result, motion, frames)
    except Missing:  # of a scene in which nothing is moved
        made.append(lambda: _reactions(result))
    for record in scene.records(result, "point"):
        made.append(partial(_point, result, str(record["name"])))
    for record in scene.records(result, "region"):
        made.append(partial(_region, result, str(record["name"])))
    return made


def _of_boundary(result: Result, motion: Motion, frames: dict[int, int]) -> list[Callable[[], Chart]]:
    """One chart: an opening's pressure, or the reaction of another boundary. Its dot follows the slider."""

    def chart() -> Chart:
        curve = scene_boundaries.curves_of(result, motion)[0]
        series = []
        for stage, x, y in zip(scene.stages(result), curve.x, curve.y):
            if not np.isfinite(y).any():
                continue
            along: np.ndarray = np.full((2, len(frames)), np.nan)
            for increment, here in zip(stage.increments, np.column_stack([x, y])):
                if increment["index"] in frames:
                    along[:, frames[increment["index"]]] = here
            series.append(line(stage.title, along[0], along[1], stage.colour, follows=True))
        title = f"Boundary {motion.name}"
        return {"title": title, "xlabel": plain(curve.xlabel), "ylabel": plain(curve.ylabel), "series": series}

    return [chart]


def of_ensemble(ensemble: Ensemble) -> list[Callable[[], Chart]]:
    """The reactions of the moved boundaries with bands."""

    def chart(motion: Motion) -> Chart:
        x, bands, sign = boundary_bands(ensemble, motion)
        single = [
            line("members", x, one, GREY, 1e-3 * sign, width=0.8, silent=k > 0) for k, one in enumerate(bands.members)
        ]
        mean = line("mean", x, bands.mean, BLUE, 1e-3 * sign)
        mean |= {"band": numbers(1e-3 * bands.mean_half_width), "further": numbers(1e-3 * bands.prediction_half_width)}
        return {
            "title": f"Boundary {motion.name}",
            "xlabel": f"displacement {motion.movement} [mm]",
            "ylabel": f"reaction {scene.TOWARDS[motion.axis, sign > 0]} [kN/m]",
            "series": [*single, mean],
        }

    try:
        return [partial(chart, motion) for motion in motions(ensemble)]
    except Missing:
        return []


def plain(label: str) -> str:
    """A label without the figure's signs, and short enough for a chart's height."""
    return label.replace("  [", " [").replace("$", "").replace(" on the ground,", "")


def _over_stages(result: Result, title: str, label: str, columns: dict[str, tuple[str, float]]) -> Chart:
    """Columns of the table of increments over all stages; {name: (column, factor)}."""
    x = np.concatenate([scene.progress(stage) for stage in scene.stages(result)])
    series = []
    for k, (name, (column, factor)) in enumerate(columns.items()):
        y = scene.column(result.increments, column)
        if np.isfinite(y).any():
            series.append(line(name, x, y, CYCLE[k % len(CYCLE)], factor))
    if not series:
        raise Missing(f"the table of increments has none of the columns of: {title}")
    return {"title": title, "xlabel": ALONG, "ylabel": label, "series": series, "marked": True, "zero": True}


def _reactions(result: Result) -> Chart:
    names = scene.held_boundaries(result)
    columns = {f"{name} {axis}": (f"reaction_{name}_{axis}", 1e-3) for name in names for axis in scene.AXES}
    there = {n: c for n, c in columns.items() if np.nanmax(np.abs(scene.column(result.increments, c[0]))) > 0}
    return _over_stages(result, "Reactions of the supports on the ground", "reaction [kN/m]", there)


def _point(result: Result, name: str) -> Chart:
    moved = {f"u_{axis}": (f"displacement_{name}_{axis}", 1e3) for axis in scene.AXES}
    return _over_stages(result, f"Point {name}", "displacement [mm]", moved)


def _region(result: Result, name: str) -> Chart:
    shown = {
        "q/p [-]": (f"q_over_p_{name}", 1.0),
        "ε_v, contraction positive [%]": (f"volumetric_strain_{name}", 100.0),
    }
    return _over_stages(result, f"Region of the record {name}", "q/p [-], ε_v [%]", shown)
