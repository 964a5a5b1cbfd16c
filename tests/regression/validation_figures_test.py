"""The pictures of docs/validation: a lattice of discs gives its closed form through the whole program, the error budget
can be drawn, and what is missing is said in one line."""

import os
import subprocess
import sys
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(os.environ["VOUSSOIR_ROOT"]) / "tools"))
sys.path.insert(0, str(Path(os.environ["VOUSSOIR_ROOT"]) / "python"))

import matplotlib.pyplot as plt
import numpy as np
from validation_figures import budget, lattice, scenes, trapdoor_bands
from validation_figures.log_axes import log_axis
from validation_figures.program import Program

ROOT = Path(os.environ["VOUSSOIR_ROOT"])
PROGRAM = Path(os.environ["VOUSSOIR"])


def call(*words):
    command = [
        sys.executable,
        str(ROOT / "tools/validation_figures"),
        *map(str, words),
        "--runs",
        "runs",
        "-o",
        "pictures",
    ]
    return subprocess.run(command, check=False, capture_output=True, text=True, timeout=120)


class Lattice(unittest.TestCase):
    def test_the_program_gives_the_closed_form(self):
        lines = lattice.draw(Program(PROGRAM, Path("lattice_runs")), Path("lattice.png"))
        self.assertEqual(len(lines), len(lattice.RATIOS))
        self.assertTrue(Path("lattice.png").stat().st_size > 0)
        for ratio in lattice.RATIOS:
            found = lattice.answer(Path(f"lattice_runs/lattice_{ratio:g}"), ratio)
            # 1e-6 is measured: the strain of the probes, over which the response is not straight.
            self.assertLess(found.largest_difference(), 5e-6)
            self.assertAlmostEqual(found.shear_equation_4 / (ratio * found.axial_equation_4 / 2), 1, 8)

    def test_another_stiffness_would_be_seen(self):
        lattice.draw(Program(PROGRAM, Path("lattice_runs")), Path("lattice.png"))
        wrong = lattice.answer(Path("lattice_runs/lattice_0.5"), 0.51)
        self.assertGreater(wrong.largest_difference(), 0.01)


def numbers_at(axis):
    """The labels of the ticks that lie within the limits."""
    low, high = axis.get_view_interval()
    axis.figure.draw_without_rendering()
    return [tick.label1.get_text() for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]


class LogarithmicAxes(unittest.TestCase):
    def test_numbers_can_be_read(self):
        for low, high, wanted in (
            (0.15, 6.0, ["0.2", "0.5", "1", "2", "5"]),
            (0.01, 10, ["0.01", "0.02", "0.05", "0.1", "0.2", "0.5", "1", "2", "5", "10"]),
            (0.5, 2e4, ["1", "10", "100", "1000", "10000"]),
            (3, 6, ["3", "4", "5", "6"]),
        ):
            for which in ("x", "y"):
                _, axis = plt.subplots(figsize=(10, 8))
                axis.set(**{f"{which}lim": (low, high)})
                log_axis(axis, which)
                self.assertEqual(numbers_at(getattr(axis, f"{which}axis")), wanted)
                plt.close("all")

    def test_panels_of_scenes_have_them(self):
        """The wall between 0.2 and 7 and the friction at 5 to 200 kPa, from made-up runs."""
        moved = {"displacement_wall_x": np.linspace(0, 0.2, 20), "reaction_wall_x": np.geomspace(1e4, 3e5, 20)}
        _, axes = plt.subplots(1, 2, figsize=(10, 4))
        with mock.patch.object(scenes, "stage", return_value=moved):
            scenes._wall(axes[0], mock.Mock(), np.radians(np.full(6, 40.0)))
        scenes._friction(axes[1], np.radians(np.full(6, 40.0)))
        self.assertEqual(numbers_at(axes[0].yaxis), ["0.2", "0.5", "1", "2", "5"])
        self.assertEqual(numbers_at(axes[1].xaxis), ["5", "10", "20", "50", "100", "200"])
        plt.close("all")


class Pictures(unittest.TestCase):
    def test_the_budget_is_drawn_from_its_file(self):
        done = call("error_budget")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(len(done.stdout.splitlines()), len(budget.rows()))
        self.assertTrue(Path("pictures/error_budget.png").stat().st_size > 0)

    def test_intervals_hold_their_values(self):
        for row in budget.rows():
            self.assertIn(row["kind"], budget.KINDS)
            self.assertLessEqual(float(row["low"]), float(row["value"]))
            self.assertLessEqual(float(row["value"]), float(row["high"]))

    def test_numbers_of_the_budget_stand_on_the_page(self):
        page = (ROOT / "docs/validation/trust.md").read_text()
        for row in budget.rows():
            text = row["value"] if row["kind"] == "draw" else f"{float(row['value']):+.1f} ±"
            self.assertIn(text, page, row["source"])

    def test_a_missing_program_is_one_line(self):
        done = call("closed_forms_lattice", "--program", "no_such_program")
        self.assertEqual(done.returncode, 2)
        self.assertEqual(len(done.stderr.splitlines()), 1)
        self.assertIn("no_such_program", done.stderr)


class Bands(unittest.TestCase):
    def test_the_inclination_of_bands_is_found(self):
        x, y = np.meshgrid(np.arange(1.02, 4, 0.04), np.arange(0.05, 2, 0.1), indexing="ij")
        places = np.stack([x.ravel(), y.ravel()], axis=-1).reshape(-1, 4, 2)
        for angle in (0.0, 20.0, 30.0):
            lean = np.tan(np.radians(angle)) * places[..., 1]
            left, right = (np.abs(places[..., 0] - at) for at in (2 + lean, 3 - lean))
            rate = 0.05 + np.exp(-((left / 0.06) ** 2)) + np.exp(-((right / 0.06) ** 2))  # and a little everywhere
            np.testing.assert_allclose(trapdoor_bands.inclinations(places, rate), angle, atol=1.5)


if __name__ == "__main__":
    unittest.main()
