"""The jobs of Slurm that a killed call has left in the queue: the next call waits until they are gone, since each of
them is a run that would have two jobs."""

import hashlib
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

SECONDS = 10.0  # between two looks at the queue


def prefix(folder: Path) -> str:
    """The beginning of the names of all jobs of this folder."""
    return "voussoir-" + hashlib.sha256(str(folder).encode()).hexdigest()[:12]


def jobs_of(folder: Path) -> list[str]:
    """Numbers of the jobs in the queue; none where there is no squeue."""
    try:
        done = subprocess.run(
            ["squeue", "--me", "--noheader", "--format=%A %j"], capture_output=True, text=True, check=False
        )
    except OSError:
        return []
    rows = [line.split(maxsplit=1) for line in done.stdout.splitlines()]
    return [row[0] for row in rows if len(row) == 2 and row[1].startswith(prefix(folder))]


def cancel(folder: Path) -> None:
    """Cancels the jobs of this folder. Snakemake does so when it is stopped, but not for jobs whose state it is just
    asking for."""
    if jobs := jobs_of(folder):
        subprocess.run(["scancel", *jobs], check=False)


def wait(folder: Path, sleep: Callable[[float], None]) -> None:
    """Returns when the queue holds no job of this folder."""
    said = False
    while jobs := jobs_of(folder):
        if not said:
            print(
                f"tools/workflow/run: waits for {len(jobs)} jobs of an earlier call; `scancel {' '.join(jobs)}` ends "
                "them, and their checkpoints stay",
                file=sys.stderr,
            )
            said = True
        sleep(SECONDS)
