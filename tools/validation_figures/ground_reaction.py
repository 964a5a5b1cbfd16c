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
ELEMENT_STRESS = 20  # lateral stress at which the packings' friction is measured [kPa], that of half the depth
FIRST_SLOPE = 125.0  # of Iglesia's curve: fall of the load over its first value, over displacement over width
MCNULTY = (2e-4, 0.5)  # McNulty's abstract: so small a displacement may change the load by as much as 50 %
LEVEL = 0.085  # displacement over B from which the level at the end is told
WIDTHS = (1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05, 0.10)  # displacements over B whose loads are told


@dataclass(frozen=True)
class Sand:
    name: str
    suffix: str  # of its runs
    members: int
    unit_weight: float  # [N/m3]
    packing: tuple[str, ...] = ()  # settings beside those of dense sand


DENSE = Sand("dense", "_8", 8, 20e3)
MEDIUM = Sand("medium dense", "_md", 4, 18e3, ("packing.consolidation_friction=0.45",))


def trapdoors(program: Program, sand: Sand) -> Path:
    """The folder of the ensemble."""
    weight = f"region[0].unit_weight={sand.unit_weight / 1e3:g} kN/m3"
    return program.ensemble(f"trapdoor{sand.suffix}", HERE / "trapdoor.toml", sand.members, weight, *sand.packing)


def _sheared(program: Program, sand: Sand) -> tuple[Ensemble, Array]:
    """One element of each member's packing, which is compressed to 6 % of strain; the increments of the shearing."""
    pressures = [f"stage[0].press[{k}].pressure={ELEMENT_STRESS} kPa" for k in (0, 1)]
    name = f"element_{ELEMENT_STRESS}{sand.suffix}"
    ensemble = Ensemble(program.ensemble(name, HERE / "element.toml", sand.members, *pressures, *sand.packing))
    return ensemble, np.flatnonzero(ensemble.stage == "shear")


def frictions(program: Program, sand: Sand) -> tuple[Array, Array]:
    """Friction angles [rad] of the members' packings in one element, at the peak and at 6 % of strain: means over 0.5 %
    of strain."""
    ensemble, rows = _sheared(program, sand)
    angle = np.arcsin(ensemble.curve("q_over_p_element").members[:, rows])  # q: half of the stresses' difference
    smoothed = np.array([np.convolve(one, np.ones(SMOOTHED) / SMOOTHED, "valid") for one in angle])
    return smoothed.max(axis=1), smoothed[:, -1]


def dilatancies(program: Program, sand: Sand) -> Array:
    """Largest angles of dilatancy [rad] of the members' packings in one element, over 0.5 % of strain: the sine is the
    gain of volume over the gain of deviatoric strain. The element is 1 m high."""
    ensemble, rows = _sheared(program, sand)
    volume = -ensemble.curve("volumetric_strain_element").members[:, rows]
    along = ensemble.curve("displacement_top_y").members[:, rows]
    steps = SMOOTHED - 1
    gains = [one[:, steps:] - one[:, :-steps] for one in (volume, volume - 2 * along)]
    return np.asarray(np.arcsin((gains[0] / gains[1]).max(axis=1)))


@dataclass
class Members:
    """Displacement of the door over its width and load over its first value of each member, after the weight is on."""

    down: list[Array]
    load: list[Array]
    cuts: list[int]  # steps that were cut
    pulled: list[int]  # most nodes that pulled the ground

    def together(self) -> Array:
        """Loads of all members (member, increment)."""
        return np.array(self.load)


def members(folder: Path) -> Members:
    """The members of an ensemble of the trapdoor that came as far as any: others found no equilibrium on the way, or
    were stopped. The door is 1 m wide."""
    runs = []
    for path in sorted(folder.glob("member_*/run.h5")):
        with h5py.File(path) as file:
            runs.append({name: values[()] for name, values in file["table"].items()})
    last = max(len(run["stage"]) for run in runs)
    found = Members([], [], [], [])
    for run in runs:
        if len(run["stage"]) < last:
            continue
        first = np.flatnonzero(run["stage"] != b"gravity")[0] - 1
        down, load = -run["displacement_door_y"][first:], run["reaction_door_y"][first:]
        found.down.append(down - down[0])
        found.load.append(load / load[0])
        found.cuts.append(int(run["cuts"].sum()))
        found.pulled.append(int(run["tensile_nodes"].max()))
    return found


