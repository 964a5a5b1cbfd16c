"""Scenes with grains against closed forms: a wall, a trapdoor, a footing, and the friction of their packing."""

from collections.abc import Callable
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from voussoir.figures.style import CYCLE, save
from voussoir.results import Result, numbers_of

from .log_axes import log_axis
from .program import ROOT, Program

Array = np.ndarray
HERE = Path(__file__).resolve().parent
P0, UNIT_WEIGHT = 1e3, 20e3  # pressure on what nothing holds [Pa], unit weight [N/m3]
HEIGHT = 2.0  # of the fills behind the wall and above the door [m]
LATERAL = (5, 10, 20, 40, 100, 200)  # stresses of the element tests [kPa]
SMOOTHED = 11  # increments of 0.05 % of strain, over which a friction is averaged
FOOTING_STRESS = 200e3  # lateral stress at which the packing's friction stands for the ground under the footing [Pa]
PSI = np.radians(20.0)  # dilatancy angle of the packing in these tests, 18 to 25 degrees


def stage(folder: Path, name: str) -> dict[str, Array]:
    """The numbers of a stage's increments, as columns."""
    return numbers_of(Result(folder).stage(name))


def peak_frictions(program: Program) -> Array:
    """Friction angles [rad] of the scenes' packing at the stresses LATERAL, means over 0.5 % of strain."""
    found = []
    for pressure in LATERAL:
        settings = [f"stage[0].press[{k}].pressure={pressure} kPa" for k in (0, 1)]
        folder = program.run(f"element_{pressure}", HERE / "element.toml", *settings)
        shear = stage(folder, "shear")
        angle = np.arcsin(shear["q_over_p_element"])  # q is half the difference of the principal stresses
        found.append(np.convolve(angle, np.ones(SMOOTHED) / SMOOTHED, "valid").max())
    return np.array(found)


def davis(phi: float, psi: float) -> float:
    """Angle of friction on a plane that shears without changing its length, where psi < phi [rad]."""
    share = np.cos(psi) * np.cos(phi) / (1 - np.sin(psi) * np.sin(phi))
    return float(np.arctan(share * np.tan(phi)))


def bearing_factor(phi: float) -> float:
    """N_q of Prandtl and Reissner."""
    return float(np.exp(np.pi * np.tan(phi)) * np.tan(np.pi / 4 + phi / 2) ** 2)


def rankine(lateral_frictions: Array, passive: bool) -> float:
    """Mean K of the wall with the friction at the smaller principal stress of each depth."""
    depth = np.linspace(0, HEIGHT, 401)
    vertical = P0 + UNIT_WEIGHT * depth
    k = np.full_like(vertical, 1.0 if passive else 0.15)
    for _ in range(50):
        smaller = vertical if passive else k * vertical
        phi = np.interp(np.log(smaller), np.log(1e3 * np.array(LATERAL)), lateral_frictions)
        k = np.tan(np.pi / 4 + (phi if passive else -phi) / 2) ** 2
    return float(np.trapezoid(k * vertical, depth) / np.trapezoid(vertical, depth))


def terzaghi(friction: float, lateral: float, unit_weight: float = UNIT_WEIGHT) -> float:
    """Load on the trapdoor over its first value between vertical planes that slide, with the coefficient `lateral`."""
    decay = 2 * lateral * np.tan(friction) * HEIGHT  # the door is 1 m wide
    weight = unit_weight * HEIGHT * (1 - np.exp(-decay)) / decay
    return float((weight + P0 * np.exp(-decay)) / (unit_weight * HEIGHT + P0))


def wedge(angle: float, unit_weight: float = UNIT_WEIGHT) -> float:
    """Weight on the trapdoor, over its first load, of the wedge whose sides leave the vertical by this angle [rad]."""
    return float(unit_weight / (4 * np.tan(angle)) / (unit_weight * HEIGHT + P0))


def _friction(axis: Axes, frictions: Array) -> list[str]:
    axis.plot(LATERAL, np.degrees(frictions), "o-", color=CYCLE[0])
    log_axis(axis, "x")
    axis.set_xlabel("lateral stress of the element test [kPa]")
    axis.set_ylabel("friction angle [deg], mean over 0.5 %")
    axis.set_title("the scenes' packing, made at 1 kPa")
    pairs = ", ".join(f"{d:.1f} at {s} kPa" for s, d in zip(LATERAL, np.degrees(frictions), strict=True))
    return [f"friction angles: {pairs}"]


