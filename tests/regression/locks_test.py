"""Two processes and one folder: the second is refused with exit status 2 and one line that names process and host; a
run that was killed does not block; a lock of another host is taken over only where the user says so. In the folder of
packings the second process waits for the first."""

import contextlib
import os
import resource
import shutil
import signal
import socket
import subprocess
from functools import partial
from pathlib import Path

from program import PROGRAM, ROOT, check, command, fresh, run, wait_until

SMALL = ["ground.mesh_size_opening=2.5 m", "ground.mesh_size_far=8 m", "volume_loss.total=1 %"]
LONG = [*SMALL, "volume_loss.increments=3000"]
QUICK = [*SMALL, "volume_loss.increments=1", "gravity.ratio=2", "gravity.uniform_step=0.5"]
CASE = "tunnel_elastic"


def start(words):
    return subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def expect_refusal(words, *fragments):
    done = run(words, code=2)
    check(done.stderr.count("\n") == 1, f"not one line: {done.stderr}")
    for fragment in fragments:
        check(fragment in done.stderr, f"'{fragment}' is missing in: {done.stderr}")
    print(f"ok: {done.stderr.strip()}")


# A second run in the folder of a running one, with every option; in its column; and the first goes on unharmed.
two = fresh("two")
first = start(command(CASE, two, LONG))
wait_until((two / "increments/0002.h5").exists, first, "a second increment")
names = (f"process {first.pid} ", f"host {socket.gethostname()}")
for option in ([], ["--resume"], ["--replace"], ["--resume", "--take-over"]):
    expect_refusal(command(CASE, two, LONG, *option), *names)
expect_refusal(command("column", two / "column", [], "--replace"), "the folder above it", *names)
check((two / "increments/0002.h5").exists(), "a refused --replace has removed results")

# A user removes the lock file: the run makes it anew and says so.
(two / "run.lock").unlink()
wait_until((two / "run.lock").exists, first, "a new lock file")
expect_refusal(command(CASE, two, LONG, "--resume"), *names)
check("it was made anew" in (two / "run.log").read_text(), "the log does not say that the lock file was removed")

# Other bytes in the run's own lock file are replaced by its text.
for content in ("", "my notes\n"):
    (two / "run.lock").write_text(content)
    wait_until(lambda: f"process {first.pid}\n" in (two / "run.lock").read_text(), first, "text of the lock file")
wait_until(lambda: "it has its text again" in (two / "run.log").read_text(), first, "the line of the lock file's text")

# kill -9, and the next run goes on.
first.kill()
first.communicate()
check((two / "run.lock").exists(), "a killed run has no lock file to leave")

# What is no lock file is left as it is, and is never waited for.
lock = two / "run.lock"
for make, what in (
    (lambda: lock.write_text("my notes\n"), "is no lock file of this program"),
    (lambda: os.mkfifo(lock), "is a pipe or a device"),
    (lambda: lock.symlink_to("/dev/zero"), "is a pipe or a device"),
):
    lock.unlink()
    make()
    for word in ("--resume", "--replace"):
        expect_refusal(command(CASE, two, LONG, word), f"its run.lock {what}", "where no process uses the folder")
lock.unlink()

# A folder takes the place of the lock file while a run goes on: the run ends and accuses no other process.
replaced = start(command(CASE, two, LONG, "--resume"))
wait_until(lambda: lock.exists() and f"process {replaced.pid}\n" in lock.read_text(), replaced, "its lock")
while not lock.is_dir():
    lock.unlink(missing_ok=True)
    with contextlib.suppress(FileExistsError):  # the run may have been faster
        lock.mkdir()
said = replaced.communicate(timeout=60)[1]
check(replaced.returncode == 4 and said.count("\n") == 1, f"exit {replaced.returncode}: {said}")
check("run.lock: somebody has replaced it" in said and "it is a folder" in said, f"not what was found: {said}")
expect_refusal(command(CASE, two, LONG, "--resume"), "its run.lock is a folder", "remove it")
lock.rmdir()

