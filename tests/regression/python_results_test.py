"""Results in Python: every kind opens as NumPy arrays with the numbers and units of its files, and as pandas and xarray
have them; folders without results, damaged files and runs that go on are told."""

import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(os.environ["VOUSSOIR_ROOT"]) / "python"))

import h5py
import numpy as np
import tiny_results
import voussoir


def setUpModule():
    tiny_results.make()


def stored(file, name):
    with h5py.File(Path("runs") / file) as opened:
        return opened[name][()]


class OfAMesh(unittest.TestCase):
    def test_increments_fields_and_tables_are_those_of_the_files(self):
        result = voussoir.open_result("runs/tunnel")
        self.assertEqual((result.kind, result.stages), ("tunnel", ["gravity", "volume_loss"]))
        last = result.increments[-1]
        self.assertAlmostEqual(last["volume_loss"], 0.1)
        file = f"tunnel/increments/{last.path.name}"
        np.testing.assert_array_equal(last.field("stress"), stored(file, "gauss/stress"))
        np.testing.assert_array_equal(last.field("gauss/mean_stress"), stored(file, "gauss/mean_stress")[..., 0])
        self.assertEqual([last.unit(n) for n in ("stress", "displacement", "residual_bound")], ["Pa", "m", "-"])
        self.assertEqual(last.unit("wall_s"), "s")
        self.assertEqual(last.residuals.shape, (last["iterations"],))
        self.assertRaises(voussoir.Missing, last.field, "void_ratio")
        history = result.history("displacement", "volume_loss")
        self.assertEqual(history.shape, (5, len(result.coordinates), 2))
        np.testing.assert_array_equal(history[-1], last.field("node/displacement"))
        self.assertEqual(result.unit("displacement"), "m")
        self.assertIn("gauss/stress", result.fields)
        np.testing.assert_allclose(
            result.gauss_points, result.increments[0].field("gauss_point_coordinates"), atol=0.02
        )

    def test_tables(self):
        result = voussoir.open_result("runs/tunnel/run.h5")
        table = result.table()
        np.testing.assert_array_equal(table["crown_settlement"], stored("tunnel/run.h5", "table/crown_settlement"))
        self.assertEqual((table.units["crown_settlement"], table.rows), ("m", len(result.increments)))
        k0 = result.table("k0", "ratio", "vertical_stress")
        np.testing.assert_array_equal(k0["ratio"], stored("tunnel/run.h5", "tables/k0/ratio"))
        self.assertEqual(k0.units, {"vertical_stress": "Pa", "ratio": "-"})
        self.assertEqual((result.column.kind, result.column.stages), ("column", ["column"]))
        with self.assertRaisesRegex(voussoir.Missing, "no column weather"):
            result.table("k0", "weather")
        self.assertRaises(voussoir.Missing, voussoir.open_result("runs/specimen").__getattribute__, "column")

    def test_snapshots(self):
        result = voussoir.open_result("runs/specimen")
        increment = result.increments[-1]
        grains = increment.snapshot(increment.snapshots[0])
        self.assertEqual((len(grains["radius"]), grains["cell"].shape), (60, (2, 2)))
        self.assertEqual(grains["force"].shape, grains["branch"].shape)
        self.assertEqual(result.table("gauss_histories").units["stress_yy"], "Pa")

    def test_what_is_missing_names_what_there_is(self):
        result = voussoir.open_result("runs/tunnel")
        for ask, known in (
            (lambda: result.stage("weather"), "gravity, volume_loss"),
            (lambda: result.history("weather"), "gauss/stress"),
            (lambda: result.increments[-1]["weather"], "load_parameter"),
            (lambda: result.table("weather"), "There are: increments, "),
        ):
            with self.assertRaisesRegex(voussoir.Missing, "weather$") as caught:
                ask()
            self.assertIn(known, caught.exception.__notes__[0])

    def test_records_of_a_scene(self):
        scene = voussoir.open_result("runs/scene")
        self.assertEqual(scene.records, ["bed", "door", "floor", "left", "level", "middle", "right", "wall"])
        door, bed, level = (scene.record(name) for name in ("door", "bed", "level"))
        np.testing.assert_array_equal(door["reaction_y"], stored("scene/run.h5", "table/reaction_door_y"))
        self.assertEqual((door.units["reaction_y"], bed.units["p"]), ("N/m", "Pa"))
        np.testing.assert_array_equal(bed["q_over_p"], stored("scene/run.h5", "table/q_over_p_bed"))
        np.testing.assert_array_equal(level["s"], stored("scene/run.h5", "tables/line_level/s"))
        with self.assertRaisesRegex(voussoir.Missing, "no record gate; there are: bed, door"):
            scene.record("gate")

    def test_pandas_and_xarray(self):
        result = voussoir.open_result("runs/tunnel")
        frame = result.to_pandas()
        self.assertEqual(frame.attrs["units"]["crown_settlement"], "m")
        np.testing.assert_array_equal(frame.volume_loss, result.table()["volume_loss"])
        data = result.to_xarray()
        self.assertEqual(data.stress.dims, ("increment", "element", "point", "component"))
        np.testing.assert_array_equal(
            data.stress[-1].sel(component="yy"), result.increments[-1].field("stress")[..., 1]
        )
        self.assertEqual((data.stress.attrs["units"], data.displacement.dims[1:]), ("Pa", ("node", "axis")))
        few = result.to_xarray("stress", stage="volume_loss")
        self.assertEqual((list(few.data_vars), few.sizes["increment"]), (["stress"], 5))
        self.assertRaises(voussoir.Missing, result.to_xarray, "weather")
        for name, call in (("pandas", result.to_pandas), ("xarray", result.to_xarray)):
            with (
                mock.patch.dict(sys.modules, {name: None}),
                self.assertRaisesRegex(ImportError, f"needs {name}, which"),
            ):
                call()


