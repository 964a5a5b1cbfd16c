"""Figures and sentences that compare the tunnels of a study: statistics and judgements on arrays whose answers are
known, then two members of one tiny tunnel, with what is missing or damaged told in one line."""

import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(os.environ["VOUSSOIR_ROOT"]) / "python"))

import numpy as np
from program import ROOT, SMALL_TUNNEL, command, run
from voussoir.figures import paper, trends
from voussoir.figures.result import Missing
from voussoir.figures.study import bands, data, judging, merging, microstructure, sentences, stresses
from voussoir.figures.study.catalogue import STUDY_FIGURES

DRAWN = ("study_reaction", "study_fabric", "study_strong", "study_stress_changes")


class Statistics(unittest.TestCase):
    def test_student(self):
        for freedom, wanted in ((1, 12.7062), (2, 4.30265), (3, 3.18245), (30, 2.04227)):  # of tables
            self.assertAlmostEqual(bands.student_t(freedom), wanted, delta=2e-4 * wanted)

    def test_bands_of_three_members(self):
        found = bands.of_members([[1.0, 5.0], [2.0, 5.0], [3.0, 5.0]])
        np.testing.assert_allclose(found.mean, [2, 5])
        np.testing.assert_allclose(found.mean_half_width, [4.30265 / np.sqrt(3), 0], rtol=1e-4)
        np.testing.assert_allclose(found.prediction_half_width, [4.30265 * np.sqrt(4 / 3), 0], rtol=1e-4)

    def test_one_member_has_no_band(self):
        found = bands.number([0.25])
        self.assertEqual(str(found), "0.25")
        self.assertTrue(np.isnan(found.half_width))
        self.assertEqual(bands.number([0.25, np.nan, np.nan]).count, 1)  # members without a value do not count

    def test_means_differ_only_beyond_their_bands(self):
        low, high = bands.Number(1.0, 0.3, 4), bands.Number(1.6, 0.4, 4)  # 0.6 apart, band 0.5
        self.assertIs(bands.exceeds(high, low), True)
        self.assertIs(bands.exceeds(low, high), False)
        self.assertIsNone(bands.exceeds(high, bands.Number(1.2, 0.3, 4)))
        self.assertIs(bands.exceeds(bands.Number(1.1, np.nan, 1), bands.Number(1.0, np.nan, 1)), True)
        self.assertIsNone(bands.all_hold([True, None]))
        self.assertIs(bands.all_hold([None, False]), False)


class Texts(unittest.TestCase):
    def test_numbers_become_means(self):
        self.assertEqual(merging.merge(["least 0.10 at 5 %", "least 0.10 at 5 %"]), "least 0.10 at 5 %")
        merged = merging.merge(["least 0.10 at 5 %; end 1", "least 0.12 at 5 %; end 1"])
        self.assertEqual(merged, "least 0.11 ± 0.13 at 5 %; end 1")

    def test_words_that_differ_are_counted(self):
        merged = merging.merge(
            ["Aa: 0.5 at 7 %, falls after it", "Aa: 0.5 at 7 %, falls not", "Aa: 0.5 at 7 %, falls not"]
        )
        self.assertEqual(merged, "Aa: 0.5 at 7 %, falls not (2 of 3) / after it (1 of 3)")

    def test_verdicts_are_counted(self):
        seen = judging.Judged("x", [trends.SEEN, trends.NOT_SEEN, trends.SEEN], "")
        self.assertEqual(seen.verdict, "seen in 2 of 3")
        self.assertEqual(judging.Judged("x", [trends.NOT_REACHED] * 3, "").verdict, trends.NOT_REACHED)
        self.assertEqual(judging.Judged("x", [trends.SEEN, trends.NO_DATA], "").verdict, "seen in 1 of 2, 1 no data")

    def test_claims_by_their_verdict(self):
        text = sentences.says("K = 1", (True, "a"), (False, "b"), (None, "c"), (True, "d"))
        self.assertEqual(text, "As in the paper: a; d. Not seen here: b. Open, as the members scatter: c. Here K = 1.")

    def test_every_figure_of_the_paper_has_a_file_or_a_reason(self):
        numbers = [figure.number for figure in paper.FIGURES]
        self.assertEqual(len(numbers), len(set(numbers)))
        for wanted in [
            *map(str, range(1, 15)),
            "15a",
            "15b",
            *map(str, range(16, 25)),
            "A1",
            "A2",
            "Table 1",
            "Table 2",
        ]:
            self.assertIn(wanted, numbers)
        for figure in paper.FIGURES:
            self.assertNotEqual(bool(figure.files), bool(figure.missing), figure.number)
        ours = {file for figure in paper.FIGURES for file in figure.files if file.startswith("study_")}
        self.assertEqual(ours, set(STUDY_FIGURES))