# A pipe in place of the newest checkpoint is passed over.
newest = max((two / "checkpoints").iterdir())
newest.unlink()
os.mkfifo(newest)
second = start(command(CASE, two, LONG, "--resume"))
wait_until(
    lambda: lock.exists() and f"process {second.pid}\n" in (two / "run.lock").read_text(),
    second,
    "lock of the second run",
)
# Another process takes the folder over, for example from another host: this run ends and leaves the folder.
kept = (two / "run.lock").read_text()
(two / "new.tmp").write_text(kept.replace(f"process {second.pid}\n", "process 1\n"))
(two / "new.tmp").rename(two / "run.lock")
said = second.communicate(timeout=60)[1]
check(second.returncode == 4 and "taken the folder over" in said, f"exit {second.returncode}: {said}")

# A lock of another host is refused whatever its age, and taken over where the user says so.
lock.write_text(kept.replace(f"host {socket.gethostname()}\n", "host elsewhere\n"))
os.utime(lock, (0, 0))
expect_refusal(command(CASE, two, LONG, "--resume"), "host elsewhere", "--take-over")
third = start(command(CASE, two, LONG, "--resume", "--take-over"))
wait_until(lambda: "taken over from" in (two / "run.log").read_text(), third, "a line about the take-over")
third.send_signal(signal.SIGTERM)
third.communicate(timeout=60)
check(
    third.returncode == 130 and not lock.exists(),
    f"exit {third.returncode}; a run that was stopped gives its lock back",
)

# The folder is moved away under the run.
fourth = start(command(CASE, two, LONG, "--resume"))
wait_until(lambda: lock.exists() and f"process {fourth.pid}\n" in lock.read_text(), fourth, "its lock")
moved = fresh("moved")
two.rename(moved)
said = fourth.communicate(timeout=60)[1]
check(fourth.returncode == 4 and said.count("\n") == 1, f"a moved folder: exit {fourth.returncode}: {said}")
check(not (two / "run.h5").exists(), "the run has begun anew in another folder of the old name")

# Two that start at the same moment: one goes on, the other is refused.
for _ in range(4):
    race = fresh("race")
    pair = [start(command(CASE, race, QUICK)) for _ in range(2)]
    ends = [(p.communicate(timeout=120)[1], p.returncode)[1] for p in pair]
    check(sorted(ends) == [0, 2], f"two at the same moment ended with {ends}")
run(command(CASE, race, QUICK, "--resume"))

# A sweep holds its folder and those of its runs.
Path("sweep.toml").write_text(f"""base = '{ROOT / "cases/tunnel_elastic/case.toml"}'
[[run]]
name = "one"
set = {LONG}
[[run]]
name = "two"
set = {QUICK}
""")
swept = fresh("swept")
words = [PROGRAM, "sweep", "sweep.toml", "-o", str(swept), "--threads", "1"]
sweep = start(words)
wait_until((swept / "one/increments/0001.h5").exists, sweep, "an increment of the sweep")
expect_refusal([*words, "--resume"], "process")
expect_refusal(command(CASE, swept / "one", LONG, "--resume"), "process")
expect_refusal(command(CASE, swept / "two", QUICK), "the folder above it", f"process {sweep.pid} ")
sweep.send_signal(signal.SIGTERM)
sweep.communicate(timeout=60)
check(sweep.returncode == 130, f"the sweep ended with {sweep.returncode}")

# One of its runs is killed: the others run, one line says which and why, and the end names it again.
sweep = start([*words, "--resume"])
one = swept / "one/run.lock"
wait_until(lambda: one.exists() and "process" in one.read_text(), sweep, "a lock of a run")
os.kill(int(one.read_text().split("process ")[1].split()[0]), signal.SIGKILL)
said = sweep.communicate(timeout=60)[1]
check(sweep.returncode == 4 and said.count("\n") == 3, f"a killed run of a sweep: exit {sweep.returncode}: {said}")
check("swept/one was killed by SIGKILL; --resume goes on" in said, f"the line does not say what happened: {said}")
check("1 of 2 runs did not end well:" in said and "one (killed by SIGKILL)" in said, f"the end of the sweep: {said}")


