"""The runs of a sweep as the program lists them (`voussoir sweep F -o DIR --list --json`), what a job of each may take,
and where the workflow keeps its own files."""

import json
import math
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

OWN_FOLDER = ".workflow"  # below the sweep's folder; the name of no run begins with a dot
HOURS_OF_A_THREAD = 1.0  # a run that takes longer gets a further thread, up to the largest number
LEAST_MINUTES = 10  # the time limit of the shortest job: start of the processes, waiting for a packing of another run
MORE_MEMORY_MB = 500  # of a job's two Python processes (120 MB each, measured) and the program's libraries


class ListFault(Exception):
    """The program gave no list. The text is what it said, `code` its exit status."""

    def __init__(self, text: str, code: int) -> None:
        super().__init__(text)
        self.code = code


@dataclass(frozen=True)
class Needs:
    """What a job asks for."""

    threads: int
    memory_mb: int
    minutes: int


def read_list(program: str, sweep: str, folder: str) -> dict[str, Any]:
    """The program's list: "runs" with name, fingerprint, memory_mb [MB], core_hours [h] and more, each a dictionary."""
    words = [program, "sweep", sweep, "-o", folder, "--list", "--json"]
    try:
        done = subprocess.run(words, check=False, capture_output=True, text=True)
    except OSError as fault:
        raise ListFault(f"{program} cannot be started: {fault.strerror}", 2) from fault
    if done.returncode != 0:
        raise ListFault(done.stderr.strip() or f"{program} ended with {done.returncode}", done.returncode)
    try:
        listed: dict[str, Any] = json.loads(done.stdout)
        for run in listed["runs"]:
            _ = run["name"], run["fingerprint"], run["memory_mb"], run["core_hours"]
    except (json.JSONDecodeError, KeyError, TypeError) as fault:
        raise ListFault(f"{program} is of another version: its list of the sweep cannot be read", 2) from fault
    return listed


def runs_of(config: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """The runs by name: from the file that config["list"] names, which tools/workflow/run has written; without it, from
    the program."""
    if "list" in config:
        listed = json.loads(Path(config["list"]).read_text(encoding="utf-8"))
    else:
        listed = read_list(config["program"], config["sweep"], config["folder"])
    return {run["name"]: run for run in listed["runs"]}


def needs_of(run: Mapping[str, Any], most_threads: int, safety: float) -> Needs:
    """What a job of this run asks for; `safety` multiplies the estimates of memory and of time."""
    hours = float(run["core_hours"])
    threads = max(1, min(most_threads, math.ceil(hours / HOURS_OF_A_THREAD)))
    return Needs(
        threads=threads,
        memory_mb=math.ceil(safety * float(run["memory_mb"])) + MORE_MEMORY_MB,
        minutes=math.ceil(60 * safety * hours / threads) + LEAST_MINUTES,
    )


def flat(name: str) -> str:
    """The name of a run as the name of a file, as the program has it in DIR/outcomes."""
    return name.replace("/", "__")


def marker(name: str) -> str:
    """The file that says that a run needs no further job, relative to the workflow's own folder."""
    return f"done/{flat(name)}"


def outcome_file(folder: Path, name: str) -> Path:
    """The file in which the program says how a run ended."""
    return folder / "outcomes" / f"{flat(name)}.json"
