"""The comparison of the study's unseen trends: its measures have known answers, places and fits are found in a made-up
run, bad input ends in one line, and the program knows every setting of the sweep."""

import os
import subprocess
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(os.environ["VOUSSOIR_ROOT"]) / "tools"))
sys.path.insert(0, str(Path(os.environ["VOUSSOIR_ROOT"]) / "python"))

import numpy as np
from sensitivity_study import fits, measures, places, runs, strength, tables
from voussoir.figures import q8, trough_fit
from voussoir.figures.result import Result
from voussoir.figures.settings import Settings

ROOT = Path(os.environ["VOUSSOIR_ROOT"])
SWEEP = ROOT / "cases/study/sensitivity.toml"
LOSS = np.linspace(0, 0.2, 51)


class Measures(unittest.TestCase):
    def test_a_noisy_flat_curve_does_not_recover(self):
        noise = 0.006 * np.random.default_rng(1).standard_normal(len(LOSS))
        flat = np.maximum(1 - 20 * LOSS, 0.06) + noise
        found = measures.recovery(LOSS, flat)
        self.assertGreater(found.end / found.least, 1.15)  # what the minimum alone would say
        self.assertLess(found.factor, 1.15)

    def test_a_recovery_is_found(self):
        curve = np.where(LOSS < 0.1, 1 - 9 * LOSS, 0.1 + 0.5 * (LOSS - 0.1))
        found = measures.recovery(LOSS, curve)
        self.assertAlmostEqual(found.at, 0.1)
        self.assertAlmostEqual(found.least, 0.1)
        # The last window has 0.145 on average, the best one holds the minimum and lies on the flatter side.
        self.assertAlmostEqual(found.mean_end, 0.145)
        self.assertAlmostEqual(found.mean_least, 0.105)
        self.assertAlmostEqual(found.mean_at, 0.11)

    def test_a_falling_curve_has_the_factor_one(self):
        self.assertEqual(measures.recovery(LOSS, np.exp(-10 * LOSS)).factor, 1)

    def test_contraction(self):
        found = measures.contraction(LOSS, LOSS * (0.1 - LOSS))  # a parabola with its top at 5 %, zero at 10 %
        self.assertAlmostEqual(found.at, 0.05, delta=0.0041)
        self.assertAlmostEqual(found.net_until, 0.1, delta=0.0041)
        self.assertAlmostEqual(found.end, -0.02)
        growing = measures.contraction(LOSS, LOSS)
        self.assertEqual((growing.at, growing.net_until), (LOSS[-1], LOSS[-1]))
        dilating = measures.contraction(LOSS, -LOSS)
        self.assertEqual((dilating.most, dilating.at, dilating.net_until), (0, 0, 0))

    def test_heights_that_contract(self):
        late, early = measures.Contraction(1e-3, 0.15, 0.2, 1e-3), measures.Contraction(1e-3, 0.05, 0.1, -1e-3)
        never = measures.Contraction(0.0, 0.2, 0.0, -1e-3)
        self.assertEqual(measures.heights_that_contract([1, 2, 2.5, 3], [early, late, late, never], 0.12), (2, 2.5))
        self.assertIsNone(measures.heights_that_contract([1, 3], [early, never], 0.12))

    def test_strength_counts_valid_tests_at_the_pressure(self):
        columns: dict[str, np.ndarray] = {name: np.zeros(4) for name in strength.COLUMNS}
        columns["pressure"] = np.array([20001.0, 19999.0, 20000.0, 1e5])
        columns["valid"] = np.array([1.0, 1.0, 0.0, 1.0])
        columns["peak_angle"] = np.array([0.7, 0.9, 5.0, 3.0])
        found = strength.of_tests(columns, 20e3)
        assert found is not None
        self.assertEqual((found.count, found.peak), (2, 0.8))
        self.assertAlmostEqual(found.peak_error, 0.1)
        self.assertIsNone(strength.of_tests(columns, 1e5))

    def test_a_strength_is_of_the_tests_that_have_it(self):
        columns: dict[str, np.ndarray] = {name: np.ones(3) for name in strength.COLUMNS}
        columns["pressure"] = np.full(3, 20e3)
        columns["critical_angle"] = np.array([0.5, np.nan, 0.7])  # one test ended before its critical state
        columns["contraction"] = np.full(3, np.nan)
        found = strength.of_tests(columns, 20e3)
        assert found is not None
        self.assertEqual(found.critical, 0.6)
        self.assertAlmostEqual(found.critical_error, 0.1)
        self.assertTrue(np.isnan(found.contraction))

    def test_cells(self):
        self.assertEqual(tables.cell([0.01, 0.03], 100, 2), "2 (1 to 3)")
        self.assertEqual(tables.cell([1.0], 100, 2), "100")
        self.assertEqual(tables.cell([0.01234], 1, 2), "0.012")
        self.assertEqual(tables.cell([float("nan"), 0.03], 100, 2), "3")
        self.assertEqual(tables.cell([]), "–")


