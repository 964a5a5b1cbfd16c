"""One job of the workflow: calls the program, and turns its end into one for Snakemake.

    job.py --start DIR --log FILE --outcome FILE -- PROGRAM sweep SWEEP -o DIR --only NAME ...
    job.py --start DIR --log FILE --end FILE -- PROGRAM sweep SWEEP -o DIR --gather

The program's end 0, 2 or 3 is no failure of the job, because another try would not change it. With --outcome, the
program must have written this file, which says how the run ended; --end names a file that then holds the exit
status. 4, 130 and a signal are failures: the job has no marker, and the next call goes on from the checkpoint.
--start is the folder in which the workflow was called, and so the program: its packings are where they are without a
workflow.

A folder that another process holds is waited for: a run that survived a killed Snakemake works there, or the sweep's
own `voussoir sweep`. This file needs nothing but Python's own library, because it starts on each machine of a
cluster.
"""

import argparse
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import TextIO

# Of host/record/run_lock.cpp: a process that runs holds the folder, or the folder above it.
HELD = re.compile(r"is held by .+, which runs$", re.MULTILINE)
# A lock of a machine that nobody can ask: not an outcome of the run, and not waited for.
NOT_GIVEN_BACK = re.compile(r"was not given back by .+ add --take-over", re.MULTILINE)
WAIT_S = 2.0
RECORDED = (0, 2, 3)


def call_once(command: list[str], start: Path, log: TextIO) -> tuple[int, str]:
    """Exit status (128 + its number for a signal) and standard error, which goes to the log as well. A request to stop
    is passed on as SIGUSR1, which does no harm to a program that has had the same signal as this process."""
    process = subprocess.Popen(command, cwd=start, stdout=log, stderr=subprocess.PIPE, text=True)
    for request in (signal.SIGINT, signal.SIGTERM, signal.SIGUSR1):
        signal.signal(request, lambda *_: process.send_signal(signal.SIGUSR1))
    said = ""
    assert process.stderr is not None
    for line in process.stderr:
        said += line
        log.write(line)
        log.flush()
    code = process.wait()
    return (code if code >= 0 else 128 - code), said


def call(command: list[str], start: Path, log: TextIO, name: str) -> tuple[int, str]:
    """As call_once, but again and again as long as another process holds the folder."""
    waits = False
    while True:
        code, said = call_once(command, start, log)
        if code != 2 or not HELD.search(said):
            return code, said
        if not waits:
            print(f"{name}: waits: {said.strip().splitlines()[-1]}", flush=True)
            waits = True
        time.sleep(WAIT_S)


def stamp(file: Path) -> tuple[int, int] | None:
    """What changes when a file is written anew."""
    try:
        return file.stat().st_ino, file.stat().st_mtime_ns
    except FileNotFoundError:
        return None


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--start", type=Path, required=True)
    parser.add_argument("--log", type=Path, required=True)
    kind = parser.add_mutually_exclusive_group(required=True)
    kind.add_argument("--outcome", type=Path)
    kind.add_argument("--end", type=Path)
    parser.add_argument("command", nargs="+")
    given = parser.parse_args()
    before = stamp(given.outcome) if given.outcome else None
    name = given.log.stem.replace("__", "/")
    with given.log.open("w", encoding="utf-8") as log:
        code, said = call(given.command, given.start, log, name)
    if given.end:
        given.end.write_text(f"{code}\n", encoding="utf-8")
        return 0 if code in RECORDED else code
    reason = (said.strip().splitlines() or [""])[-1]
    print(f"{name}: {'finished' if code == 0 else f'exit status {code}: {reason}'}", flush=True)
    recorded = stamp(given.outcome) not in (None, before) and not NOT_GIVEN_BACK.search(said)
    return 0 if code in RECORDED and recorded else code or 4


if __name__ == "__main__":
    sys.exit(main())
