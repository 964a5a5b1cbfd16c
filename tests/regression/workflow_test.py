"""tools/workflow on this machine: a sweep whose Snakemake was killed goes on, waits for a run that has survived, names
the run that finds no equilibrium, and leaves the folder of `voussoir sweep`; wrong input is told in one line."""

import fcntl
import os
import shlex
import signal
from pathlib import Path

from program import PROGRAM, check, fresh, run, wait_until
from tiny_sweep import (
    DEPTHS,
    by_workflow,
    check_same_sweeps,
    end,
    kill,
    need_snakemake,
    outcomes,
    process_of,
    start,
    write_sweep,
)

need_snakemake()
SWEEP = write_sweep("depths.toml", depth=DEPTHS)
FAILED = "tunnels/deep"


def refused(sentence, *words):
    done = run([*by_workflow(*words[:2]), *words[2:]], code=2)
    check(sentence in done.stderr and done.stderr.count("\n") == 1, f"{words}: not one line: {done.stderr}")


def in_own_session():
    """A program that does the same in a session of its own. When Snakemake's death orphans its group of processes, the
    kernel wakes and ends the halted processes of that group, and this program is not one of them."""
    script = Path("in_own_session").resolve()
    script.write_text(f'#!/bin/sh\nexec setsid {shlex.quote(PROGRAM)} "$@"\n')
    script.chmod(0o755)
    return str(script)


def killed_with_survivor():
    """Halts the run of a fresh folder and kills its Snakemake: the folder, the run's process and the text of its lock.
    None where the run has come to its end before it was halted, as on a fast machine."""
    swept = fresh("swept")
    words = [*by_workflow(SWEEP, swept, "--cores", "1"), "--program", in_own_session()]
    first = start(words, "first.log")
    lock = swept / "tunnels/middle/run.lock"
    wait_until(lambda: process_of(lock), first, "run")
    run_of_middle = process_of(lock)
    text = lock.read_text()
    try:
        os.kill(run_of_middle, signal.SIGSTOP)
    except ProcessLookupError:
        run_of_middle = None
    kill(first, swept, all_jobs=False)
    return (swept, run_of_middle, text) if run_of_middle and "tunnels__middle" not in outcomes(swept) else None


# Wrong input.
fresh("refused")
refused("nowhere.toml", "nowhere.toml", "refused")
refused("there is no program no_such_program", SWEEP, "refused", "--program", "no_such_program")
refused("is of another version", SWEEP, "refused", "--program", "true")
check(not Path("refused").exists(), "a refused call left a folder")
Path("file").touch()
done = run(by_workflow(SWEEP, "file"), code=4)
check("file/.workflow: Not a directory" in done.stderr and done.stderr.count("\n") == 1, f"not one line: {done.stderr}")

# Snakemake is killed, a run survives, and the next call waits for it.
found = next(filter(None, (killed_with_survivor() for _ in range(10))), None)
check(found is not None, "in ten tries no run has survived its Snakemake")
assert found is not None
swept, survivor, lock_text = found
second = start(by_workflow(SWEEP, swept, "--cores", "2"), "second.log")
wait_until(lambda: "waits: " in Path("second.log").read_text(), second, "run that waits")
os.kill(survivor, signal.SIGCONT)
said = end(second, 3, "second.log")
check(f"{FAILED} (no equilibrium)" in said.splitlines()[-1], f"the failed run is not named at the end: {said[-500:]}")
check(outcomes(swept) == {"tunnels__near": 0, "tunnels__middle": 0, "tunnels__deep": 3}, f"{outcomes(swept)}")

# The same by the program's own processes.
own = fresh("own")
run([PROGRAM, "sweep", str(SWEEP), "-o", str(own), "-j", "2", "--threads", "1"], code=3)
check_same_sweeps(own, swept)

# A call after the end has nothing to run, and says again what failed.
said = end(start(by_workflow(SWEEP, swept), "third.log"), 3, "third.log")
check(FAILED in said.splitlines()[-1] and ": finished" not in said, f"a finished sweep has run again: {said}")

# A lock of another machine: the job fails, the line says what to do, and --take-over does it.
(swept / ".workflow/done/tunnels__near").unlink()
(swept / "tunnels/near/run.lock").write_text(lock_text.replace(f"host {os.uname().nodename}\n", "host elsewhere\n"))
said = end(start(by_workflow(SWEEP, swept), "elsewhere.log"), 2, "elsewhere.log")
check("1 of 3 runs are not done" in said and "add --take-over" in said, f"the lock is not named: {said[-800:]}")
end(start(by_workflow(SWEEP, swept, "--take-over"), "taken.log"), 3, "taken.log")

# One Snakemake at a time.
with (swept / ".workflow/lock").open("a") as lock:
    fcntl.flock(lock, fcntl.LOCK_EX)
    said = end(start(by_workflow(SWEEP, swept), "refused.log"), 2, "refused.log")
    check("swept: is held by process" in said.splitlines()[-1], f"the holder is not named: {said}")