class State:
    """An increment of the made-up run."""

    def __init__(self, loss, displacement):
        self.loss, self.displacement = loss, displacement

    def __getitem__(self, name):
        return {"volume_loss": self.loss, "stage": "volume_loss"}[name]

    def field(self, _):
        return self.displacement


def grid(width, height, columns, rows):
    """Q8 rectangles."""
    numbers: dict[tuple[float, float], int] = {}
    elements = []

    def node(x, y):
        return numbers.setdefault((round(x, 9), round(y, 9)), len(numbers))

    dx, dy = width / columns, height / rows
    for j in range(rows):
        for i in range(columns):
            x, y = (i + 0.5) * dx, (j + 0.5) * dy
            local = np.vstack([q8.CORNERS, q8.MIDSIDES])
            elements.append([node(x + a * dx / 2, y + b * dy / 2) for a, b in local])
    return np.array(list(numbers)), np.array(elements)


def made_up(settlement):
    """A block of 35 m × 17.5 m above a crown at y = 2.5 m; `settlement` is a function of x."""
    result = object.__new__(Result)
    result.folder, result.settings = Path("made up"), Settings(depths=(0.0, 0.5))
    result.coordinates, result.connectivity = grid(35.0, 17.5, 40, 20)
    result.has_mesh, result.case = True, {}
    result.geometry = {"diameter": 5.0, "axis_depth": 17.5, "surface_y": 17.5}
    result.boundaries = {"tunnel": np.flatnonzero(np.all(np.isclose(result.coordinates, [0, 2.625]), axis=1))}
    shape = (len(LOSS), len(result.connectivity), 4)
    where = q8.gauss_coordinates(result.coordinates, result.connectivity)
    height = (where[..., 1] - 2.5) / 5
    stress = np.zeros((*shape, 3))
    # Nearer to the axis than D/4 the stress recovers, elsewhere it only falls.
    recovers = np.where(LOSS < 0.1, 1 - 9 * LOSS, 0.1 + 0.5 * (LOSS - 0.1))
    stress[..., 1] = -1e5 * np.where(where[..., 0] < 1.25, recovers[:, None, None], np.exp(-5 * LOSS)[:, None, None])
    pressure = np.full(shape, 5e4)
    # The soil at a height of h D contracts until V_l = 0.05 h.
    volumetric = 1e-3 * (0.05 * height * LOSS[:, None, None] - LOSS[:, None, None] ** 2 / 2)
    result._histories = {"gauss/stress": stress, "gauss/mean_stress": pressure,
                         "gauss/deviatoric_stress": 0.5 * pressure, "gauss/volumetric_strain": volumetric}  # fmt: skip
    nodes = np.zeros_like(result.coordinates)
    nodes[:, 1] = -settlement(result.coordinates[:, 0])
    states = [State(v, v * nodes) for v in LOSS]
    result.__dict__["loss_increments"] = states
    return result


