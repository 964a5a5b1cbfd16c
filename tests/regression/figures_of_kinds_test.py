"""Figures of packings, element tests, calibrations, probes and sweeps: each kind is known by its folder, known answers
are found, and what cannot be read ends in one line."""

import csv
import os
import shutil
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(os.environ["VOUSSOIR_ROOT"]) / "python"))

import h5py
import numpy as np
from figure_calls import call, copy
from program import command, run
from voussoir.figures import __main__ as figures
from voussoir.figures import calibration, element_tests, grading, probes, rve_size, small_samples, table_two
from voussoir.figures.packings import Packing
from voussoir.figures.result import Missing, RunIndex, Unreadable
from voussoir.figures.sweep import Sweep
from voussoir.figures.units import quantity
from voussoir.sweeps import SweepTable

TESTS = ["packing.grains=100", "packing.seeds=[1, 2]", "packing.folder=packings"]


def setUpModule():
    """One small run of each kind without a mesh."""
    for folder in ("runs", "packings", "sweep"):
        shutil.rmtree(folder, ignore_errors=True)
    run(command("pack", "runs/pack", [*TESTS, "packing.folder=packs"]))
    quick = ["biaxial.inertial_number=1e-3", "biaxial.strain=6 %", "biaxial.samples=100", "engine.precision=float"]
    # Tests as quick as these do not hold their lateral stress well, which is exit status 3.
    run(command("biaxial", "runs/biaxial", [*TESTS, *quick, 'biaxial.pressures=["100 kPa", "200 kPa"]']), code=None)
    run(command("probe", "runs/probe", [*TESTS[1:], "packing.grains=100"]))
    search = ["calibrate.rounds=0", "calibrate.confirm_grains=100", "calibrate.confirm_seeds=[1, 2]"]
    few = ['calibrate.thickness=["0.1 m", "0.2 m"]', 'biaxial.pressures=["400 kPa"]', "biaxial.inertial_number=2e-3"]
    run(command("calibrate_cps_d", "runs/calibrate", [*TESTS, *search, *few, "biaxial.strain=4 %"]), code=None)


def made_up_tests(folder, grains, stresses, pressure=100e3, case=""):
    """A run of kind biaxial as the program writes it, whose tests (one a packing) have a constant q [Pa]."""
    shutil.rmtree(folder, ignore_errors=True)
    Path(folder).mkdir(parents=True)
    strain = np.linspace(0, 0.2, 401)
    with h5py.File(Path(folder) / "run.h5", "w") as file:
        file.attrs["format"], file.attrs["format_version"] = "voussoir run", 1
        file["input"] = f'kind = "biaxial"\n{case}[packing]\ngrains = {grains}\n'
        file.create_group("provenance").attrs["case_kind"] = "biaxial"
        rows: dict[str, np.ndarray] = {name: np.zeros(len(stresses)) for name in (*element_tests.STRENGTH, "valid")}
        rows["seed"], rows["pressure"] = np.arange(len(stresses)) + 1.0, np.full(len(stresses), pressure)
        rows["valid"][:] = 1
        sine = np.array(stresses) / (pressure + np.array(stresses))
        rows["peak_angle"] = rows["critical_angle"] = np.arcsin(sine)
        for name, values in rows.items():
            file[f"tables/strength/{name}"] = values
        for k, q in enumerate(stresses):
            curve = {"axial_strain": strain, "volumetric_strain": 0 * strain, "q": q + 0 * strain}
            curve |= {"p": pressure + curve["q"], "stress_xx": pressure + 0 * strain}
            for name, values in curve.items():
                file[f"tables/seed_{k + 1}_{pressure / 1e3:g}_kPa/{name}"] = values


