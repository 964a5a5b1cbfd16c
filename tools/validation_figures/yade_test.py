"""Yade beside this program: the drained biaxial test of Yade's own packing, and K0 of an oedometric compression."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from voussoir.figures.element_tests import Series, Test
from voussoir.figures.result import RunIndex
from voussoir.figures.style import CYCLE, save

from .log_axes import log_axis
from .program import ROOT, Program

DATA = ROOT / "tests/data/yade"
PARTICLES = DATA / "CPS_D_particles.csv"  # made at 100 kPa
STRAIN = 0.1  # to which the test is driven
SEEDS = (1, 2, 3, 4)  # of the packings made at 1 kPa
# Vertical stress [kPa] and K0 of Yade's packing, unloaded from 100 kPa to 1 kPa: docs/validation/yade.md.
YADE_K0 = ((5, 0.59), (20, 0.44), (100, 0.32), (200, 0.30), (700, 0.29))


def _reference() -> np.ndarray:
    """Yade's rows: axial logarithmic strain, q/p and volumetric strain, contraction positive."""
    rows = np.genfromtxt(DATA / "CPS_D_biaxial_100kPa.csv", delimiter=",", names=True)
    return np.column_stack([rows["eps_a_log"], rows["q_over_p"], rows["eps_v_compression_pos_log"]])


def _differences(reference: np.ndarray, test: Test) -> list[str]:
    peak = int(np.argmax(reference[:, 1]))
    rows = reference[1 : peak + 1]
    ratio = test.at(rows[:, 0], "q_over_p") - rows[:, 1]
    volume = test.at(rows[:, 0], "volumetric_strain") - rows[:, 2]
    ours = np.max(test.curve["q"] / test.curve["p"])
    angles = [np.degrees(np.arcsin(value)) for value in (reference[peak, 1], ours)]
    after = reference[(reference[:, 0] > reference[peak, 0]) & (reference[:, 0] < test.curve["axial_strain"][-1])]
    late = test.at(after[:, 0], "q_over_p") - after[:, 1]
    beyond = np.sqrt(np.mean(late**2))
    before = f"q/p within {np.max(np.abs(ratio)):.4f}, volumetric strain within {np.max(np.abs(volume)):.2e}"
    return [
        f"up to the peak at {100 * reference[peak, 0]:.2f} %: {before}",
        f"peak angle {angles[0]:.2f} degrees in Yade, {angles[1]:.2f} here",
        f"from the peak to {100 * STRAIN:g} %: root mean square of the difference of q/p {beyond:.3f}",
    ]


def _panel(axis: Axes, reference: np.ndarray, test: Test, column: int, name: str, factor: float, label: str) -> None:
    shown = reference[reference[:, 0] <= STRAIN]
    axis.plot(100 * test.curve["axial_strain"], factor * _values(test, name), color=CYCLE[0], label="Voussoir")
    axis.plot(100 * shown[:, 0], factor * shown[:, column], "--", color=CYCLE[3], label="Yade 2023.02a")
    axis.axvspan(0, 100 * reference[np.argmax(reference[:, 1]), 0], color="0.92", label="compared by a test")
    axis.set_xlabel("axial strain [%]")
    axis.set_ylabel(label)
    axis.set_xlim(0, 100 * STRAIN)
    axis.legend(loc="lower right")


def _values(test: Test, name: str) -> np.ndarray:
    return test.curve["q"] / test.curve["p"] if name == "q_over_p" else test.curve[name]


def _column(program: Program, name: str, *settings: str) -> np.ndarray:
    """Vertical stress [Pa] and K0 of one packing, alone in a column of its own."""
    folder = program.run(f"column_{name}", ROOT / "cases/column/case.toml", *settings)
    return np.loadtxt(folder / "k0.csv", delimiter=",", skiprows=1, unpack=True)


def _k0(axis: Axes, program: Program) -> list[str]:
    """K0 of Yade's packing in both codes, and of four packings that were made at 1 kPa."""
    stress, recorded = np.array(YADE_K0).T
    unloaded = _column(program, "unloaded", f"packing.file={PARTICLES}")
    recipe = (f"packing.folder={program.folder / 'packings'}", "packing.grains=700", "packing.candidates=1")
    made = [_column(program, str(seed), *recipe, f"packing.seed={seed}") for seed in SEEDS]
    for index, (vertical, k0) in enumerate(made):
        label = "" if index > 0 else "Voussoir, four packings made at 1 kPa"
        axis.plot(vertical / 1e3, k0, color=CYCLE[0], linewidth=1, label=label)
    axis.plot(unloaded[0] / 1e3, unloaded[1], "--", color=CYCLE[1], label="Voussoir, Yade's packing")
    axis.plot(stress, recorded, "s", color=CYCLE[3], label="Yade 2023.02a, Yade's packing")
    log_axis(axis, "x")
    axis.set_xlabel("vertical stress [kPa]")
    axis.set_ylabel("$K_0$ [-]")
    axis.legend()
    at = [np.interp(np.log(1e3 * stress), np.log(vertical), k0) for vertical, k0 in (unloaded, *made)]
    return [
        f"K0 at {s:g} kPa: Yade {y:.2f}, the same packing here {v[0]:.3f}, packings made at 1 kPa {v[1:].min():.3f} "
        f"to {v[1:].max():.3f}"
        for s, y, v in zip(stress, recorded, np.array(at).T)
    ]


def draw(program: Program, path: Path) -> list[str]:
    folder = program.run(
        "yade_biaxial",
        ROOT / "cases/biaxial/case.toml",
        f"packing.file={PARTICLES}",
        "packing.seeds=[]",
        'biaxial.pressures=["100 kPa"]',
        f"biaxial.strain={STRAIN}",
    )
    test = Series(RunIndex(folder)).tests[0]
    reference = _reference()
    figure, axes = plt.subplots(1, 3, figsize=(13.5, 4.2))
    _panel(axes[0], reference, test, 1, "q_over_p", 1, "$q/p$ [-]")
    _panel(axes[1], reference, test, 2, "volumetric_strain", 100, "contraction (volumetric strain) [%]")
    axes[1].legend(loc="upper right")
    k0 = _k0(axes[2], program)
    figure.suptitle("Drained biaxial test of Yade's packing of 700 grains at 100 kPa (left, middle), and $K_0$ (right)")
    figure.tight_layout()
    save(figure, path)
    return _differences(reference, test) + k0
