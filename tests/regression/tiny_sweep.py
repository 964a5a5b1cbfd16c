"""What the tests of sweeps and of their workflow share: sweeps of tiny tunnels, calls of tools/workflow/run, and the
comparison of two sweeps' folders."""

import csv
import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import h5py
from program import NOT_COMPARED, PROGRAM, ROOT, SMALL_TUNNEL, check, check_same

SETTINGS = [
    *SMALL_TUNNEL,
    "packing.grains=60",
    "gravity.uniform_step=0.5",
    "volume_loss.increments=2",
    "output.rves=[]",
    "newton.relax_substeps=0",
    "newton.smallest_cut=1",
]
# One iteration is too few for any increment. A later axis takes the fault back where its value repairs it.
FAULT, REPAIR = "newton.maximum_iterations=1", "newton.maximum_iterations=20"
DEPTHS = {
    "near": ["ground.cover_ratio=1"],
    "middle": ["ground.cover_ratio=1.5"],
    "deep": ["ground.cover_ratio=2", FAULT],
}
SOILS = {"dense": ["packing.consolidation_friction=0", REPAIR], "loose": ["packing.consolidation_friction=0.3"]}
DRAWS = {"one": ["packing.seed=1", REPAIR], "two": ["packing.seed=2"]}

ENTRY = ROOT / "tools/workflow/run"
SNAKEMAKE = ROOT / ".prefix/workflow/bin/snakemake"


def need_snakemake():
    """Ends the test as skipped where tools/setup was called without --workflow."""
    if not SNAKEMAKE.exists():
        print("skipped: tools/setup --workflow has not been called")
        sys.exit(77)


def write_sweep(file, **axes):
    """A sweep over named axes: each is a dictionary of names and their overrides."""
    text = f"base = {json.dumps(str(ROOT / 'cases/tunnel_quick/case.toml'))}\nset = {json.dumps(SETTINGS)}\n\n"
    text += '[grid]\nname = "tunnels"\n'
    for axis, values in axes.items():
        text += f"\n[grid.{axis}]\n" + "".join(f"{name} = {json.dumps(value)}\n" for name, value in values.items())
    Path(file).write_text(text)
    return Path(file)


def by_workflow(sweep, folder, *words):
    return [str(ENTRY), str(sweep), "-o", str(folder), "--program", PROGRAM, *words]


def start(words, log, **environment):
    """Starts a workflow in the background; its output goes to the file `log`."""
    with Path(log).open("w") as out:
        return subprocess.Popen(words, stdout=out, stderr=subprocess.STDOUT, env={**os.environ, **environment})


def end(process, code, log, timeout=900):
    """Waits for the end of a workflow and returns its output."""
    process.wait(timeout=timeout)
    said = Path(log).read_text()
    check(process.returncode == code, f"{log}: exit {process.returncode} instead of {code}:\n{said[-3000:]}")
    check("Traceback" not in said, f"{log} has a traceback:\n{said[-3000:]}")
    return said


def process_of(lock):
    """The process that a lock file of the program or of the workflow names; None where there is none yet."""
    text = Path(lock).read_text() if Path(lock).exists() else ""
    return int(text.split("process ")[1].split()[0]) if "process " in text else None


def kill(process, folder, all_jobs):
    """kill -9 of a workflow and of its Snakemake, and of all its jobs or of none."""
    process.kill()
    process.wait()
    snakemake = process_of(folder / ".workflow/lock")
    (os.killpg if all_jobs else os.kill)(snakemake, signal.SIGKILL)


def outcomes(folder):
    """Exit codes by the names of outcome files."""
    return {file.stem: json.loads(file.read_text())["exit_code"] for file in (folder / "outcomes").glob("*.json")}


def rows(folder):
    """summary.csv without what two equal sweeps may differ in."""
    with (folder / "summary.csv").open() as opened:
        return [{key: value for key, value in row.items() if key not in NOT_COMPARED} for row in csv.DictReader(opened)]


def files(folder):
    found = (path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    return sorted(path.as_posix() for path in found if path.parts[0] != ".workflow")


def reasons(folder):
    """Why runs failed, without the place of the folder, which some reasons name."""
    with h5py.File(folder / "sweep.h5") as opened:
        said = [reason.decode() for reason in opened["runs/reason"][()]]
    return [re.sub(r"\S*/(?=tunnels/)", "", reason) for reason in said]


def check_same_sweeps(first, second):
    """Two folders of a sweep hold the same files, the same ends and the same numbers."""
    check(files(first) == files(second), f"other files: {set(files(first)) ^ set(files(second))}")
    check(outcomes(first) == outcomes(second), f"other outcomes: {outcomes(first)} and {outcomes(second)}")
    check(rows(first) == rows(second), f"other rows of summary.csv: {rows(first)} and {rows(second)}")
    check(reasons(first) == reasons(second), f"other reasons: {reasons(first)} and {reasons(second)}")
    check_same(first, second, but=["runs/reason"])