class OfTests(unittest.TestCase):
    def test_biaxial(self):
        result = voussoir.open_result("runs/biaxial")
        self.assertEqual((result.kind, result.increments, result.has_mesh), ("biaxial", [], False))
        np.testing.assert_array_equal(
            result.table()["peak_angle"], stored("biaxial/run.h5", "tables/strength/peak_angle")
        )
        self.assertEqual(result.table().units["peak_angle"], "rad")
        self.assertEqual(len(result.tables["seed_1_400_kPa"]["q"]), result.tables["seed_1_400_kPa"].rows)
        with self.assertRaisesRegex(voussoir.Missing, "has no increments"):
            result.to_xarray()

    def test_calibration(self):
        result = voussoir.open_result("runs/calibrate")
        np.testing.assert_array_equal(result.table()["misfit"], stored("calibrate/run.h5", "tables/search/misfit"))

    def test_probe(self):
        result = voussoir.open_result("runs/probe")
        self.assertEqual((result.kind, list(result.tables)), ("probe", ["probe", "path"]))
        table, path = result.table(), result.table("path")
        self.assertEqual((table.units["stress_xx_Pa"], list(table["probe"][:2])), ("Pa", ["xx", "yy"]))
        self.assertEqual((list(path["increment"]), path["status"][0]), (list(range(11)), "converged"))
        lines = Path("runs/probe/path.csv").read_text().splitlines()
        self.assertEqual(
            path["stress_yy_Pa"][-1], float(lines[-1].split(",")[lines[0].split(",").index("stress_yy_Pa")])
        )
        self.assertEqual((list(result.ends), len(result.ends[1].radius)), ([1], 60))

    def test_packings(self):
        result = voussoir.open_result("runs/packings")
        (packing,) = (packing for packing in result.packings if packing.seed == 2)
        np.testing.assert_array_equal(packing.radius, stored(f"packings/{packing.path.name}", "radius"))
        self.assertEqual((packing.position.shape, packing.rotation.shape), ((60, 2), (60,)))
        row = list(result.table()["seed"]).index(2)
        self.assertEqual(result.table()["void_ratio"][row], packing.void_ratio)
        self.assertEqual(len(voussoir.open_result(packing.path).packings), 1)


