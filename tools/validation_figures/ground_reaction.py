"""The ground reaction curve of the trapdoor: eight draws of its packing beside closed forms and published findings."""

from dataclasses import dataclass
from pathlib import Path

import h5py
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from voussoir.figures.ensemble import Ensemble
from voussoir.figures.study.bands import of_members
from voussoir.figures.style import CYCLE, save

from .log_axes import log_axis
from .program import Program
from .scenes import HERE, PSI, SMOOTHED, davis, terzaghi, wedge

Array = np.ndarray
MEMBERS, MEDIUM_MEMBERS = 8, 4
MEDIUM = (  # medium dense sand, its weight, and half of the displacement
    "packing.consolidation_friction=0.45",
    "region[0].unit_weight=18 kN/m3",
    "stage[2].steps=30",
    "stage[2].move[0].y=-49 mm",
)
ELEMENT_STRESS = 20  # lateral stress at which the packings' friction is measured [kPa], that of half the depth
FIRST_SLOPE = 125.0  # of Iglesia's curve: fall of the load over its first value, over displacement over width
MCNULTY = (2e-4, 0.5)  # McNulty's abstract: so small a displacement may change the load by as much as 50 %
WIDTHS = (
    1e-4,
    2e-4,
    5e-4,
    1e-3,
    2e-3,
    5e-3,
    0.01,
    0.014,
    0.02,
    0.05,
    0.10,
)  # displacements over B whose loads are told


def frictions(program: Program) -> tuple[Array, Array]:
    """Friction angles [rad] of the members' packings in one element, at the peak and at 6 % of strain: means over 0.5 %
    of strain."""
    settings = [f"stage[0].press[{k}].pressure={ELEMENT_STRESS} kPa" for k in (0, 1)]
    ensemble = Ensemble(program.ensemble(f"element_{ELEMENT_STRESS}", HERE / "element.toml", MEMBERS, *settings))
    sheared = ensemble.curve("q_over_p_element").members[:, ensemble.stage == "shear"]
    angle = np.arcsin(sheared)  # q is half the difference of the principal stresses
    smoothed = np.array([np.convolve(one, np.ones(SMOOTHED) / SMOOTHED, "valid") for one in angle])
    return smoothed.max(axis=1), smoothed[:, -1]


@dataclass
class Members:
    """Displacement of the door over its width and load over its first value of each member, after the weight is on."""

    down: list[Array]
    load: list[Array]

    @property
    def common(self) -> int:
        """The number of increments that all members have."""
        return min(len(one) for one in self.load)

    def finished(self) -> "Members":
        """Those that came as far as any; the others found no equilibrium on the way."""
        last = max(map(len, self.load))
        whole = [k for k, one in enumerate(self.load) if len(one) == last]
        return Members([self.down[k] for k in whole], [self.load[k] for k in whole])

    def together(self) -> Array:
        """Loads of all members (member, increment) in the increments that all of them have."""
        return np.array([one[: self.common] for one in self.load])


def members(folder: Path) -> Members:
    """The members of an ensemble of the trapdoor, also of one that was stopped; the door is 1 m wide."""
    found = Members([], [])
    for run in sorted(folder.glob("member_*/run.h5")):
        with h5py.File(run) as file:
            rows = np.flatnonzero(file["table/stage"][()] != b"gravity")
            if len(rows) == 0:
                continue  # stopped before the door moved
            rows = np.concatenate([[rows[0] - 1], rows])
            down = -file["table/displacement_door_y"][()][rows]
            load = file["table/reaction_door_y"][()][rows]
        found.down.append(down - down[0])
        found.load.append(load / load[0])
    return found


def published(friction: float, late: float) -> list[tuple[str, float]]:
    """Closed forms of the load over its first value, with the friction at the peak and at large strain [rad].

    The last form has the friction on planes that shear without dilating any more, which is Davis' angle for psi = 0.
    """
    krynine = (1 - np.sin(friction) ** 2) / (1 + np.sin(friction) ** 2)
    return [
        (r"wedge with $\varphi$", wedge(friction)),
        (r"wedge with $\psi$", wedge(PSI)),
        ("Terzaghi, K = 1", terzaghi(friction, 1.0)),
        (f"Terzaghi, K = {krynine:.2f} (Krynine)", terzaghi(friction, krynine)),
        ("Terzaghi, K = 1, large strain", terzaghi(davis(late, 0.0), 1.0)),
    ]


def three_lines(friction: float) -> tuple[Array, Array]:
    """A ground reaction curve of straight lines: down to the wedge's weight, then up to Terzaghi's load at 10 %."""
    least = wedge(friction)
    return np.array([0, (1 - least) / FIRST_SLOPE, 0.1]), np.array([1, least, terzaghi(friction, 1.0)])


