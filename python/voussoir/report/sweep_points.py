"""The points of a sweep for its page: means of results with bands, and curves that can lie over one another."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from voussoir.ensembles import Bands
from voussoir.figures import reaction, scene, scene_boundaries, settlements, troughs
from voussoir.figures.element_tests import Series
from voussoir.figures.result import Missing, Result, RunIndex
from voussoir.figures.settings import Settings
from voussoir.figures.study.bands import number, of_members
from voussoir.figures.study.data import Tunnel, equally_far
from voussoir.sweeps import Run, SweepTable

from .pack import numbers

LOSSES = (0.02, 0.05, 0.1, 0.15, 0.2)  # V_l of the troughs that the page offers [-]
STRAINS = 81  # places of a biaxial test's curve
Curves = dict[str, list[dict[str, Any]]]  # by the chart's key: x, y, band, and a note where a point has several

CHARTS = {  # key: title, label of x, label of y, further settings for charts.js
    "settlement": (
        "Settlement of the surface above the crown",
        "volume loss V_l [%]",
        "settlement S [mm]",
        {"zero": True},
    ),
    "reaction": ("Ground reaction", "volume loss V_l [%]", "σ_v / σ_v,0 above the crown [-]", {"zero": True}),
    **{
        f"trough {100 * loss:g}": (
            f"Surface trough at V_l = {100 * loss:g} %",
            "distance from the tunnel's axis x [m]",
            "settlement S [mm]",
            {"zero": True, "down": True},
        )
        for loss in LOSSES
    },
    "ratio": ("Stress ratio", "axial strain [%]", "q/p [-]", {"zero": True, "xzero": True}),
    "volume": ("Volumetric strain", "axial strain [%]", "ε_v, contraction positive [%]", {"xzero": True}),
}


class Point:
    """One point of a sweep: the members of an ensemble, or a single run."""

    def __init__(self, table: SweepTable, name: str, runs: list[Run], settings: Settings) -> None:
        self.name, self.runs, self.settings = name, runs, settings
        self.root: Path = table.folder
        self.folder = table.folder / name
        self.kind, self.grid = runs[0].kind, runs[0].grid
        self.faults: list[Missing] = []
        self.charts: dict[str, tuple] = {}  # of a scene's boundaries, as CHARTS

    def axes(self) -> dict[str, str]:
        """The axes of the point: those whose value all of its members share."""
        first = self.runs[0].axes
        return {name: value for name, value in first.items() if all(r.axes.get(name) == value for r in self.runs)}

    def results(self) -> dict[str, list[float | None]]:
        """[mean, half width of the 95 % band of the mean, members] of each result, over the runs that ended well."""
        good = [run for run in self.runs if not run.failed]
        told = {}
        for name in dict.fromkeys(name for run in good for name in run.results):
            found = number([run.results.get(name, np.nan) for run in good])
            if found.count:
                told[name] = numbers(np.array([found.mean, found.half_width, found.count]))
        return told

    def members(self) -> list[Result]:
        """The results of the point's runs on a mesh, of tunnels those that have come as far in their volume loss as the
        farthest; the faults keep the reasons of the others."""
        found = []
        for run in self.runs:
            try:
                result = Result(self.root / run.name, self.settings)
                if self.kind == "tunnel":
                    _ = result.loss_increments  # raises where there is no volume loss
                found.append(result)
            except Missing as reason:
                self.faults.append(reason)
        return equally_far(found, self.faults) if self.kind == "tunnel" else found

    def curves(self, members: list[Result]) -> Curves:
        """All curves that the point's data allow."""
        found: Curves = {}
        try:
            if self.kind == "tunnel" and members:
                _of_tunnel(found, Tunnel(self.name, members))
            elif self.kind == "biaxial":
                for run in self.runs:
                    _of_tests(found, Series(RunIndex(self.root / run.name)))
            elif self.kind == "scene" and members:
                _of_scenes(found, members, self.charts)
            elif self.kind == "biaxial_bvp" and members:
                _of_specimens(found, members)
        except Missing as reason:
            self.faults.append(reason)
        return found