class PlacesAndFits(unittest.TestCase):
    gauss: Result

    @classmethod
    def setUpClass(cls):
        cls.gauss = made_up(lambda x: trough_fit.modified_gauss(x, 1.0, 6.0, 0.5))

    def fits(self, result, ratio, reach=fits.WHOLE):
        found = fits.of_depth(result, ratio, reach)
        assert found is not None
        return found

    def test_the_stress_is_read_where_it_is_asked_for(self):
        at_axis = places.reaction_at(self.gauss, places.Place("", 0.1, 0.2, 0.12))
        self.assertAlmostEqual(measures.recovery(LOSS, at_axis).least, 0.1)
        found = places.reactions(self.gauss)
        self.assertAlmostEqual(found[places.CROWN_ELEMENT][25], 0.1)
        wide = found[places.PLACES[0].label]
        half = 0.5 * (at_axis + np.exp(-5 * LOSS))  # half of the points lie nearer than D/4
        np.testing.assert_allclose(wide, half, rtol=0.2)

    def test_heights(self):
        levels = {level.height: level for level in places.levels(self.gauss)}
        for height in (1.0, 2.0, 2.5):
            self.assertAlmostEqual(levels[height].volume.at, 0.05 * height, delta=0.006)
        measured = runs.Measured(self.gauss)
        assert measured.late_heights is not None
        self.assertAlmostEqual(measured.late_heights[0], 2.4, delta=0.15)
        self.assertAlmostEqual(measured.ac.at, 0.1, delta=0.006)
        self.assertAlmostEqual(levels[2.0].ratio[3], 0.5)

    def test_fits(self):
        for reach in (fits.WHOLE, 2.0):
            found = self.fits(self.gauss, 0.5, reach)
            self.assertEqual(found.at_bound, 0)
            self.assertAlmostEqual(found.alpha, 0.5, delta=0.02)
        pointed = made_up(lambda x: np.exp(-np.sqrt(x)))
        self.assertEqual(self.fits(pointed, 0.5).at_bound, 1)

    def test_the_document_names_all_tables(self):
        variation = runs.Variation("base", "nothing", [runs.Measured(self.gauss)])
        text = tables.document([variation], runs.Variation("at full size", "", []))
        self.assertEqual(text.count("| base: nothing | 1 |"), 3)


class Input(unittest.TestCase):
    def ends(self, *words, status=2):
        done = subprocess.run([sys.executable, ROOT / "tools/sensitivity_study", *map(str, words)], check=False,
                              capture_output=True, text=True, timeout=60)  # fmt: skip
        self.assertEqual(done.returncode, status, done.stderr)
        self.assertNotIn("Traceback", done.stderr)
        return done.stderr

    def test_bad_input_ends_in_one_line(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            self.assertIn("is no folder", self.ends(folder / "nothing", "-o", folder / "out"))
            self.assertIn("no run has come", self.ends(folder, "-o", folder / "out"))
            damaged = folder / "tunnels/base/member_000/run.h5"
            damaged.parent.mkdir(parents=True)
            damaged.write_text("no HDF5")
            self.assertIn("left out", self.ends(folder, "-o", folder / "out"))
            broken = folder / "broken.toml"
            broken.write_text("[grid")
            self.assertIn("no TOML", self.ends(folder, "--sweep", broken, "-o", folder / "out"))
            broken.write_text("base = 'a.toml'")
            self.assertIn("has no grid", self.ends(folder, "--sweep", broken, "-o", folder / "out"))
            self.assertFalse((folder / "out").exists())

    def test_the_program_knows_all_settings_of_the_sweep(self):
        for grid in tomllib.loads(SWEEP.read_text())["grid"]:
            for point, change in grid["variation"].items():
                changes = change if isinstance(change, list) else [change]
                words = [os.environ["VOUSSOIR"], "check", str((SWEEP.parent / grid["base"]).resolve())]
                for setting in [*grid["set"], *changes]:
                    words += ["--set", setting]
                done = subprocess.run(words, check=False, capture_output=True, text=True, timeout=60)
                self.assertEqual(done.returncode, 0, f"{point}: {done.stderr}")


if __name__ == "__main__":
    unittest.main()
