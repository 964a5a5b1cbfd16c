"""Where the ground above the trapdoor shears, range by range of the door's displacement: means of the packings of dense
and of medium dense sand."""

from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from voussoir.figures import q8
from voussoir.figures.style import save
from voussoir.figures.tensors import deviatoric_strain
from voussoir.results import Result

from .ground_reaction import DENSE, MEDIUM, Sand, dilatancies, frictions, trapdoors
from .program import Program

Array = np.ndarray
WIDTH = 1.0  # of the door [m]
EDGES = (2.0, 3.0)  # x of the door's edges [m]
RANGES = ((0.0, 0.0043), (0.0043, 0.016), (0.016, 0.05), (0.05, 0.10))  # displacements over the width
HEIGHTS, UPPER = (0.15, 0.85), (1.0, 1.95)  # between which a band's inclination is measured [m]
OTHERS = [(power, heights) for power in (1.5, 2, 3, 4) for heights in (HEIGHTS, (0.1, 0.6), (0.2, 1.0))]


@dataclass
class Sheared:
    """Strain gained in a range, over the range of the displacement over the width: mean of the members."""

    first: float  # mean displacement over the width, from which
    last: float  # and to which
    rate: Array  # (element, 4) [-]


def gained(run: Result, first: float, last: float) -> tuple[float, float, Array]:
    """Displacements over the width nearest to these two, and the deviatoric strain gained between them."""
    increments = run.stage("first") + run.stage("lowering")
    down = np.array([-one["displacement_door_y"] / WIDTH for one in increments])
    begin, end = (int(np.argmin(np.abs(down - at))) for at in (first, last))
    strain = increments[end].field("gauss/strain")
    if first == 0:
        return 0.0, down[end], deviatoric_strain(strain)
    return down[begin], down[end], deviatoric_strain(strain - increments[begin].field("gauss/strain"))


def sheared(runs: list[Result]) -> list[Sheared]:
    """The strain gained in each of RANGES."""
    found = []
    for first, last in RANGES:
        members = [gained(run, first, last) for run in runs]
        begin, end = (float(np.mean([one[k] for one in members])) for k in (0, 1))
        rate = np.mean([strain / (to - since) for since, to, strain in members], axis=0)
        found.append(Sheared(begin, end, rate))
    return found


def inclinations(places: Array, rate: Array, heights: tuple[float, float] = HEIGHTS, power: float = 2) -> Array:
    """Angles from the vertical [deg] of the left and the right band, positive towards the door's middle.

    The band's place at a height is the mean x of one half of the ground there, weighted with this power of the rate, so
    that the band counts and not what is strained a little everywhere. A straight line goes through these places."""
    x, y, weight = places[..., 0].ravel(), places[..., 1].ravel(), rate.ravel() ** power
    middle, found = sum(EDGES) / 2, []
    rows = np.unique(np.round(y[(y > heights[0]) & (y < heights[1])], 6))
    for side in (-1, 1):
        at = []
        for row in rows:
            here = (np.abs(y - row) < 1e-5) & (side * (x - middle) > 0)
            at.append(np.average(x[here], weights=weight[here]))
        found.append(np.degrees(np.arctan(-side * np.polyfit(rows, at, 1)[0])))
    return np.array(found)


def _draw(axis: Axes, run: Result, one: Sheared, friction: float) -> PolyCollection:
    patches = q8.gauss_patches(run.coordinates, run.connectivity).reshape(-1, 4, 2)
    drawn = PolyCollection(list(patches), array=one.rate.ravel(), cmap="magma_r", edgecolors="face", linewidths=0.4)
    drawn.set_clim(0, np.quantile(one.rate, 0.985))
    axis.add_collection(drawn)
    rise = np.array([0.0, 0.5 * WIDTH / np.tan(np.pi / 4 - friction / 2)])
    names = ("triangle, 45° $-$ $\\varphi$/2 from the vertical", "prism above the door")
    for edge, side, (triangle, prism) in zip(EDGES, (1, -1), (names, ("_", "_"))):
        axis.plot(edge + side * np.array([0, WIDTH / 2]), rise, color="#0072b2", linewidth=1.2, label=triangle)
        axis.plot([edge, edge], [0, 2], color="#009e73", linestyle="--", linewidth=1.2, label=prism)
    axis.set_xlim(1, 4)
    axis.set_ylim(0, 2)
    axis.set_aspect("equal")
    axis.grid(False)
    axis.set_xlabel("$x$  [m]")
    axis.set_title(f"{100 * one.first:.2g} to {100 * one.last:.2g} % of the width")
    return drawn


def _finished(program: Program, sand: Sand) -> list[Result]:
    """The members that came as far as any."""
    runs = [Result(folder) for folder in sorted(trapdoors(program, sand).glob("member_*"))]
    last = max(len(run.increments) for run in runs)
    return [run for run in runs if len(run.increments) == last]


def _told(runs: list[Result], found: list[Sheared]) -> list[str]:
    """Inclinations of the bands; the first range has none yet."""
    places = runs[0].gauss_points
    members = [sheared([run]) for run in runs]
    lines = []
    for k, one in enumerate(found[1:], start=1):
        lean = np.array([inclinations(places, member[k].rate).mean() for member in members])
        upper = inclinations(places, one.rate, UPPER)
        others = [inclinations(places, one.rate, heights, power).mean() for power, heights in OTHERS]
        lines.append(
            f"{100 * one.first:.2f} to {100 * one.last:.2f} % of the width: bands lean {lean.mean():.0f} +- "
            f"{lean.std(ddof=1):.0f} deg to the middle ({lean.min():.0f} to {lean.max():.0f}); the mean of the members "
            f"{inclinations(places, one.rate).mean():.0f}, with other weights and heights {min(others):.0f} to "
            f"{max(others):.0f}, above {UPPER[0]:g} m {upper.mean():.0f}"
        )
    return lines


def draw(program: Program, path: Path) -> list[str]:
    figure, axes = plt.subplots(2, len(RANGES), figsize=(14, 7.2), layout="constrained", sharey=True)
    lines = []
    for row, sand in zip(axes, (DENSE, MEDIUM)):
        friction, dilatancy = frictions(program, sand)[0].mean(), np.degrees(dilatancies(program, sand))
        runs = _finished(program, sand)
        found = sheared(runs)
        for axis, one in zip(row, found):
            drawn = _draw(axis, runs[0], one, friction)
            figure.colorbar(drawn, ax=axis, orientation="horizontal", shrink=0.9, extend="max")
        row[0].set_ylabel(f"{sand.name}, mean of {len(runs)}:  $y$  [m]")
        lines.append(
            f"{sand.name}: 45 deg - phi/2 = {np.degrees(np.pi / 4 - friction / 2):.1f} deg; largest dilatancy "
            f"{dilatancy.mean():.1f} +- {dilatancy.std(ddof=1):.1f} deg"
        )
        lines += [f"{sand.name}: {line}" for line in _told(runs, found)]
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, fontsize=9, ncols=2, loc="outside lower center")
    figure.suptitle(r"Trapdoor: deviatoric strain $\varepsilon_q$ gained per displacement over the width", fontsize=12)
    save(figure, path)
    return lines