def charts_of_scenes(points: Sequence[Point]) -> dict[str, tuple]:
    """The charts of all boundaries of scenes, by their keys."""
    return {key: chart for point in points for key, chart in point.charts.items()}


def _of_scenes(found: Curves, members: list[Result], charts: dict[str, tuple]) -> None:
    """What each moved boundary bears, in the stages that move it; of several members the first one's alone where their
    increments differ in number."""
    for k, motion in enumerate(scene.motions(members[0])):
        each = [scene_boundaries.curves_of(m, scene.motions(m)[k])[0] for m in members]
        joined = [(np.concatenate(curve.x), np.concatenate(curve.y)) for curve in each]
        alike = [pair for pair in joined if len(pair[0]) == len(joined[0][0])]
        key = f"boundary {motion.name}"
        x = np.where(np.isfinite(joined[0][1]), joined[0][0], np.nan)
        found[key] = [_curve(x, of_members([y for _, y in alike]))]
        xlabel, ylabel = (label.replace("  [", " [") for label in (each[0].xlabel, each[0].ylabel))
        charts[key] = (f"Boundary {motion.name}", xlabel, ylabel.replace(" on the ground,", ""), {"zero": True})


def _curve(x: np.ndarray, bands: Bands, factor: float = 1.0, note: str = "") -> dict[str, Any]:
    told: dict[str, Any] = {"x": numbers(x, 4), "y": numbers(factor * bands.mean, 4), "note": note}
    # Student's band of two members is nine times their deviation, and would hide all other curves.
    if np.isfinite(bands.mean_half_width).any() and len(bands.members) > 2:
        told["band"] = numbers(factor * bands.mean_half_width, 3)
    return told


def _of_tunnel(found: Curves, tunnel: Tunnel) -> None:
    loss = tunnel.loss
    found["settlement"] = [_curve(100 * loss, tunnel.over_loss(lambda r: settlements.on_axis(r, 0.0)), 1e3)]
    found["reaction"] = [_curve(100 * loss, tunnel.over_loss(lambda r: reaction.curve(r)[1]))]
    for wanted in LOSSES:
        if loss[-1] < wanted - 1e-9:
            continue
        at = tunnel.nearest(wanted)
        lines = [troughs.line_at(member, 0.0) for member in tunnel.members]
        values = [line.settlement(member.next_to(at)) for line, member in zip(lines, tunnel.members)]
        if len({len(value) for value in values}) > 1:
            raise Missing(f"the members of {tunnel.name} have different meshes")
        found[f"trough {100 * wanted:g}"] = [_curve(lines[0].x, of_members(values), 1e3)]


def _of_tests(found: Curves, series: Series) -> None:
    """Means over the packings of a run, a curve for each pressure."""
    strain = np.linspace(0, series.strain_grid()[-1], STRAINS)
    for pressure in series.pressures:
        tests = series.of_pressure(pressure)
        if not tests:
            continue
        note = f"{pressure / 1e3:g} kPa"
        for key, name, factor in (("ratio", "q_over_p", 1.0), ("volume", "volumetric_strain", 100.0)):
            bands = of_members([test.at(strain, name) for test in tests])
            found.setdefault(key, []).append(_curve(100 * strain, bands, factor, note))


def _of_specimens(found: Curves, members: list[Result]) -> None:
    for key, name, factor in (("ratio", "q_over_p", 1.0), ("volume", "volumetric_strain", 100.0)):
        each = [result.stage("biaxial_bvp") for result in members]
        count = min(len(increments) for increments in each)
        axial = np.array([i["axial_strain"] for i in each[0][:count]], dtype=float)
        values = [[float(i[name]) for i in increments[:count]] for increments in each]
        found[key] = [_curve(100 * axial, of_members(values), factor)]
