"""What a notebook shows of results of each kind, of packings and tables; figures and the report page as functions."""

import os
import shutil
import sys
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(os.environ["VOUSSOIR_ROOT"]) / "python"))

import matplotlib as mpl
import matplotlib.pyplot as plt
import tiny_results
import voussoir
from voussoir import notebook
from voussoir.packing_files import PackingFile


def setUpModule():
    tiny_results.make("specimen", "scene", "ensemble", "sweep", "packings", "probe", "biaxial", "calibrate")


class Shown(unittest.TestCase):
    def test_one_line_and_a_picture_of_each_kind(self):
        for name in ("scene", "specimen", "biaxial", "calibrate", "probe", "packings"):
            result = voussoir.open_result(f"runs/{name}")
            self.assertNotIn("\n", repr(result))
            self.assertIn(f"runs/{name}", repr(result))
            self.assertIn("data:image/png;base64,", result._repr_html_())
        self.assertIn("data:image/png", voussoir.open_ensemble("runs/ensemble")._repr_html_())
        self.assertIn("<td>no equilibrium</td>", voussoir.open_sweep("runs/sweep")._repr_html_())
        self.assertIn("2 increments of biaxial_bvp", repr(voussoir.open_result("runs/specimen")))
        self.assertIn("<td>rad</td>", voussoir.open_result("runs/biaxial").table()._repr_html_())

    def test_what_cannot_be_drawn_is_left_out(self):
        shutil.rmtree("begun", ignore_errors=True)
        shutil.copytree("runs/specimen", "begun", ignore=shutil.ignore_patterns("increments"))
        self.assertEqual(voussoir.open_result("begun")._repr_html_().count("<img"), 0)
        with mock.patch("voussoir.pictures.figure", side_effect=ImportError("No module named 'matplotlib'")):
            shown = voussoir.open_result("runs/specimen")._repr_html_()
        self.assertIn("8 elements", shown)
        self.assertNotIn("<img", shown)

    def test_a_packing_shows_its_grains(self):
        (file, *_) = sorted(Path("runs/packings").glob("*.h5"))
        packing = PackingFile(file)
        picture = packing._repr_png_()
        assert picture is not None
        self.assertEqual(picture[:8], b"\x89PNG\r\n\x1a\n")
        bare = notebook.packing_png(packing.radius, packing.position, packing.cell)
        self.assertNotEqual(bare, packing._repr_png_())  # which has the contacts, too

    def test_figures_and_report(self):
        result = voussoir.open_result("runs/specimen")
        picture = result.figure("deviatoric_strain")
        self.assertEqual((picture.name, picture._repr_png_()[:4]), ("deviatoric_strain.png", b"\x89PNG"))
        self.assertEqual(picture.save("one.png").read_bytes(), picture.content)
        with self.assertRaisesRegex(ValueError, "no figure weather of a biaxial specimen; there are: specimen"):
            result.figure("weather")
        with self.assertRaisesRegex(TypeError, "no setting dephts; there are: losses, "):
            result.figure("deviatoric_strain", dephts=(0,))
        written = result.figures("drawn", form="svg", only=["specimen", "void_ratio.png"])
        self.assertEqual(written, [Path("drawn/specimen.svg"), Path("drawn/void_ratio.svg")])
        self.assertTrue(all(path.stat().st_size > 1000 for path in written))
        page = result.report("page.html", only=["specimen"])
        self.assertIn("</html>", page.read_text())

    def test_drawing_leaves_the_reader_s_own_figures_alone(self):
        plt.figure()
        size, open_ones = mpl.rcParams["font.size"], plt.get_fignums()
        voussoir.open_result("runs/scene").figure()
        self.assertEqual((mpl.rcParams["font.size"], plt.get_fignums()), (size, open_ones))
        plt.close("all")


if __name__ == "__main__":
    unittest.main()
