"""The figure scripts on short, coarse, interrupted and damaged runs: no traceback, each skipped figure says why, one
figure that fails loses no other one, and the exit status tells what happened."""

import errno
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import unittest
import warnings
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(os.environ["VOUSSOIR_ROOT"]) / "tools"))
sys.path.insert(0, str(Path(os.environ["VOUSSOIR_ROOT"]) / "python"))

import compare_runs
import compare_tunnels
import h5py
import numpy as np
from figure_calls import call, copy
from program import PROGRAM, check, run, start_and_signal
from tiny_results import GROUND
from voussoir.figures import __main__ as figures
from voussoir.figures import source, trend_table
from voussoir.figures.catalogue import FIGURES

ROOT = Path(os.environ["VOUSSOIR_ROOT"])
SPECIMEN = 'kind = "biaxial_bvp"\nmaterial = "linear_elastic"\n[biaxial_bvp]\nstrain = "1 %"\n'


def command(case, folder):
    return [PROGRAM, "run", case, "-o", folder]


def setUpModule():
    """Two whole runs, and one that was stopped within its gravity."""
    shutil.rmtree("runs", ignore_errors=True)
    Path("runs").mkdir()
    Path("tunnel.toml").write_text(GROUND)
    Path("specimen.toml").write_text(SPECIMEN)
    run(command("tunnel.toml", "runs/coarse"))
    run(command("specimen.toml", "runs/specimen"))
    code = start_and_signal(command("tunnel.toml", "runs/stopped"), "runs/stopped/increments/0001.h5", signal.SIGUSR1)
    check(code == 130, f"the run was not stopped: exit {code}")