def published(peak: float, late: float, sand: Sand) -> list[tuple[str, float]]:
    """Closed forms of the load over its first value, with the friction at the peak and at large strain [rad].

    The last form has the friction on vertical planes that shear without dilating any more. Where the axes of stress and
    strain coincide, the principal stresses lie at 45 degrees to such planes, so that the horizontal stress is the
    vertical one (K = 1) and the friction on them is sin(phi), Davis' angle for psi = 0."""
    krynine = (1 - np.sin(peak) ** 2) / (1 + np.sin(peak) ** 2)
    weight = sand.unit_weight
    return [
        (r"wedge with $\varphi$", wedge(peak, weight)),
        (r"wedge with $\psi$", wedge(PSI, weight)),
        ("Terzaghi, K = 1", terzaghi(peak, 1.0, weight)),
        (f"Terzaghi, K = {krynine:.2f} (Krynine)", terzaghi(peak, krynine, weight)),
        ("Terzaghi, K = 1, large strain", terzaghi(davis(late, 0.0), 1.0, weight)),
    ]


def three_lines(friction: float) -> tuple[Array, Array]:
    """A ground reaction curve of straight lines: down to the wedge's weight, then up to Terzaghi's load at 10 %."""
    least = wedge(friction)
    return np.array([0, (1 - least) / FIRST_SLOPE, 0.1]), np.array([1, least, terzaghi(friction, 1.0)])


def _draw_members(axis: Axes, found: Members, medium: Members) -> None:
    bands, x = of_members(found.together()), 100 * found.down[0]
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
        100 * medium.down[0],
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


def _told(found: Members, peak: Array, forms: list[tuple[str, float]]) -> list[str]:
    """The numbers of the page. @param peak friction angles of all packings [rad]"""
    loads, down = found.together(), found.down[0]
    least = np.array([one.min() for one in found.load])
    at = ", ".join(f"{100 * d[one.argmin()]:.2f}" for d, one in zip(found.down, found.load))
    lines = [
        f"{len(found.load)} members reach {100 * down[-1]:.2f} % of B",
        f"steps that were cut: {found.cuts}; nodes that pulled: {found.pulled}",
        f"least load: {_listed(least, 3)}; {_mean(least, 3)}; at {at} % of B",
        f"least of the mean: {loads.mean(axis=0).min():.3f} at {100 * down[loads.mean(axis=0).argmin()]:.2f} %",
    ]
    if len(least) == len(peak):
        wedges = np.array([wedge(angle) for angle in peak])
        lines.append(
            f"wedges: {_mean(wedges, 3)}; correlation with the least load {np.corrcoef(wedges, least)[0, 1]:.2f}"
        )
    for width in WIDTHS:
        near = np.array([np.interp(width, d, one) for d, one in zip(found.down, found.load)])
        lines.append(f"load at {100 * width:g} % of B: {_mean(near, 3)}: {_listed(near, 3)}")
    level = loads.mean(axis=0)[down > LEVEL - 1e-6]
    if len(level):
        lines.append(f"mean load from {100 * LEVEL:g} % of B on: {level.min():.3f} to {level.max():.3f}")
    return lines + [f"{name}: {value:.3f}" for name, value in forms]


def _listed(values: Array, digits: int) -> str:
    return ", ".join(f"{value:.{digits}f}" for value in values)


def _mean(values: Array, digits: int) -> str:
    return f"{values.mean():.{digits}f} +- {values.std(ddof=1):.{digits}f}"


def draw(program: Program, path: Path) -> list[str]:
    found, lines, forms, angles = {}, [], {}, {}
    for sand in (DENSE, MEDIUM):
        peak, late = frictions(program, sand)
        found[sand], angles[sand] = members(trapdoors(program, sand)), float(peak.mean())
        forms[sand] = published(angles[sand], float(late.mean()), sand)
        lines += [
            f"{sand.name}: friction {when}: {_listed(np.degrees(angle), 1)}; {_mean(np.degrees(angle), 1)} deg"
            for when, angle in (("at the peak", peak), ("at 6 % of strain", late))
        ]
        lines += [f"{sand.name}: {line}" for line in _told(found[sand], peak, forms[sand])]
    figure, axes = plt.subplots(1, 2, figsize=(12, 5.8), layout="constrained")
    for axis in axes:
        _draw_members(axis, found[DENSE], found[MEDIUM])
        _draw_published(axis, forms[DENSE], angles[DENSE])
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
    return lines