# Packings: the second process waits for the first.
def pack(grains):
    settings = [f"packing.grains={grains}", "packing.seeds=[1]", "packing.folder=packings", "packing.pressure=10 kPa"]
    return command("pack", "pack", settings, "--threads", "1")


shutil.rmtree("packings", ignore_errors=True)
many = 700
first = start(pack(many))
wait_until(lambda: list(Path("packings").glob("*.lock")), first, "the lock of a packing")
others = [start(pack(many)) for _ in range(2)]
check("packing made" in first.communicate(timeout=250)[0], "the first process made no packing")
for other in others:
    said = other.communicate(timeout=250)[0]
    check(f"waits for process {first.pid} " in said, f"the second process does not say that it waits: {said}")
    check("packing found" in said and "packing made" not in said, f"the packing was made twice: {said}")
check(not list(Path("packings").glob("*.lock")), "a lock of a packing is left")

# The first dies: the second makes the packing. A request to stop ends the wait.
shutil.rmtree("packings")
first = start(pack(many))
wait_until(lambda: list(Path("packings").glob("*.lock")), first, "the lock of a packing")
other, stopped = start(pack(many)), start(command("biaxial_bvp", fresh("waiting"), [
    f"packing.grains={many}", "packing.seed=1", "packing.candidates=1", "packing.folder=packings",
    "packing.consolidation_friction=0.0", "biaxial_bvp.pressure=10 kPa"]))  # fmt: skip
log = Path("waiting/run.log")
wait_until(lambda: log.exists() and "waits for process" in log.read_text(), first, "a run that waits")
stopped.send_signal(signal.SIGTERM)
said = stopped.communicate(timeout=60)[1]
check(
    stopped.returncode == 130 and "stopped on request" in said, f"stopped while waiting: {stopped.returncode}: {said}"
)
first.kill()
first.communicate()
said = other.communicate(timeout=250)[0]
check("packing made" in said, f"the second process did not take over: {said}")
check(run(pack(many)).stdout.count("packing found") == 1, "the packing is not there")

# The runs of a sweep that need the same packing make it once.
shutil.rmtree("packings")
GRAINS = [*SMALL, "material=grains", "packing.grains=100", "packing.candidates=1", "packing.folder=packings",
          "column.elements=2", "gravity.ratio=10", "gravity.uniform_step=1", "newton.tolerance=0.05"]  # fmt: skip
Path("sweep.toml").write_text(
    f"base = '{ROOT / 'cases/column/case.toml'}'\n"
    + "".join(f'[[run]]\nname = "{name}"\nset = {GRAINS[3:]}\n' for name in "abc")
)
run([PROGRAM, "sweep", "sweep.toml", "-o", str(fresh("swept")), "-j", "3"])
logs = [(Path("swept") / name / "run.log").read_text() for name in "abc"]
check(sum("packing made" in text for text in logs) == 1, "a packing of three runs was not made once")
check(all(" (--threads)" in text for text in logs), "the runs of a sweep do not share the cores")

# pack that is stopped while it computes.
shutil.rmtree("packings")
first = start(pack(4000))
wait_until(lambda: list(Path("packings").glob("*.lock")), first, "the lock of a packing")
first.send_signal(signal.SIGTERM)
first.communicate(timeout=60)
check(first.returncode == 130, f"a packing that was stopped ended with {first.returncode}")

# A process without a file descriptor to spare leaves no lock behind that would keep the next run out.
for count in range(4, 12):
    few = fresh("few")
    done = subprocess.run(
        command(CASE, few, QUICK),
        check=False,
        capture_output=True,
        text=True,
        timeout=120,
        preexec_fn=partial(resource.setrlimit, resource.RLIMIT_NOFILE, (count, count)),
    )
    check(done.returncode in (0, 4), f"{count} descriptors: {done.returncode}: {done.stderr}")
    check(not (few / "run.lock").exists(), f"{count} descriptors: the lock file stays")
    run(command(CASE, few, QUICK, "--resume"))
