"""Runs from Python: a result, or the exception of the exit status with file, line and key; Ctrl-C ends a run after its
increment and it goes on; progress in a terminal, in a notebook, by a function."""

import os
import signal
import subprocess
import sys
import threading
import time
import types
import unittest
from pathlib import Path
from typing import Any
from unittest import mock

sys.path.insert(0, str(Path(os.environ["VOUSSOIR_ROOT"]) / "python"))

import numpy as np
import tiny_results
import voussoir
from program import PROGRAM, ROOT, check_same, fresh, run
from voussoir import programs, progress
from voussoir.settings import as_texts

LONG = {"volume_loss.increments": 1000, "volume_loss.total": "2 %"}


def setUpModule():
    for folder in ("runs", "out", "packings", "places"):
        fresh(folder)
    Path("tunnel.toml").write_text(tiny_results.GROUND)
    Path("specimen.toml").write_text(tiny_results.SPECIMEN)
    Path("sweep.toml").write_text(tiny_results.SWEEP)


def interrupt_at(file):
    """Presses Ctrl-C as soon as a file is there."""

    def wait():
        deadline = time.monotonic() + 120
        while not Path(file).exists() and time.monotonic() < deadline:
            time.sleep(0.01)
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=wait)
    thread.start()
    return thread


class Ends(unittest.TestCase):
    def test_a_run_gives_its_result(self):
        lines: list[str] = []
        result = voussoir.run("specimen.toml", "runs/good", progress=lines.append)
        run([PROGRAM, "run", "specimen.toml", "-o", "runs/by_hand"])
        check_same("runs/good", "runs/by_hand")
        self.assertAlmostEqual(result.increments[-1]["load_parameter"], 0.002)
        self.assertTrue(any(line.startswith("biaxial_bvp 2/2: at 0.002") for line in lines), lines)
        again = voussoir.run("specimen.toml", "runs/good", resume=True, progress=lines.append)
        self.assertIn("there is nothing to do", lines[-1])
        self.assertEqual(len(again.increments), 2)
        with self.assertRaisesRegex(voussoir.InputError, "holds results already"):
            voussoir.run("specimen.toml", "runs/good")
        once = voussoir.run("specimen.toml", "runs/good", replace=True, settings=["biaxial_bvp.strain=0.001"])
        self.assertEqual(len(once.increments), 1)

    def test_wrong_input_names_file_line_and_key(self):
        text = tiny_results.GROUND.replace('diameter = "5 m"', 'diameter = "5 stones"')
        Path("wrong.toml").write_text(text)
        with self.assertRaisesRegex(voussoir.InputError, 'unknown unit "stones"') as caught:
            voussoir.run("wrong.toml", "runs/wrong")
        error = caught.exception
        line = text.splitlines().index('diameter = "5 stones"') + 1
        self.assertEqual((error.file, error.line, error.key), ("wrong.toml", line, "ground.diameter"))
        self.assertEqual((error.place, error.folder), (f"wrong.toml:{line}", Path("runs/wrong")))
        self.assertIsInstance(error, ValueError)
        with self.assertRaises(voussoir.InputError) as caught:
            voussoir.run("tunnel.toml", "runs/wrong", settings={"ground.width": "3 mm"})
        error = caught.exception
        self.assertEqual((error.place, error.file, error.key), ("--set", None, "ground.width"))
        with self.assertRaisesRegex(voussoir.InputError, "no_such.toml: cannot be read"):
            voussoir.run("no_such.toml")
        self.assertFalse(Path("runs/wrong").exists())

    def test_no_equilibrium_keeps_what_is_good(self):
        with self.assertRaisesRegex(voussoir.NoEquilibrium, "biaxial_bvp failed: .*; results up to there: ") as caught:
            voussoir.run("specimen.toml", "runs/hasty", settings=tiny_results.FAULT, threads=1)
        self.assertTrue(any("threads: 1 (--threads)" in line for line in caught.exception.lines))
        self.assertEqual(voussoir.open_result(caught.exception.folder).kind, "biaxial_bvp")

    def test_the_machine_and_other_signals(self):
        with self.assertRaisesRegex(voussoir.Error, "no_program is no program that can be run"):
            voussoir.run("tunnel.toml", program="no_program")
        Path("killed").write_text("#!/bin/sh\nkill -9 $$\n")
        Path("stopped").write_text("#!/bin/sh\necho a line\nexit 130\n")
        Path("failed").write_text("#!/bin/sh\necho 'voussoir: run.h5: No space left on device' >&2\nexit 4\n")
        for name, kind, sentence in (
            ("killed", voussoir.MachineFailure, "SIGKILL ended the program; resume=True"),
            ("stopped", voussoir.Interrupted, "a signal stopped the run in runs/x"),
            ("failed", voussoir.MachineFailure, "^run.h5: No space left on device$"),
        ):
            Path(name).chmod(0o755)
            with self.assertRaisesRegex(kind, sentence):
                voussoir.run("tunnel.toml", "runs/x", program=f"./{name}")

    def test_packings_ensembles_and_sweeps(self):
        case = ROOT / "cases/pack/case.toml"
        settings = {"packing.grains": 60, "packing.seeds": np.arange(1, 3), "packing.folder": "packings"}
        self.assertEqual(len(voussoir.run(case, settings=settings).packings), 2)
        bands = voussoir.ensemble("specimen.toml", members=2, jobs=2, settings=["output.rves=[]"])
        self.assertEqual((bands.count, bands.folder), (2, Path("out/specimen_ensemble")))
        with self.assertRaises(voussoir.NoEquilibrium) as caught:
            voussoir.sweep("sweep.toml", jobs=2)
        self.assertEqual(caught.exception.folder, Path("out/sweep"))
        finished = voussoir.open_sweep(caught.exception.folder).result("grid/patient")
        self.assertEqual(len(finished.increments), 2)


