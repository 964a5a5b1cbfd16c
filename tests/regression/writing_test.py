"""Files that are written while the run computes its next increment: what a slow or failing disk, a request to stop and
a kill leave behind in that moment. `--resume` reaches the bits of a straight run from there.

The library of tests/faults makes one call of the thread that writes slow, so that the run is an increment ahead of it.
"""

import os
import signal
import subprocess
import time
from pathlib import Path

from faulty_disk import COARSE, GRAINS, Scenario, check_equal, faults, started
from program import check, fresh

DELAY = 1000  # ms; an increment takes some 10 ms, one of grains some 100 ms
CHECKPOINTS = "{root}/result/checkpoints/*"
LOSS = ["volume_loss.total=0.5 %", "volume_loss.increments=8"]
SCENARIOS = {
    "elastic": Scenario("tunnel_elastic", [*COARSE, "gravity.uniform_step=0.2", *LOSS]),
    "grains": Scenario("tunnel_quick", [*COARSE, "gravity.uniform_step=1", *LOSS, *GRAINS]),
}


def straight(name):
    """A run that nothing disturbs, and the calls that write the checkpoints of gravity and volume loss."""
    root = fresh(f"straight_{name}")
    root.mkdir()
    calls = root / "calls"
    pattern = CHECKPOINTS.format(root=root.resolve())
    done = started(root, SCENARIOS[name].words(root), pattern, count=str(calls.resolve()))
    check(done.returncode in (0, 3), f"{name}: the straight run ended with {done.returncode}: {done.stderr}")
    lines = calls.read_text().splitlines()[1:]
    calls.unlink()
    return lines, done.returncode


def number_of(calls, kind, which):
    """The number of the call of this kind that writes the which-th checkpoint."""
    return [at for at, call in enumerate(calls, start=1) if call.startswith(kind) and call.endswith(".tmp")][which]


def begun(name, what, **how):
    """A run with a disturbed disk, and a profiler that counts the increments whose output was begun."""
    root = fresh(f"{name}_{what}")
    root.mkdir()
    environment = faults(CHECKPOINTS.format(root=root.resolve()), delay=DELAY, **how) | {
        "KOKKOS_TOOLS_LIBS": os.environ["VOUSSOIR_REGION_TOOL"],
        "VOUSSOIR_REGION_LOG": str((root / "regions").resolve()),
    }
    words = SCENARIOS[name].words(root)
    return root, subprocess.Popen(
        words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env=environment, cwd=root
    )


def ended(process, code):
    said = process.communicate(timeout=120)[1]
    check(process.returncode == code, f"exit status {process.returncode} instead of {code}: {said}")
    check(code < 0 or said.count("\n") == 1, f"not one line: {said}")
    print(said.strip())


def wait_until_late(process, root, number):
    """Waits until the checkpoint of this number is being written, and then for the run to get ahead of it."""
    deadline = time.monotonic() + 60
    while not list(root.glob(f"result/checkpoints/checkpoint_{number:04}.bin.*.tmp")):
        check(process.poll() is None and time.monotonic() < deadline, f"{root}: checkpoint {number} is not written")
        time.sleep(0.002)
    time.sleep(0.2)


def lines_of(root, stages=("gravity", "volume_loss")):
    """Increments of these stages that the log reports."""
    lines = [line for line in (root / "result/run.log").read_text().splitlines() if "iterations" in line]
    return sum(f" I {stage} " in line for line in lines for stage in stages)


def outputs_of(root):
    """Increments of gravity and volume loss whose output the run has begun."""
    entries = [line.rsplit(" ", 1) for line in (root / "regions").read_text().splitlines()]
    return sum(int(count) for path, count in entries if path.endswith("output")) - lines_of(root, ["column"])


def resume(name, root, code=0):
    again = started(root, SCENARIOS[name].words(root, resume=True))
    check(again.returncode == code, f"{root}: --resume ended with {again.returncode}: {again.stderr}")
    check_equal(Path(f"straight_{name}"), root)


calls, _ = straight("elastic")
WHICH = 5  # checkpoint of gravity
slow_sync = number_of(calls, "sync", WHICH - 1)

# The disk fails in the thread that writes when the run has made the next increment: it ends there with one line, and
# the log has reported no increment that is not on the disk.
root, process = begun("elastic", "full", at=slow_sync)
ended(process, 4)
check(lines_of(root) == WHICH - 1, f"{lines_of(root)} increments are reported, and {WHICH - 1} are on the disk")
check(outputs_of(root) == WHICH + 1, f"the output of {outputs_of(root)} increments was begun, not of {WHICH + 1}")
resume("elastic", root)

# The same when a request to stop comes in between: the failure is not lost.
root, process = begun("elastic", "full_and_stopped", at=slow_sync)
wait_until_late(process, root, WHICH)
process.send_signal(signal.SIGTERM)
ended(process, 4)
resume("elastic", root)

# A request to stop while the disk is slow: what is reported is on the disk, and all that was computed is reported.
for name in SCENARIOS:
    calls, code = straight(name)
    root, process = begun(name, "stopped", at=number_of(calls, "sync", WHICH - 1), mode="never")
    wait_until_late(process, root, WHICH)
    process.send_signal(signal.SIGTERM)
    ended(process, 130)
    check(lines_of(root) == outputs_of(root) > WHICH, f"{lines_of(root)} of {outputs_of(root)} increments are reported")
    resume(name, root, code)

# A kill while the disk is slow costs the increment that is being written, and the one that is computed.
root, process = begun("elastic", "killed", at=slow_sync)
wait_until_late(process, root, WHICH)
process.kill()
ended(process, -signal.SIGKILL)
check((root / f"result/checkpoints/checkpoint_{WHICH - 1:04}.bin").exists(), "an increment more is lost")
resume("elastic", root)

# The bytes of a checkpoint are those of its own increment, also where they are made when the grains have moved on.
calls, code = straight("grains")
last = sum(call.startswith("rename") for call in calls)
root, process = begun("grains", "late", at=number_of(calls, "open", -2), mode="never")
process.communicate(timeout=120)
check(process.returncode == code, f"a run on a slow disk ended with {process.returncode}")
check_equal(Path("straight_grains"), root)
(root / f"result/checkpoints/checkpoint_{last:04}.bin").unlink()
resume("grains", root, code)