class KnownAnswers(unittest.TestCase):
    def test_quantities(self):
        for text, value in (("3 GPa", 3e9), ("39.1 deg", np.radians(39.1)), ("2 %", 0.02), (0.2, 0.2), ("5e-4", 5e-4)):
            self.assertAlmostEqual(quantity(text), value, delta=1e-12 * value)
        for text in ("3 stones", "many", ""):
            self.assertRaises(ValueError, quantity, text)

    def test_percent_finer(self):
        """One grain of 2 mm and one of 4 mm: by area 1 of 5 parts are fine, by volume 1 of 9; with a third the sizes at
        10, 30 and 60 % follow from straight lines in the logarithm."""
        for power, share in ((grading.BY_AREA, 20.0), (grading.BY_VOLUME, 100 / 9)):
            size, passing = grading.percent_finer(np.array([4.0, 2.0]), power)
            np.testing.assert_allclose(size, [2, 4])
            np.testing.assert_allclose(passing, [share, 100])
        grains = np.geomspace(1, 16, 2001)
        alike = np.repeat(grains, np.round(1e6 / grains**2).astype(int) // 100 + 1)  # equal areas of all sizes
        uniformity, curvature = grading.coefficients(alike, grading.BY_AREA)
        self.assertAlmostEqual(uniformity, 16**0.5, delta=0.02)
        self.assertAlmostEqual(curvature, 16**-0.1, delta=0.02)

    def test_coefficient_of_variation(self):
        """Chi-square as in printed tables; the interval holds the true coefficient as often as it says."""
        for nu, share, value in ((8, 0.975, 17.5345), (8, 0.025, 2.1797), (7, 0.975, 16.0128), (1, 0.95, 3.8415)):
            self.assertAlmostEqual(small_samples.chi_square_quantile(share, nu), value, delta=1e-4 * value)
        self.assertAlmostEqual(small_samples.variation(np.array([90.0, 100.0, 110.0])), 0.1)
        random = np.random.default_rng(1)
        draws = 1 + 0.1 * random.standard_normal((4000, 9))
        intervals = [small_samples.variation_interval(small_samples.variation(draw), 9) for draw in draws]
        self.assertAlmostEqual(np.mean([low <= 0.1 <= high for low, high in intervals]), 0.95, delta=0.012)

    def test_angles(self):
        """Tests of one angle at three pressures have this angle; leaving out packings of one value each gives the
        standard error of their mean."""
        rows = np.array([[pressure, np.radians(39.1)] for pressure in (1e5, 2e5, 4e5)])
        self.assertAlmostEqual(np.degrees(element_tests.common_angle(rows)), 39.1)
        sines = np.sin(np.radians([40.0, 38.0]))  # by hand: slope = sum(p q) / sum(p p), p = pressure / (1 - sin)
        p = np.array([1e5, 4e5]) / (1 - sines)
        slope = np.sum(p * p * sines) / np.sum(p * p)
        found = element_tests.common_angle(np.array([[1e5, np.radians(40)], [4e5, np.radians(38)]]))
        self.assertAlmostEqual(np.sin(found), slope)
        values = np.array([39.0, 40.0, 38.0, 41.5])
        mean, error = small_samples.jackknife([np.array([v]) for v in values], lambda x: float(x.mean()))
        self.assertAlmostEqual(mean, values.mean())
        self.assertAlmostEqual(error, values.std(ddof=1) / 2)
        self.assertTrue(np.isnan(small_samples.jackknife([values], lambda x: float(x.mean()))[1]))

    def test_stress_that_a_strain_carries(self):
        """sym(sigma e) - tr(e) sigma by hand, of a stress of -1, -3 and 0.4."""
        stress = np.array([-1.0, -3.0, 0.4])
        for strained, change in (("xx", (0, 3, -0.2)), ("yy", (1, 0, -0.2)), ("xy", (0.2, 0.2, -1))):
            np.testing.assert_allclose(probes.carried(stress, strained), change, atol=1e-12)

    def test_smallest_size(self):
        """q of 100 ± 20, 5, 12 and 5 kPa: met at the second size, missed again, met from the fourth."""
        for grains, spread in ((100, 20e3), (200, 5e3), (300, 12e3), (400, 5e3)):
            made_up_tests(f"sweep/rve_size/a-grains_{grains}", grains, 100e3 + spread * np.array([-1, 0, 1]))
        made_up_tests("sweep/else/b", 100, [1e5, 1.1e5], case="title = 'another'\n[soil]\nfriction = '30 deg'\n")
        (study,) = rve_size.studies(Sweep("sweep"))
        self.assertEqual(study.sizes, [100, 200, 300, 400])
        np.testing.assert_allclose(
            [[one.cov for one in row] for row in study.table], np.outer([0.2, 0.05, 0.12, 0.05], np.ones(5))
        )
        self.assertEqual((study.smallest(), study.smallest_from()), (200, 400))
        status, out, err = call(figures, "sweep", "-o", "drawn")
        self.assertEqual((status, err), (0, []), out)
        self.assertIn("wrote drawn/rve_size_variation.png", out)
        self.assertIn("skipped table_2.md: sweep has no biaxial run with several pressures", out)
        table = Path("drawn/rve_size.md").read_text()
        self.assertIn("The smallest size that meets 0.1 at all strains has 200 grains.", table)
        self.assertIn("A larger one misses it again; from 400 grains on all meet it.", table)
        self.assertIn("| 300 | 3 | 0.120 (", table)
        self.assertIn("| smallest that meets 0.1 | | 200 | 200 | 200 | 200 | 200 | 200 |", table)
        self.assertEqual(study.smallest_not_excluded(), 200)  # the interval of 0.2 of three packings begins at 0.103

    def test_axes_of_a_sweep(self):
        """The values of the axes come from sweep.h5, an empty one being none; runs without results are left out."""
        shutil.rmtree("axes", ignore_errors=True)
        made_up_tests("axes/size_1-dense", 100, [1e5, 1e5])
        with h5py.File("axes/sweep.h5", "w") as file:
            file.attrs["format"], file.attrs["format_version"] = "voussoir sweep", 1
            texts = {"runs/name": ("size_2", "size_1-dense"), "axes/size": ("2", "1"), "axes/soil": ("", "dense")}
            for name, values in texts.items():
                file[name] = np.array(values, dtype=h5py.string_dtype())
        (member,) = Sweep("axes").members
        self.assertEqual((member.name, member.kind), ("size_1-dense", "biaxial"))
        self.assertEqual(member.axes, {"size": "1", "soil": "dense"})
        with self.assertRaisesRegex(Unreadable, "axes/sweep.h5 cannot be read.*exit_code"):
            SweepTable(Sweep("axes"))
        with h5py.File("axes/sweep.h5", "r+") as file:
            file["runs/exit_code"] = [0, 0]
            file["results/settlement"] = [0.1]
        with self.assertRaisesRegex(Unreadable, "different lengths"):
            SweepTable(Sweep("axes"))

    def test_a_stress_that_was_not_held(self):
        """Where sigma_xx is off by 20 % around 5 % of strain, the test does not count there, and counts elsewhere."""
        made_up_tests("runs/unheld", 100, [1e5, 1e5, 1e5])
        with h5py.File("runs/unheld/run.h5", "r+") as file:
            off = file["tables/seed_1_100_kPa/stress_xx"]
            off[90:111] = 1.2 * off[90:111]
        study = rve_size.SizeStudy([element_tests.Series(RunIndex("runs/unheld"))])
        self.assertEqual([one.n for one in study.table[0]], [3, 3, 2, 3, 3])


class Runs(unittest.TestCase):
    def test_packings(self):
        """The pressure of the overlaps is the one that the program measured; files, several files and folders."""
        files = sorted(Path("packs").glob("packing_*.h5"))
        self.assertEqual(len(files), 2)
        for path in files:
            packing = Packing(path)
            self.assertAlmostEqual(packing.pressure() / packing.numbers["pressure"], 1, delta=2e-3)
        for words in (("packs",), files, (files[0], "packs")):
            status, out, err = call(figures, *words, "-o", "drawn", "--format", "svg")
            self.assertEqual((status, out, err), (0, ["wrote drawn/grading.svg", "wrote drawn/packings.svg"], []))
            self.assertIn(b"<svg", Path("drawn/grading.svg").read_bytes()[:2000])

    def test_element_tests(self):
        status, out, err = call(figures, "runs/biaxial", "-o", "drawn", "--format", "pdf")
        self.assertEqual((status, err, len(out)), (0, [], 4), out)
        self.assertEqual(Path("drawn/biaxial_curves.pdf").read_bytes()[:5], b"%PDF-")
        self.assertRegex(Path("drawn/table_2.md").read_text(), r"\*\*CPS_D, here\*\* \(100 grains\) \| \d")
        made_up_tests("runs/looser", 100, [1e5, 1e5], case="")
        status, out, err = call(
            figures, "runs/biaxial", "runs/looser", "runs/probe", "-o", "drawn", "--only", "table_2"
        )
        self.assertEqual((status, out, len(err)), (2, ["wrote drawn/table_2.md"], 1))
        self.assertIn("left out: runs/probe has no run.h5", err[0])
        self.assertIn("**CPS_D (looser), here**", Path("drawn/table_2.md").read_text())

    def test_table_of_known_tests(self):
        """sin phi = 1/2 at q = 100 kPa over 100 kPa: 30 degrees, without scatter, 9.1 degrees from the study's."""
        made_up_tests("runs/known", 100, [1e5, 1e5, 1e5])
        table_two.write([element_tests.Series(RunIndex("runs/known"))], Path("known.md"))
        table = Path("known.md").read_text()
        self.assertIn("**CPS_D, here** (100 grains) | 30.0 ± 0.0 | 30.0 ± 0.0 | 0.0 ± 0.0 |", table)
        self.assertIn("φ_p is not met, off by -9.1°", table)

    def test_own_soil_has_no_name_of_the_study(self):
        for sizes, name in (('["2 mm", "20 mm"]', "gravel"), ('["1 mm", "8 mm"]', "sand")):
            made_up_tests("runs/own", 100, [1e5, 1e5], case=f"[soil]\nsizes = {sizes}\npassing = [0, 1]\n")
            table_two.write([element_tests.Series(RunIndex("runs/own"))], Path("own.md"))
            table = Path("own.md").read_text()
            self.assertIn(f"**own {name}, here** (100 grains)", table)
            self.assertIn(f"own {name}: the study has no such soil", table)
            self.assertNotRegex(table, "CP[SG]_")

    def test_probe(self):
        """The strain that the rotation shows is that of the case, and so nearly is the one that the tangents imply."""
        probe = probes.Probe(Path("runs/probe"))
        self.assertAlmostEqual(probe.strain()[0] / 1e-5, 1, delta=1e-3)
        probe.rows = [row for row in probe.rows if row["probe"] != "rotation"]
        self.assertAlmostEqual(probe.strain()[0] / 1e-5, 1, delta=0.05)
        status, out, err = call(figures, "runs/probe", "-o", "drawn")
        self.assertEqual((status, err), (0, []))
        self.assertEqual(out, ["wrote drawn/probe_responses.png", "wrote drawn/probe_path.png"])

    def test_calibration(self):
        """Observables that are quadratics of the logarithms of the parameters are found again."""
        folder = copy("surface", "calibrate")
        with h5py.File(folder / "run.h5", "r+") as file:
            sets = file["tables/search"]
            a, b = np.log(sets["rolling_stiffness"][()]), np.log(sets["thickness"][()])
            for k, one in enumerate(calibration.observables(RunIndex(folder))):
                sets[one.name][...] = one.low * (1 + 0.1 * k + 0.05 * a - 0.02 * a * b)
            sets["usable"][...] = 1
        search = calibration.Search(RunIndex(folder))
        found = search.surfaces(search.sets)
        assert found is not None
        for one in search.observables:
            np.testing.assert_allclose(found[one.name], search.sets[one.name], rtol=1e-9)
        for name in ("surface", "calibrate"):
            status, out, err = call(figures, f"runs/{name}", "-o", "drawn")
            self.assertEqual((status, err), (0, []))
            self.assertRegex(out[0], "^wrote drawn/calibration.png|^skipped calibration.png: no set .* was usable")

    def test_misfit(self):
        """Off by two tolerances in one angle and by one limit's tolerance of the peak strain: 4 + 1."""
        index = RunIndex("runs/calibrate")
        values = {"peak_angle": 41.1, "critical_angle": 33.0, "dilatancy_angle": 14.0}
        given = {name: np.array([np.radians(value)]) for name, value in values.items()}
        self.assertAlmostEqual(calibration.misfit({**given, "peak_strain": np.array([0.06])}, index)[0], 5.0)


class BadInput(unittest.TestCase):
    def assert_one_line(self, words, *paths):
        status, out, err = call(figures, *paths)
        self.assertEqual((status, out, len(err)), (2, [], 1), err)
        self.assertIn(words, err[0])

    def test_packings(self):
        source = next(Path("packs").glob("packing_*.h5"))
        bad = Path("bad")
        shutil.rmtree(bad, ignore_errors=True)
        bad.mkdir()
        (bad / "packing_1.h5").write_bytes(source.read_bytes()[:2000])
        self.assert_one_line("packing_1.h5 cannot be read: it is damaged", bad)
        self.assert_one_line('is no "voussoir packing"', "runs/biaxial/run.h5")
        shutil.copy(source, bad / "packing_2.h5")
        status, out, err = call(figures, bad)
        self.assertEqual((status, len(out), len(err)), (2, 2, 1))
        with h5py.File(bad / "packing_2.h5", "r+") as file:
            del file["labels"].attrs["soil.modulus"]
        status, out, _ = call(figures, bad / "packing_2.h5")
        self.assertEqual((status, out[0]), (0, "wrote bad/grading.png"))
        self.assertIn("skipped packings.png: bad/packing_2.h5 does not tell its soil", out[1])
        with h5py.File(bad / "packing_2.h5", "r+") as file:
            file["contact_j"][0] = 10**6
        self.assert_one_line("a contact has a grain that does not exist", bad / "packing_2.h5")
        status, _, err = call(figures, source, bad / "packing_2.h5")
        self.assertEqual(status, 2)
        self.assertIn("by -o", err[-1])

    def test_element_tests(self):
        folder = copy("cut", "biaxial")
        with h5py.File(folder / "run.h5", "r+") as file:
            del file["tables/seed_2_200_kPa"]["q"]
        self.assert_one_line("the table seed_2_200_kPa has no column q", folder)
        with h5py.File(folder / "run.h5", "r+") as file:
            del file["tables/strength"]
        self.assert_one_line("has no table strength", folder)
        folder = copy("invalid", "biaxial")
        with h5py.File(folder / "run.h5", "r+") as file:
            file["tables/strength/valid"][...] = 0
        status, out, err = call(figures, folder, "-o", "drawn")
        self.assertEqual((status, err), (0, []), out)
        self.assertIn("skipped biaxial_curves.png: runs/invalid has no valid test", out)

    def test_probe(self):
        folder = copy("headless", "probe")
        rows = list(csv.reader((folder / "probe.csv").read_text().splitlines()))
        for content, words in (
            ("", "has no column seed"),
            (",".join(rows[0]) + "\n", "has no row"),
            ("\0\1", "probe.csv cannot be read"),
        ):
            (folder / "probe.csv").write_text(content)
            self.assert_one_line(words, folder)
        folder = copy("pathless", "probe")
        (folder / "path.csv").write_bytes(b"\xff\xfe\x00")
        status, out, err = call(figures, folder, "-o", "drawn")
        self.assertEqual((status, len(err)), (2, 1))
        self.assertIn("path.csv cannot be read", err[0])
        self.assertIn("skipped probe_path.png: the probe had no path (path.csv)", out)
        rows[1][rows[0].index("change_xx_Pa")] = "much"
        (folder / "probe.csv").write_text("\n".join(",".join(row) for row in rows))
        _, out, _ = call(figures, folder, "-o", "drawn")
        self.assertIn("skipped probe_responses.png: runs/pathless: a row of the probe has no number change_xx_Pa", out)

    def test_calibration(self):
        folder = copy("unfinished", "calibrate")
        with h5py.File(folder / "run.h5", "r+") as file:
            del file["tables"]
        status, out, err = call(figures, folder, "-o", "drawn")
        self.assertEqual((status, err), (0, []))
        self.assertIn("run.h5 has no table search", out[0])

    def test_sweeps(self):
        shutil.rmtree("nothing", ignore_errors=True)
        Path("nothing/a/b").mkdir(parents=True)
        self.assert_one_line("nothing has no run.h5: results are", "nothing")
        Path("nothing/summary.csv").write_text("name,status\n")
        self.assert_one_line("nothing has no run with a run.h5", "nothing")
        Path("nothing/a/run.h5").write_bytes(b"half")
        self.assert_one_line("nothing/a/run.h5 cannot be read", "nothing")
        made_up_tests("nothing/b", 100, [1e5, 1e5])
        status, out, err = call(figures, "nothing", "-o", "drawn", "--only", "rve_size")
        self.assertEqual((status, len(err)), (2, 1))
        self.assertIn("skipped rve_size.md: nothing has no biaxial runs that differ in packing.grains alone", out[0])
        Path("nothing/sweep.h5").write_bytes(b"half")
        self.assert_one_line("nothing/sweep.h5 cannot be read", "nothing")

    def test_kinds_of_figures(self):
        self.assertRaises(Missing, RunIndex, "runs/none")
        status, out, _ = call(figures, "runs/biaxial", "-o", "drawn", "--only", "void_ratio")
        self.assertEqual((status, out), (0, ["skipped void_ratio: it is no figure of biaxial tests"]))
        self.assert_one_line("runs of tunnels, and this is a calibration", "runs/calibrate", "--trends")
        status, _, err = call(figures, "runs/biaxial", "--format", "gif")
        self.assertEqual(status, 2)
        self.assertIn("invalid choice: 'gif'", err[-1])


if __name__ == "__main__":
    unittest.main()
