"""The command tools/workflow/run: lists the sweep, calls Snakemake, says in the end what has become of the runs."""

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from workflow import slurm_queue
from workflow.hold import holder_of, refusal
from workflow.sweep_list import OWN_FOLDER, ListFault, flat, marker, outcome_file, read_list

HERE = Path(__file__).resolve().parent
WRONG_INPUT, MACHINE_FAILURE, INTERRUPTED = 2, 4, 130  # exit statuses of the program (host/process/exit_code.hpp)


def arguments(words: list[str]) -> tuple[argparse.Namespace, list[str]]:
    parser = argparse.ArgumentParser(
        prog="tools/workflow/run",
        description="Runs a sweep by Snakemake; the same call goes on after a stop. Other options are Snakemake's.",
        epilog="Exit status: that of `voussoir sweep`.",
        allow_abbrev=False,
    )
    parser.add_argument("sweep", type=Path, help="sweep file")
    parser.add_argument("-o", "--output", type=Path, help="folder of the results (default: out/STEM of the sweep file)")
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--cores", type=positive, help="cores that runs may use at a time (default: all)")
    where.add_argument("--slurm", action="store_true", help="each run is a job of Slurm")
    parser.add_argument("--threads", type=positive, default=1, help="most threads of a long run (default: 1)")
    parser.add_argument(
        "--safety", type=factor, default=2.0, help="factor on the estimates of memory and time (default: 2)"
    )
    parser.add_argument(
        "--take-over", action="store_true", help="take folders over that a lost machine has not given back"
    )
    parser.add_argument("--program", help="the program (default: $VOUSSOIR, else that of build/openmp, else of PATH)")
    return parser.parse_known_args(words)


def positive(text: str) -> int:
    if int(text) < 1:
        raise ValueError
    return int(text)


def factor(text: str) -> float:
    if not 0 < float(text) < float("inf"):
        raise ValueError
    return float(text)


def program_of(given: str | None) -> str:
    built = HERE.parent.parent / "build/openmp/host/voussoir"
    named = given or os.environ.get("VOUSSOIR") or (str(built) if built.exists() else "voussoir")
    found = shutil.which(named)
    if found is None:
        raise ListFault(f"there is no program {named}: build it, or name it with --program", 2)
    return str(Path(found).resolve())


def snakemake(given: argparse.Namespace, program: str, folder: Path, further: list[str]) -> list[str]:
    """The command line of Snakemake. Options of the caller come last, so that they win."""
    config = {
        "program": program,
        "sweep": given.sweep.resolve(),
        "folder": folder,
        "start": Path.cwd(),
        "list": folder / OWN_FOLDER / "list.json",
        "threads": given.threads,
        "safety": given.safety,
        "take_over": given.take_over,
        "says_end": True,
    }
    words = [sys.executable, "-m", "snakemake", "--snakefile", str(HERE / "Snakefile")]
    words += ["--directory", str(folder / OWN_FOLDER), "--nolock", "--keep-going", "--rerun-incomplete"]
    words += ["--rerun-triggers", "params", "--scheduler", "greedy", "--quiet", "rules", "reason", "host"]
    if given.slurm:
        words += ["--profile", str(HERE / "slurm"), "--slurm-jobname-prefix", slurm_queue.prefix(folder)]
        words += ["--slurm-logdir", str(folder / OWN_FOLDER / "slurm_log")]
    else:
        memory_mb = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2**20
        cores = given.cores or len(os.sched_getaffinity(0))
        words += ["--cores", str(cores), "--resources", f"mem_mb={memory_mb}"]
    return [*words, *further, "--config", *(f"{key}={value}" for key, value in config.items())]


def call(words: list[str]) -> tuple[int, bool]:
    """Exit status of Snakemake, and whether this process was asked to stop. Snakemake and its jobs are a group of
    processes of their own, which gets each request once, as SIGINT: on SIGTERM Snakemake would wait for the runs.
    """
    process = subprocess.Popen(words, process_group=0)
    asked = False

    def stop(*_: object) -> None:
        nonlocal asked
        asked = True
        os.killpg(process.pid, signal.SIGINT)

    for request in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(request, stop)
    return process.wait(), asked


def forget_lost(folder: Path, names: list[str]) -> None:
    """Removes the markers of runs whose outcome is lost, and that of the gathering, which is done by each call."""
    own = folder / OWN_FOLDER
    for name in names:
        if not outcome_file(folder, name).exists():
            (own / marker(name)).unlink(missing_ok=True)
    for leftover in ("gathered", "gather.end"):
        (own / leftover).unlink(missing_ok=True)


def last_line(file: Path) -> str:
    lines = file.read_text(encoding="utf-8", errors="replace").split("\n") if file.exists() else []
    return next((line for line in reversed(lines) if line.strip()), "it was not begun")


def report(program: str, sweep: Path, folder: Path, names: list[str], asked: bool) -> int:
    """Says what is not done, gathers what there is, and returns the exit status of it all."""
    own = folder / OWN_FOLDER
    left = [name for name in names if not (own / marker(name)).exists()]
    for name in left if not asked else []:
        print(f"tools/workflow/run: {name}: {last_line(own / 'log' / f'{flat(name)}.log')}", file=sys.stderr)
    if left:
        print(
            f"tools/workflow/run: {len(left)} of {len(names)} runs are not done; the same call goes on", file=sys.stderr
        )
    if asked:
        return INTERRUPTED
    end = own / "gather.end"
    if end.exists():
        sys.stderr.write((own / "log/gather.log").read_text(encoding="utf-8"))
        return int(end.read_text(encoding="utf-8"))
    done = subprocess.run([program, "sweep", str(sweep), "-o", str(folder), "--gather"], check=False)
    return done.returncode


def prepare(folder: Path, listed: dict[str, Any]) -> list[str]:
    """Makes the workflow's own folder and puts the list there; returns the names of the runs."""
    own = folder / OWN_FOLDER
    own.mkdir(parents=True, exist_ok=True)
    new = own / "list.json.new"
    new.write_text(json.dumps(listed), encoding="utf-8")
    new.replace(own / "list.json")
    return [run["name"] for run in listed["runs"]]


def main() -> int:
    given, further = arguments(sys.argv[1:])
    folder = (given.output or Path("out") / given.sweep.stem).resolve()
    if holder := holder_of(folder / OWN_FOLDER / "lock"):
        print(refusal(folder, holder), file=sys.stderr)
        return WRONG_INPUT
    try:
        program = program_of(given.program)
        names = prepare(folder, read_list(program, str(given.sweep), str(folder)))
    except ListFault as fault:
        print(fault if str(fault).startswith("voussoir") else f"tools/workflow/run: {fault}", file=sys.stderr)
        return fault.code
    except OSError as fault:
        print(f"tools/workflow/run: {fault.filename}: {fault.strerror}", file=sys.stderr)
        return MACHINE_FAILURE
    words = snakemake(given, program, folder, further)
    if {"-n", "--dry-run", "--dryrun"} & set(further):
        return call(words)[0]
    try:
        if given.slurm:
            slurm_queue.wait(folder, time.sleep)
    except KeyboardInterrupt:
        return INTERRUPTED
    forget_lost(folder, names)
    code, asked = call(words)
    if asked and given.slurm:
        slurm_queue.cancel(folder)
    if code == WRONG_INPUT:
        return code  # wrong options, or another Snakemake has just begun
    end = report(program, given.sweep, folder, names, asked)
    return end or (MACHINE_FAILURE if code else 0)


if __name__ == "__main__":
    sys.exit(main())
