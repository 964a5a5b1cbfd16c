"""Runs of several ranks, for the tests that spread RVEs over processes."""

import os
import shutil
import subprocess
import time
from pathlib import Path

from program import PROGRAM, check

# The container of a test has few cores and knows no user but root.
os.environ |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def skip_without_mpi():
    version = subprocess.run([PROGRAM, "--version"], check=False, capture_output=True, text=True).stdout
    if "no MPI" in version or shutil.which("mpirun") is None:
        print(f"skipped: {version.strip()}")
        raise SystemExit(77)


def on_ranks(n, words):
    """A command on n ranks of this machine."""
    return ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(n), *words]


def start(words, wait_for):
    """A run under mpirun, once it has written a file."""
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 120
    while not Path(wait_for).exists():
        check(process.poll() is None and time.monotonic() < deadline, f"{wait_for} did not appear: {process.stderr}")
        time.sleep(0.002)
    return process


def worker(process):
    """Process id of the second rank."""
    for child in Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split():
        if b"OMPI_COMM_WORLD_RANK=1" in Path(f"/proc/{child}/environ").read_bytes().split(b"\0"):
            return int(child)
    raise SystemExit("FAILED: no second rank")


def end(process, code):
    """Waits for all ranks; returns what the program (not mpirun) said on stderr."""
    errors = process.communicate(timeout=100)[1]
    check(process.returncode == code, f"mpirun ended with {process.returncode} instead of {code}: {errors}")
    return [line for line in errors.splitlines() if "voussoir: " in line or "resume" in line or "equilibrium" in line]
