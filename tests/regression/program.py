"""What the regression tests share: running the program, waiting for its files, comparing results.

VOUSSOIR is the program, VOUSSOIR_ROOT the checkout; ctest sets both.
"""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(os.environ["VOUSSOIR_ROOT"])
PROGRAM = os.environ["VOUSSOIR"]
# All that two equal runs may differ in.
NOT_COMPARED = {"wall_s", "peak_memory", "time_grains", "time_tangents", "time_assembly", "time_solve", "time_output"}
# A tunnel of grains that takes seconds, in cases/tunnel_quick; the number of its loss increments is left to the test.
SMALL_TUNNEL = [
    "packing.grains=100",
    "packing.candidates=1",
    "packing.variety=1",
    "packing.folder=packings",
    "ground.mesh_size_opening=2.5 m",
    "ground.mesh_size_far=8 m",
    "column.elements=4",
    "gravity.ratio=2",
    "gravity.uniform_step=0.3",
    "volume_loss.total=0.5 %",
    "newton.tolerance=0.01",
    "output.rves=[3, 4]",
]


def command(case, folder, settings=(), *further):
    words = [PROGRAM, "run", str(ROOT / "cases" / case / "case.toml"), "-o", str(folder), *further]
    for setting in settings:
        words += ["--set", setting]
    return words


def run(words, code=0, timeout=280):
    """Runs to the end and checks the exit code, unless it is None."""
    done = subprocess.run(words, check=False, capture_output=True, text=True, timeout=timeout)
    check(
        code is None or done.returncode == code,
        f"{' '.join(words)}: exit {done.returncode} instead of {code}\n{done.stdout}{done.stderr}",
    )
    return done


def wait_until(holds, process, what):
    """Waits until `holds` does, which it must do within two minutes and before the process ends."""
    deadline = time.monotonic() + 120
    while not holds():
        check(process.poll() is None, f"the process ended with {process.returncode} before there was {what}")
        check(time.monotonic() < deadline, f"there was no {what} within two minutes")
        time.sleep(0.002)


def start_and_signal(words, wait_for, signal):
    """Starts a run, waits until a file exists, sends a signal; returns the exit code."""
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wait_until(Path(wait_for).exists, process, wait_for)
    process.send_signal(signal)
    return process.wait(timeout=120)


def ended_or_killed(words, seconds):
    """Starts a run and kills it after so many seconds with -9; True where it was killed. A run that comes to its end
    before must end well."""
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    try:
        said = process.communicate(timeout=seconds)[1]
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return True
    check(process.returncode == 0, f"{' '.join(words)}: ended with {process.returncode}: {said}")
    return False


def draw_and_read_back(folder, figures):
    """The figures named are drawn, and VTK reads every field and time of the XDMF file (skipped where there is no
    VTK)."""
    drawn = run([sys.executable, str(ROOT / "tools/figures.py"), str(folder)])
    for name in figures:
        file, least = Path(folder) / name, 10000 if name.endswith(".png") else 500
        check(file.exists() and file.stat().st_size > least, f"{folder}: {name} was not drawn: {drawn.stdout}")
    read = subprocess.run(
        [sys.executable, str(ROOT / "tools/xdmf_check.py"), str(folder)],
        check=False,
        capture_output=True,
        text=True,
        timeout=120,
    )
    check(read.returncode in (0, 77), f"{folder}: {read.stderr}")
    print((read.stdout.splitlines() or [""])[-1])


def fresh(name):
    """An empty folder name below the test's working folder."""
    folder = Path(name)
    shutil.rmtree(folder, ignore_errors=True)
    return folder


def check(holds, sentence):
    if not holds:
        print(f"FAILED: {sentence}", file=sys.stderr)
        sys.exit(1)


def content(file):
    """Every dataset and attribute of a file, as bytes, by path; links to other files are not followed."""
    found = {}

    def visit(name, item):
        for key, value in item.attrs.items():
            if key not in NOT_COMPARED:
                found[f"{name}@{key}"] = np.asarray(value).tobytes()
        if isinstance(item, h5py.Dataset) and name.rsplit("/", 1)[-1] not in NOT_COMPARED:
            found[name] = np.asarray(item[()]).tobytes()

    with h5py.File(file, "r") as opened:
        visit("", opened)
        opened.visititems(visit)
    return found


def check_same(first, second, but=()):
    """Two result folders hold the same bits: every increment, and run.h5 but for its provenance and the datasets
    `but`."""
    names = [sorted(p.relative_to(folder).as_posix() for p in Path(folder).rglob("*.h5")) for folder in (first, second)]
    check(names[0] == names[1], f"{first} and {second} hold different files: {names[0]} and {names[1]}")
    for name in names[0]:
        left, right = content(Path(first) / name), content(Path(second) / name)
        check(left.keys() == right.keys(), f"{name}: other datasets: {left.keys() ^ right.keys()}")
        different = [key for key in left if left[key] != right[key] and not key.startswith("provenance")]
        different = [key for key in different if key not in but]
        check(not different, f"{name}: {different} differ")
    print(f"{first} and {second}: {len(names[0])} files with the same bits")


def table(folder):
    """Rows of run.h5:/table as dictionaries."""
    with h5py.File(Path(folder) / "run.h5", "r") as opened:
        columns = {name: data[()] for name, data in opened["table"].items()}
    count = len(columns.get("index", []))  # no columns as long as there is no increment
    rows = [{name: values[k] for name, values in columns.items()} for k in range(count)]
    for row in rows:
        row["stage"] = row["stage"].decode() if isinstance(row["stage"], bytes) else row["stage"]
    return rows
