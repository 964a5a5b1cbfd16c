"""Yade beside this program: the drained biaxial test of Yade's own packing, and K0 of an oedometric compression."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from voussoir_plots.element_tests import Series, Test
from voussoir_plots.result import RunIndex
from voussoir_plots.style import CYCLE, save

from .program import ROOT, Program

DATA = ROOT / "tests/data/yade"
STRAIN = 0.1  # to which the test is driven
SEEDS = (1, 2, 3, 4)  # of the packings whose K0 stands beside Yade's
YADE_K0 = ((5, 0.59), (20, 0.44), (100, 0.32), (200, 0.30), (700, 0.29))  # vertical stress [kPa], K0: cases/column


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


def _k0(axis: Axes, program: Program) -> list[str]:
    """K0 of four packings, each alone in a column of its own."""
    stress, recorded = np.array(YADE_K0).T
    found: list[np.ndarray] = []
    for seed in SEEDS:
        settings = (f"packing.folder={program.folder / 'packings'}", "packing.grains=700", "packing.candidates=1")
        folder = program.run(f"column_{seed}", ROOT / "cases/column/case.toml", *settings, f"packing.seed={seed}")
        vertical, k0 = np.loadtxt(folder / "k0.csv", delimiter=",", skiprows=1, unpack=True)
        axis.plot(vertical / 1e3, k0, color=CYCLE[0], linewidth=1, label="" if found else "Voussoir, four packings")
        found.append(np.interp(np.log(1e3 * stress), np.log(vertical), k0))
    axis.plot(stress, recorded, "s", color=CYCLE[3], label="Yade 2023.02a, one packing")
    axis.set_xscale("log")
    axis.set_xlabel("vertical stress [kPa]")
    axis.set_ylabel("$K_0$ [-]")
    axis.legend()
    return [
        f"K0 at {s:g} kPa: Yade {y:.2f}, here {np.min(v):.3f} to {np.max(v):.3f}"
        for s, y, v in zip(stress, recorded, np.array(found).T)
    ]


def draw(program: Program, path: Path) -> list[str]:
    folder = program.run(
        "yade_biaxial",
        ROOT / "cases/biaxial/case.toml",
        f"packing.file={DATA / 'CPS_D_particles.csv'}",
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