class OfSeveral(unittest.TestCase):
    def test_ensemble(self):
        ensemble = voussoir.open_ensemble("runs/ensemble")
        curve = ensemble.curve("q_over_p")
        np.testing.assert_array_equal(curve.mean, stored("ensemble/ensemble.h5", "curves/q_over_p/mean"))
        np.testing.assert_allclose(curve.members.mean(axis=0), curve.mean)
        member = ensemble.member(1)
        self.assertEqual(member.folder.name, "member_001")
        np.testing.assert_array_equal(member.table()["q_over_p"], curve.members[1])
        fields = ensemble.fields(-1)
        both = [ensemble.member(k).increments[-1].field("stress") for k in (0, 1)]
        np.testing.assert_allclose(fields["gauss/stress"].mean, np.mean(both, axis=0))
        self.assertEqual((fields["gauss/stress"].unit, curve.unit), ("Pa", "-"))
        self.assertEqual(ensemble.to_pandas().attrs["units"]["axial_stress_deviation"], "Pa")
        self.assertEqual(ensemble.to_xarray().q_over_p_members.shape, curve.members.shape)

    def test_sweep(self):
        sweep = voussoir.open_sweep("runs/sweep")
        self.assertEqual([run.status for run in sweep.runs], ["finished", "no equilibrium"])
        frame = sweep.to_pandas()
        self.assertEqual((list(frame.name), list(frame.newton)), (["grid/patient", "grid/hasty"], ["patient", "hasty"]))
        self.assertEqual(frame.exit_code[1], 3)
        patient = sweep.result("grid/patient")
        self.assertEqual(patient.table()["axial_stress"][-1], sweep.run("grid/patient").results["axial_stress"])
        self.assertEqual(sweep.table.units["axial_stress"], "Pa")
        with self.assertRaisesRegex(voussoir.Missing, "there are: grid/patient, grid/hasty"):
            sweep.run("grid/hard")


class Faults(unittest.TestCase):
    def assert_unreadable(self, sentence, opened, folder):
        with self.assertRaises(voussoir.Unreadable) as caught:
            opened(folder)
        self.assertIn(sentence, str(caught.exception))

    def test_folders_without_results(self):
        Path("empty").mkdir(exist_ok=True)
        for folder, sentence in (
            ("empty", "empty has no run.h5: results are"),
            ("nowhere", "nowhere does not exist"),
            ("runs/sweep", "is a sweep, which voussoir.open_sweep opens"),
            ("runs/ensemble", "is an ensemble, which voussoir.open_ensemble opens"),
        ):
            self.assert_unreadable(sentence, voussoir.open_result, folder)
        self.assert_unreadable("runs/tunnel has no sweep", voussoir.open_sweep, "runs/tunnel")
        self.assert_unreadable("ensemble.h5", voussoir.open_ensemble, "runs/tunnel")

    def copy(self, name):
        shutil.rmtree(name, ignore_errors=True)
        shutil.copytree("runs/specimen", name)
        return Path(name)

    def test_damaged_files(self):
        folder = self.copy("damaged")
        (folder / "increments/0001.h5").write_bytes(b"no HDF5")
        result = voussoir.open_result(folder)
        self.assertEqual(len(result.increments), 1)
        self.assertIn("0001.h5 cannot be read: it is damaged", str(result.left_out[0]))
        whole = (folder / "run.h5").read_bytes()
        (folder / "run.h5").write_bytes(whole[: len(whole) // 2])
        self.assert_unreadable("run.h5 cannot be read", voussoir.open_result, folder)

    def test_a_run_that_goes_on(self):
        """An increment that the index does not list yet, one that is being written, and the lock of a process."""
        folder = self.copy("going_on")
        with h5py.File(folder / "run.h5", "r+") as file:
            del file["table"]
        (folder / "increments/0003.h5.tmp").write_bytes(b"half")
        process = subprocess.Popen(["sleep", "60"])
        born = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()[19]
        host = os.uname().nodename
        lock = f"text\nhost {host}\nmachine 0\nprocess {process.pid}\nsince now\nborn {born}\n"
        (folder / "run.lock").write_text(lock)
        result = voussoir.open_result(folder)
        self.assertTrue(result.is_running)
        self.assertIn("still running", repr(result))
        self.assertEqual(result.table()["index"].tolist(), [1, 2])
        process.kill()
        process.wait()
        self.assertFalse(result.is_running)
        (folder / "run.h5").unlink()
        self.assert_unreadable("has no run.h5: results", voussoir.open_result, folder)


if __name__ == "__main__":
    unittest.main()