class CtrlC(unittest.TestCase):
    def test_a_run_stops_after_its_increment_and_goes_on(self):
        thread = interrupt_at("runs/stopped/increments/0012.h5")
        with self.assertRaisesRegex(KeyboardInterrupt, "the run in runs/stopped has stopped; resume=True goes on"):
            voussoir.run("tunnel.toml", "runs/stopped", settings=LONG)
        thread.join()
        result = voussoir.open_result("runs/stopped")
        self.assertLess(12, len(result.increments))
        self.assertLess(len(result.increments), 500)
        self.assertFalse(result.is_running)
        thread = interrupt_at(f"runs/stopped/increments/{len(result.increments) + 10:04}.h5")
        with self.assertRaises(KeyboardInterrupt):
            voussoir.run("tunnel.toml", "runs/stopped", settings=LONG, resume=True)
        thread.join()
        self.assertLess(len(result.increments), len(voussoir.open_result("runs/stopped").increments))

    def test_an_error_of_the_progress_stops_the_run(self):
        def broken(line):
            if line.startswith("gravity 1/"):
                raise ZeroDivisionError(line)

        with self.assertRaises(ZeroDivisionError):
            voussoir.run("tunnel.toml", "runs/broken", settings=LONG, progress=broken)
        self.assertFalse(voussoir.open_result("runs/broken/column").is_running)
        self.assertFalse(Path("runs/broken/run.lock").exists())


class Progress(unittest.TestCase):
    def test_a_line_in_a_terminal(self):
        environment = {**os.environ, "PYTHONPATH": str(ROOT / "python"), "COLUMNS": "60"}

        def said(how):
            words = [sys.executable, "-c", f"import voussoir; voussoir.run('specimen.toml', 'runs/shown', {how})"]
            done = subprocess.run(words, check=True, capture_output=True, timeout=60, env=environment)
            return done.stdout, done.stderr.decode().split("\r")

        out, shown = said("progress=True")
        self.assertTrue(any(line.startswith("biaxial_bvp 2/2  at") for line in shown), shown)
        self.assertLessEqual(max(map(len, shown)), 60)
        self.assertEqual((out, shown[-2].strip(), shown[-1]), (b"", "", ""))
        self.assertEqual(said("resume=True"), (b"", [""]))  # neither a terminal nor a notebook

    def test_a_bar_in_a_notebook(self):
        shown: list[str] = []
        output = types.SimpleNamespace(update=shown.append)
        ipython: Any = types.ModuleType("IPython")
        ipython.get_ipython = lambda: types.SimpleNamespace(kernel=1)
        ipython.display = types.ModuleType("IPython.display")
        ipython.display.HTML = str
        ipython.display.display = lambda text, **_: (shown.append(text), output)[1]  # type: ignore[func-returns-value]
        with mock.patch.dict(sys.modules, {"IPython": ipython, "IPython.display": ipython.display}):
            self.assertIsInstance(progress.progress_of(None, "x"), progress.Notebook)
            voussoir.run("specimen.toml", "runs/bar")
        self.assertTrue(any('<progress value="1" max="2"></progress> biaxial_bvp' in text for text in shown), shown)
        self.assertIn("ended: ", shown[-1])
        self.assertIsInstance(progress.progress_of(None, "x"), progress.Silent)


class Words(unittest.TestCase):
    def test_settings(self):
        settings = {
            "soil": {"friction": "30 deg"},
            "packing.seeds": np.arange(1, 3),
            "a.b": True,
            "biaxial.pressures": ["1 kPa"],
        }
        wanted = ["soil.friction=30 deg", "packing.seeds=[1, 2]", "a.b=true", 'biaxial.pressures=["1 kPa"]']
        self.assertEqual(as_texts(settings), wanted)
        self.assertEqual(as_texts(["a=1"]), ["a=1"])

    def test_the_program_is_found(self):
        with mock.patch.dict(os.environ, {"VOUSSOIR": "", "PATH": str(Path(PROGRAM).parent)}):
            self.assertEqual(programs.find_program(), Path(PROGRAM))
        with mock.patch.dict(os.environ, {"VOUSSOIR": PROGRAM, "PATH": ""}):
            self.assertEqual(programs.find_program(), Path(PROGRAM))
        with mock.patch.object(programs, "__file__", str(Path("nowhere/deep/voussoir/programs.py").absolute())):
            with mock.patch.dict(os.environ, {"VOUSSOIR": "", "PATH": ""}):
                self.assertRaisesRegex(voussoir.Error, "is not found: name it", programs.find_program)
            for package, program in (
                ("checkout/python", "checkout/build/openmp/host/voussoir"),
                ("tree/build/openmp/python", "tree/build/openmp/host/voussoir"),
                ("prefix/share/voussoir/python", "prefix/bin/voussoir"),
            ):
                built = Path("places", program).absolute()
                built.parent.mkdir(parents=True)
                built.symlink_to(PROGRAM)
                there = Path("places", package, "voussoir", "programs.py").absolute()
                with (
                    mock.patch.object(programs, "__file__", str(there)),
                    mock.patch.dict(os.environ, {"VOUSSOIR": "", "PATH": ""}),
                ):
                    self.assertEqual(programs.find_program(), built)


if __name__ == "__main__":
    unittest.main()