class Runs(unittest.TestCase):
    def test_coarse_volume_loss(self):
        """10 % in four increments, where no straight line can be laid through the states below 2 %."""
        status, out, err = call(figures, "runs/coarse")
        self.assertEqual((status, err), (0, []))
        self.assertEqual(len(out), len(FIGURES) + 1)
        for line in out:
            self.assertRegex(line, r"^wrote runs/coarse/|^skipped \w+\.png: .*(gauss/|output\.)")
        table = Path("runs/coarse/trends.md").read_text()
        self.assertRegex(table, r"q/p falls linearly.*\*\*not reached\*\* \| needs 3 states from V_l = 0 % to 2 %")
        self.assertRegex(table, r"grows more slowly.*\*\*not reached\*\* \| needs 2 states")

    def test_stopped_before_the_volume_loss(self):
        status, out, err = call(figures, "runs/stopped", "--only", "convergence", "displacement", "rve_paths", "trends")
        self.assertEqual((status, err), (0, []))
        self.assertEqual([line.split()[0] for line in out], ["wrote", "skipped", "wrote", "skipped"])
        self.assertIn("skipped trends.md: there is no stage volume_loss", out)

    def test_specimen_and_column(self):
        for folder, what in (("runs/specimen", "a biaxial specimen"), ("runs/coarse/column", "a column")):
            status, out, err = call(figures, folder, "--only", "deviatoric_strain", "geostatic_stress", "trends")
            self.assertEqual((status, err), (0, []), folder)
            self.assertIn(f"skipped trends: it is no figure of {what}", out)
            status, out, err = call(figures, folder, "--trends")
            self.assertEqual((status, out, len(err)), (2, [], 1))
            self.assertIn(f"judged for single runs of tunnels, and this is {what}", err[0])

    def test_no_increments_and_no_run(self):
        bare = Path("runs/bare")
        shutil.rmtree(bare, ignore_errors=True)
        bare.mkdir()
        self.assert_one_line(bare, "has no run.h5: results are runs of the kinds")
        shutil.copy("runs/coarse/run.h5", bare)
        self.assert_one_line(bare, "has no increments that can be drawn")
        self.assert_one_line("runs/none", "does not exist")
        self.assert_one_line("tunnel.toml", "is a file, not the folder of a run")

    def assert_one_line(self, folder, words):
        status, out, err = call(figures, folder)
        self.assertEqual((status, out, len(err)), (2, [], 1), err)
        self.assertIn(words, err[0])

    def test_damaged_index(self):
        folder = copy("damaged")
        whole = (folder / "run.h5").read_bytes()
        for content in (b"", b"no HDF5", whole[:1000], whole[: len(whole) // 2]):
            (folder / "run.h5").write_bytes(content)
            self.assert_one_line(folder, "run.h5 cannot be read: it is damaged, or no HDF5 file")
        shutil.copy(folder / "increments/0001.h5", folder / "run.h5")
        self.assert_one_line(folder, 'is no "voussoir run" of this program')
        with mock.patch("h5py.File", side_effect=PermissionError(13, "Permission denied")):
            self.assert_one_line("runs/coarse", "run.h5 cannot be read: Permission denied")

    def test_impossible_lengths(self):
        folder = copy("lengths")
        for length in (np.inf, 0.0):
            with h5py.File(folder / "run.h5", "r+") as file:
                file["mesh/geometry"].attrs["diameter"] = length
            status, out, err = call(figures, folder, "--only", "settlement_troughs", "convergence")
            self.assertEqual((status, err), (0, []))
            self.assertIn("skipped settlement_troughs.png: the ground has an impossible diameter", out[0])

    def test_damaged_increment_is_left_out(self):
        folder = copy("hole")
        (folder / "increments/0002.h5").write_bytes(b"half")
        status, out, err = call(figures, folder, "--only", "convergence")
        self.assertEqual((status, out, len(err)), (2, [f"wrote {folder}/convergence.png"], 1))
        self.assertIn("left out: runs/hole/increments/0002.h5 cannot be read", err[0])

    def test_a_pipe_is_not_waited_for(self):
        folder = copy("piped")
        (folder / "increments/0002.h5").unlink()
        os.mkfifo(folder / "increments/0002.h5")
        status, _, err = call(figures, folder, "--only", "convergence")
        self.assertEqual((status, len(err)), (2, 1))
        self.assertIn("increments/0002.h5 cannot be read: it is a folder, a pipe or a device", err[0])


class Faults(unittest.TestCase):
    def test_one_figure_loses_no_other(self):
        with mock.patch.dict(FIGURES, {"void_ratio.png": lambda _result, _path: 1 // 0}):
            names = ("--only", "displacement", "void_ratio", "convergence")
            status, out, err = call(figures, "runs/coarse", *names)
            self.assertEqual((status, len(out), len(err)), (1, 2, 1))
            self.assertRegex(err[0], r"^FAULT in void_ratio\.png: ZeroDivisionError: .*fault of the tool")
            status, _, err = call(figures, "runs/coarse", *names, "--traceback")
            self.assertIn("Traceback (most recent call last):", err)
        self.assertEqual(status, 1)

    def test_one_trend_loses_no_other(self):
        with mock.patch.object(trend_table, "curve", side_effect=IndexError("no such place")):
            status, _, err = call(figures, "runs/coarse", "--trends")
        self.assertEqual((status, len(err)), (1, 1))
        table = Path("runs/coarse/trends.md").read_text()
        self.assertIn("| Ground reaction curve | **fault of the tool** | IndexError: no such place |", table)
        self.assertIn("The modified Gauss curve fits", table)

    def test_a_warning_is_told(self):
        with mock.patch.dict(FIGURES, {"void_ratio.png": lambda _result, _path: warnings.warn("x", stacklevel=1)}):
            status, _, err = call(figures, "runs/coarse", "--only", "void_ratio")
        self.assertEqual((status, len(err)), (0, 1))
        self.assertIn("void_ratio.png: a warning of", err[0])


class Machine(unittest.TestCase):
    """As processes of their own: what the disk and the reader of the lines do."""

    def script(self, *words, name="figures.py", **options):
        done = subprocess.run(
            [sys.executable, ROOT / "tools" / name, *words], check=False, text=True, stderr=subprocess.PIPE, **options
        )
        self.assertNotIn("Traceback", done.stderr)
        return done

    def test_full_disk_keeps_the_figures_of_before(self):
        folder = copy("full")
        (folder / "convergence.png").write_text("of before")
        done = self.script(
            folder,
            "--only",
            "convergence",
            stdout=subprocess.PIPE,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)),
        )
        self.assertEqual((done.returncode, done.stderr.count("\n")), (4, 1), done.stderr)
        self.assertIn("convergence.png: cannot be written: File too large", done.stderr)
        self.assertEqual((folder / "convergence.png").read_text(), "of before")
        self.assertEqual(list(folder.glob("*.png.tmp")), [])

    def test_lines_that_nobody_takes(self):
        with Path("/dev/full").open("w") as full:
            done = self.script("runs/specimen", "--only", "trends", stdout=full)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (4, 1), done.stderr)
        read, write = os.pipe()
        os.close(read)
        done = self.script("runs/specimen", "--only", "trends", "void_ratio", stdout=write)
        os.close(write)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_a_disk_that_refuses_is_no_fault_of_the_tool(self):
        folder = copy("refusing", of="specimen")
        for number in (errno.EROFS, errno.EACCES, errno.ENOSPC, errno.EIO):
            refusal = OSError(number, os.strerror(number))
            with (
                mock.patch.object(Path, "write_bytes", side_effect=refusal),
                mock.patch.object(Path, "unlink", side_effect=refusal),
            ):
                status, _, err = call(figures, folder, "--only", "convergence")
            self.assertEqual((status, len(err)), (4, 1), err)
            self.assertIn(f"convergence.png: cannot be written: {os.strerror(number)}", err[0])
            for name, where in (("convergence.png", "--only"), ("trends.md", "--trends")):
                further = ("convergence",) if where == "--only" else ()
                with (
                    mock.patch.dict(FIGURES, {name: mock.Mock(side_effect=refusal)}),
                    mock.patch.object(trend_table, "curve", side_effect=refusal),
                ):
                    status, _, err = call(figures, "runs/coarse", where, *further)
                self.assertEqual((status, len(err)), (4, 1), err)
                self.assertIn(os.strerror(number), err[0])
            with mock.patch.object(source, "Result", side_effect=refusal):
                status, _, err = call(figures, folder)
            self.assertEqual((status, len(err)), (4, 1), err)

    def test_a_folder_that_cannot_be_made(self):
        status, out, err = call(figures, "runs/specimen", "-o", "tunnel.toml")
        self.assertEqual((status, out, len(err)), (4, [], 1))
        self.assertIn("tunnel.toml: the folder cannot be made: File exists", err[0])


class Comparisons(unittest.TestCase):
    def test_runs_that_cannot_be_compared_are_left_out(self):
        words = ("runs/coarse", "runs/stopped", "runs/none", "runs/specimen", "-o", "runs/both")
        status, out, err = call(compare_tunnels, *words, "--only", "comparison", "study")
        self.assertEqual((status, len(out), len(err)), (2, 2, 3), (out, err))
        self.assertEqual([line.split()[2].rstrip(":") for line in err], ["runs/stopped", "runs/none", "runs/specimen"])
        self.assertIn("needs two covers of dense sand", Path("runs/both/study.md").read_text())
        status, out, err = call(compare_tunnels, "runs/specimen", "-o", "runs/both")
        self.assertEqual((status, out, len(err)), (2, [], 1), (out, err))

    def test_reports_of_benchmarks(self):
        def report(**benchmark):
            return json.dumps({"context": {}, "benchmarks": [benchmark]})

        median = {"aggregate_name": "median", "run_name": "a"}
        Path("good.json").write_text(report(**median, **{"particle_steps/s": 2e6}))
        for content in ("", "{", "[]", "{}", report(**median, **{"particle_steps/s": "x"}), report()):
            Path("bad.json").write_text(content)
            status, out, err = call(compare_runs, "good.json", "bad.json")
            self.assertEqual((status, len(err)), (2, 1), content)
            self.assertEqual([line for line in out if "only in" not in line], [], content)
        status, out, err = call(compare_runs, "good.json", "none.json")
        self.assertEqual((status, out, err), (2, [], ["none.json cannot be read: No such file or directory"]))
        status, out, err = call(compare_runs, "good.json", "good.json")
        self.assertEqual((status, len(out), err), (0, 2, []))


if __name__ == "__main__":
    unittest.main()