def _wall(axis: Axes, program: Program, frictions: Array) -> list[str]:
    case, lines = ROOT / "cases/wall/case.toml", []
    settings = {"active": [], "passive": ["stage[1].move[0].x=24 cm", "stage[1].steps=96"]}
    for k, (name, more) in enumerate(settings.items()):
        moved = stage(program.run(f"wall_{name}", case, *more), "wall")
        strain = np.abs(moved["displacement_wall_x"]) / 4.0  # the fill is 4 m long
        mean_k = moved["reaction_wall_x"] / (UNIT_WEIGHT * HEIGHT**2 / 2 + P0 * HEIGHT)
        form = rankine(frictions, name == "passive")
        axis.plot(100 * strain, mean_k, color=CYCLE[k], label=name)
        axis.axhline(form, color=CYCLE[k], linestyle="--", linewidth=1)
        reached = mean_k.max() if name == "passive" else mean_k.min()
        lines.append(f"wall, {name}: K = {reached:.3f}, Rankine {form:.3f}")
    log_axis(axis, "y")
    axis.plot([], [], "--", color="black", linewidth=1, label="Rankine with the friction on the left")
    axis.set_xlabel("displacement of the wall over the fill's length [%]")
    axis.set_ylabel("mean K [-]")
    axis.set_title("smooth wall, 2 m")
    axis.legend()
    return lines


def _trapdoor(axis: Axes, program: Program, frictions: Array) -> list[str]:
    lowered = stage(program.run("trapdoor", ROOT / "cases/trapdoor/case.toml"), "lowering")
    load = lowered["traction_door_y"] / (UNIT_WEIGHT * HEIGHT + P0)
    axis.plot(-100 * lowered["displacement_door_y"], load, color=CYCLE[0])  # in % of the door's width of 1 m
    friction = float(np.interp(20, LATERAL, frictions))
    forms: list[tuple[str, float]] = [
        ("wedge with $\\varphi$", wedge(friction)),
        ("wedge with $\\psi$", wedge(PSI)),
        ("Terzaghi, K = 1", terzaghi(friction, 1.0)),
    ]
    for k, (name, value) in enumerate(forms, start=1):
        axis.axhline(value, color=CYCLE[k], linestyle="--", linewidth=1, label=name)
    axis.set_xlabel("displacement of the door over its width [%]")
    axis.set_ylabel("load on the door over its first value [-]")
    axis.set_ylim(0, 0.5)
    axis.set_title("trapdoor, H/B = 2")
    axis.legend()
    return [f"trapdoor: least load {load.min():.3f}; " + ", ".join(f"{n} {v:.3f}" for n, v in forms)]


def _footing(axis: Axes, program: Program, frictions: Array) -> list[str]:
    lines = []
    for k, (name, more) in enumerate({"smooth": [], "rough": ["stage[1].move[0].x=0 m"]}.items()):
        pushed = stage(program.run(f"footing_{name}", ROOT / "cases/footing/case.toml", *more), "load")
        factor = -pushed["traction_footing_y"] / (UNIT_WEIGHT / 2)  # B = 1 m
        axis.plot(-100 * pushed["displacement_footing_y"], factor, color=CYCLE[k], label=name)
        lines.append(f"footing, {name}: largest factor so far {factor.max():.1f}")
    friction = float(np.interp(FOOTING_STRESS / 1e3, LATERAL, frictions))
    n_q = [bearing_factor(phi) for phi in (davis(friction, PSI), friction)]
    axis.set_xlabel("settlement over the width B [%]")
    axis.set_ylabel("pressure over $\\gamma B/2$ [-]")
    axis.set_title("footing, B = 1 m")
    axis.legend()
    return [*lines, f"N_q from {n_q[0]:.0f} (Davis) to {n_q[1]:.0f}"]


def draw(program: Program, path: Path) -> list[str]:
    figure, axes = plt.subplots(2, 2, figsize=(10, 8))
    frictions = peak_frictions(program)
    panels: list[Callable[[Axes, Program, Array], list[str]]] = [_wall, _trapdoor, _footing]
    lines = _friction(axes.flat[0], frictions)
    for axis, panel in zip(axes.flat[1:], panels, strict=True):
        lines += panel(axis, program, frictions)
    figure.suptitle("scenes of dense coarse sand, 300 grains, against closed forms")
    figure.tight_layout()
    save(figure, path)
    return lines