class Fabric(unittest.TestCase):
    def test_eq_22_is_a_density(self):
        turn = np.linspace(0, 2 * np.pi, 2001)
        density = microstructure.fourier(turn, 0.4, 0.3)
        self.assertAlmostEqual(float(np.trapezoid(density, turn)), 1.0, places=6)
        self.assertAlmostEqual(float(turn[np.argmax(density[:1000])]), 0.3, places=2)

    def test_axes_are_averaged_without_arrows(self):
        mean = stresses.mean_axis(np.radians([[89.0], [-89.0]]))  # 2 degrees apart, around the vertical of the scale
        self.assertAlmostEqual(abs(float(np.degrees(mean[0]))), 90.0)
        away = stresses.mean_difference(np.radians([[89.0]]), np.radians([[-89.0]]))
        self.assertAlmostEqual(float(away[0]), 2.0)

    def test_strong_contacts(self):
        branch = np.array([[1.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
        snapshot = {
            "branch": branch,
            "force": -np.array([[1.0], [4.0], [1.0]]) * branch,  # the mean is 2
            "contact_i": np.array([0, 1, 2]),
            "contact_j": np.array([1, 2, 3]),
            "radius": np.ones(5),
        }
        np.testing.assert_array_equal(microstructure.strong_contacts(snapshot, 1.0), [False, True, False])
        self.assertAlmostEqual(microstructure.strong_share(snapshot, 1.0), 2 / 5)


def study(*words):
    done = subprocess.run(
        [sys.executable, str(ROOT / "tools/compare_tunnels.py"), *map(str, words)],
        check=False,
        capture_output=True,
        text=True,
    )
    return done.returncode, done.stdout, done.stderr


class TinySweep(unittest.TestCase):
    """Two draws of one tunnel, in the folders that a sweep makes."""

    @classmethod
    def setUpClass(cls):
        shutil.rmtree("sweep", ignore_errors=True)
        settings = [*SMALL_TUNNEL, "volume_loss.increments=2", 'output.microstructure=["fabric", "coordination"]']
        for k in (0, 1):
            folder = f"sweep/tunnels/cps_d_cd2/member_00{k}"
            run(command("tunnel_quick", folder, [*settings, f"packing.seed={k + 1}"]))

    def test_bands_of_two_members(self):
        found = data.open_study([Path("sweep")])
        self.assertEqual([(t.name, t.count, t.code) for t in found.tunnels], [("cps_d_cd2", 2, "CPS_D")])
        tunnel = found.main()
        loss = tunnel.over_loss(lambda member: member.volume_loss)
        np.testing.assert_allclose(loss.mean, tunnel.loss)
        np.testing.assert_allclose(loss.mean_half_width, 0, atol=1e-12)
        self.assertIn(tunnel.representative, tunnel.members)
        with self.assertRaisesRegex(Missing, "gravel"):
            found.soil("gravel")

    def test_figures_and_sentences(self):
        status, said, errors = study("sweep", "-o", "drawn", "--only", *DRAWN, "study")
        self.assertEqual((status, errors), (0, ""), said)
        for name in DRAWN:
            if name != "study_strong":
                self.assertTrue(Path("drawn", f"{name}.png").exists(), said)
        self.assertIn("skipped study_strong.png: no RVE near Aa was written", said)
        text = Path("drawn/study.md").read_text()
        self.assertIn("| cps_d_cd2 | dense sand (CPS_D) | 2 | 2 | 0.5 % |", text)
        self.assertIn("No data: needs dense sand and another soil at the same cover.", text)
        self.assertNotIn("Fault", text)

    def test_one_run_says_that_it_has_no_bands(self):
        status, said, errors = study("sweep/tunnels/cps_d_cd2/member_000", "-o", "one", "--only", "study")
        self.assertEqual((status, errors), (0, ""), said)
        self.assertIn("a single run: no bands", Path("one/study.md").read_text())

    def test_what_cannot_be_read(self):
        shutil.rmtree("damaged", ignore_errors=True)
        shutil.copytree("sweep", "damaged")
        Path("damaged/tunnels/cps_d_cd2/member_001/run.h5").write_bytes(b"nothing")
        status, _, errors = study("damaged", "--only", "study")
        self.assertEqual(status, 2)
        self.assertRegex(errors, r"^left out: damaged/tunnels/cps_d_cd2/member_001/run.h5 cannot be read.*\n$")
        Path("empty").mkdir(exist_ok=True)
        for folder, reason in (("empty", "holds no tunnel"), ("nowhere", "does not exist")):
            status, _, errors = study(folder)
            self.assertEqual((status, errors.count("\n")), (2, 1), errors)
            self.assertIn(reason, errors)


if __name__ == "__main__":
    unittest.main()