def _draw_members(axis: Axes, found: Members, medium: Members) -> None:
    bands, x = of_members(found.together()), 100 * found.down[0][: found.common]
    for half, colour, alpha, label in (
        (bands.prediction_half_width, CYCLE[1], 0.22, "95 % band of one further member"),
        (bands.mean_half_width, CYCLE[0], 0.35, "95 % band of the mean"),
    ):
        axis.fill_between(x, bands.mean - half, bands.mean + half, color=colour, alpha=alpha, linewidth=0, label=label)
    for k, (down, load) in enumerate(zip(found.down, found.load)):
        label = f"the {len(found.load)} members" if k == 0 else "_"
        axis.plot(100 * down, load, color="0.45", linewidth=0.7, label=label)
    axis.plot(x, bands.mean, color=CYCLE[0], linewidth=2.2, label=f"mean of {len(found.load)}, dense")
    axis.plot(
        100 * medium.down[0][: medium.common],
        medium.together().mean(axis=0),
        color="black",
        linewidth=1.3,
        label=f"mean of {len(medium.load)}, medium dense",
    )


def _draw_published(axis: Axes, forms: list[tuple[str, float]], friction: float) -> None:
    for k, (name, value) in enumerate(forms):
        axis.axhline(value, color=CYCLE[(2, 4, 3, 7, 5)[k]], linestyle="--", linewidth=1.2, label=name)
    down = np.concatenate([[0.0], np.logspace(-4, -1, 301)])  # close together: the lines are curved over a logarithm
    lines = np.interp(down, *three_lines(friction))
    axis.plot(100 * down, lines, "k:", linewidth=1.6, label="three lines, fall of 125 (from memory)")
    axis.plot(100 * MCNULTY[0], MCNULTY[1], "k^", markersize=7, label="McNulty, round doors: as low as this")
    axis.set_xlabel("displacement of the door over its width  [%]")
    axis.set_ylabel("load on the door over its first value  [-]")


def told(found: Members, forms: list[tuple[str, float]]) -> list[str]:
    """The numbers of the page."""
    loads, down = found.together(), 100 * found.down[0]
    least = np.array([one.min() for one in found.load])
    at = ", ".join(f"{100 * d[one.argmin()]:.2f}" for d, one in zip(found.down, found.load))
    lines = [
        f"all members reach {down[found.common - 1]:.2f} % of B",
        f"least load: {_listed(least, 3)}; {_mean(least, 3)}; at {at} % of B",
        f"least of the mean: {loads.mean(axis=0).min():.3f} at {down[loads.mean(axis=0).argmin()]:.2f} %",
    ]
    for width in WIDTHS:
        near = np.array([np.interp(width, d, one) for d, one in zip(found.down, found.load) if d[-1] > width - 1e-6])
        if len(near) > 1:
            lines.append(f"load at {100 * width:g} % of B: {_mean(near, 3)} of {len(near)}: {_listed(near, 3)}")
    return lines + [f"{name}: {value:.3f}" for name, value in forms]


def _listed(values: Array, digits: int) -> str:
    return ", ".join(f"{value:.{digits}f}" for value in values)


def _mean(values: Array, digits: int) -> str:
    return f"{values.mean():.{digits}f} +- {values.std(ddof=1):.{digits}f}"


def trapdoors(program: Program) -> Path:
    """The folder of the ensemble with dense sand."""
    return program.ensemble("trapdoor_8", HERE / "trapdoor.toml", MEMBERS)


def draw(program: Program, path: Path) -> list[str]:
    peak, late = frictions(program)
    forms = published(float(peak.mean()), float(late.mean()))
    found = members(trapdoors(program))
    medium = members(program.ensemble("trapdoor_md", HERE / "trapdoor.toml", MEDIUM_MEMBERS, *MEDIUM)).finished()
    figure, axes = plt.subplots(1, 2, figsize=(12, 5.8), layout="constrained")
    for axis in axes:
        _draw_members(axis, found, medium)
        _draw_published(axis, forms, float(peak.mean()))
    axes[0].set_xlim(0, 10)
    axes[0].set_ylim(0, 0.65)
    axes[0].set_title("to a tenth of the width")
    axes[1].set_xlim(0.01, 10)
    log_axis(axes[1], "x")
    axes[1].set_ylim(0, 1)
    axes[1].set_title("the first part")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, fontsize=9, ncols=4, loc="outside lower center")
    figure.suptitle("Trapdoor, H/B = 2, coarse sand: draws of the packing", fontsize=12)
    save(figure, path)
    angles = [
        f"friction {when}: {_listed(np.degrees(angle), 1)}; {_mean(np.degrees(angle), 1)} deg"
        for when, angle in (("at the peak", peak), ("at 6 % of strain", late))
    ]
    return angles + told(found, forms) + [f"medium dense: {line}" for line in told(medium, [])]
