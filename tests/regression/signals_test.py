"""Pipes, closed descriptors, full devices and signals: nothing kills a run by accident, or is lost in silence."""

import os
import resource
import signal
import subprocess
import time
from pathlib import Path

from faulty_disk import COARSE, STEPS
from program import PROGRAM, ROOT, check, check_same, command, fresh, run, start_and_signal

CASE = "tunnel_elastic"
SETTINGS = [*COARSE, *STEPS]
LONG = [*COARSE, "volume_loss.total=2 %", "volume_loss.increments=60", "gravity.uniform_step=1"]
CHECK = [PROGRAM, "check", str(ROOT / "cases" / CASE / "case.toml")]
PACK = [PROGRAM, "run", str(ROOT / "cases/pack/case.toml")]
for setting in ("packing.grains=60", "packing.seeds=[1]", "packing.folder=packings"):
    PACK += ["--set", setting]

straight = fresh("straight")
run(command(CASE, straight, SETTINGS))
INFO = [PROGRAM, "info", str(straight / "run.h5")]


def output_to(words, target, errors=subprocess.PIPE):
    """Runs with standard output at a device, at a pipe that nobody reads ("pipe"), or closed ("closed")."""
    close = None
    if target == "pipe":
        reader, writer = os.pipe()
        os.close(reader)
    elif target == "closed":
        writer = os.open("/dev/null", os.O_WRONLY)
        close = lambda: os.close(1)  # noqa: E731  it is called once, in the child
    else:
        writer = os.open(target, os.O_WRONLY)
    done = subprocess.run(
        words, check=False, stdout=writer, stderr=errors, preexec_fn=close, text=True, timeout=120, restore_signals=True
    )
    os.close(writer)
    return done


# A command whose product is its output fails with the output; a reader that has enough is no reason for a complaint.
for words in (CHECK, INFO, [PROGRAM, "--help"], [PROGRAM, "--version"], [PROGRAM, "run", "--help"]):
    for target, lines in (("/dev/full", 1), ("closed", 1), ("pipe", 0), ("/dev/null", 0)):
        done = output_to(words, target)
        expected = 0 if target == "/dev/null" else 4
        check(done.returncode == expected, f"{words[1]} to {target}: exit {done.returncode}, {done.stderr}")
        check(done.stderr.count("\n") == lines, f"{words[1]} to {target}: {done.stderr}")
        check(lines == 0 or "standard output" in done.stderr, f"{words[1]} to {target}: {done.stderr}")

# A run goes on without its output, and its log says so; descriptors 1 and 2 do not become those of a result file.
for target in ("/dev/full", "closed", "pipe"):
    folder = fresh("unheard")
    done = output_to(command(CASE, folder, SETTINGS), target)
    check(done.returncode == 0 and not done.stderr, f"run to {target}: exit {done.returncode}, {done.stderr}")
    check_same(straight, folder)
    log = (folder / "run.log").read_text()
    check(log.count("standard output cannot be written") == 1, f"run to {target}: the log: {log}")
    check("volume_loss 2/2" in log, f"run to {target}: the log ends too early: {log}")
    fresh("packings")
    done = output_to(PACK, target)
    check(done.returncode == 0 and done.stderr.count("\n") == 1, f"pack to {target}: {done.returncode}, {done.stderr}")
folder = fresh("unheard")
silent = ["sh", "-c", 'exec "$@" <&- >&- 2>&-', "sh", *command(CASE, folder, SETTINGS)]
run(silent)
check_same(straight, folder)
run(["sh", "-c", 'exec "$@" <&- >&- 2>&-', "sh", *command(CASE, fresh("unheard"), ["packing.grains=two"])], code=2)


# A limit on the size of files is a failure of the disk, not a signal.
def limited():
    resource.setrlimit(resource.RLIMIT_FSIZE, (60_000, resource.RLIM_INFINITY))


folder = fresh("limited")
done = subprocess.run(
    command(CASE, folder, SETTINGS), check=False, capture_output=True, text=True, preexec_fn=limited, timeout=120
)
check(done.returncode == 4 and done.stderr.count("\n") == 1, f"ulimit -f: {done.returncode}, {done.stderr}")
check("ulimit" in done.stderr and "h5" in done.stderr, f"ulimit -f: {done.stderr}")
run(command(CASE, folder, SETTINGS, "--resume"))
check_same(straight, folder)

# SIGHUP is a request to stop; a second one too. Under nohup it is nothing. A stopped process goes on.
straight = fresh("straight_long")
run(command(CASE, straight, LONG))


def wait_for(process, file):
    deadline = time.monotonic() + 120
    while not Path(file).exists():
        check(process.poll() is None and time.monotonic() < deadline, f"{file} did not appear")
        time.sleep(0.002)


folder = fresh("hung_up")
code = start_and_signal(command(CASE, folder, LONG), folder / "increments/0005.h5", signal.SIGHUP)
check(code == 130, f"SIGHUP: {code}")
for name in (signal.SIGXCPU, signal.SIGUSR1):  # a soft limit of processor time, and what mpirun passes on
    asked = fresh(f"asked_{name.name}")
    code = start_and_signal(command(CASE, asked, LONG), asked / "increments/0003.h5", name)
    check(code == 130, f"{name.name}: {code}")
process = subprocess.Popen(command(CASE, folder, LONG, "--resume"), stdout=subprocess.DEVNULL)
wait_for(process, folder / "increments/0010.h5")
for _ in range(2):
    process.send_signal(signal.SIGHUP)
    time.sleep(0.001)
check(process.wait(timeout=120) == 130, f"SIGHUP twice: {process.returncode}")
process = subprocess.Popen(
    ["nohup", *command(CASE, folder, LONG, "--resume")], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
)
wait_for(process, folder / "increments/0015.h5")
process.send_signal(signal.SIGHUP)
process.send_signal(signal.SIGSTOP)
time.sleep(0.3)
check(process.poll() is None, "a run ended when it was stopped for a while")
process.send_signal(signal.SIGCONT)
check(process.wait(timeout=120) == 0, f"SIGHUP under nohup, SIGSTOP and SIGCONT: {process.returncode}")
check_same(straight, folder)

# A second SIGTERM ends the run at once, whatever it is writing; its folder can be gone on from.
folder = fresh("terminated")
for file in ("column/increments/0002.h5", "increments/0004.h5", "increments/0020.h5"):
    process = subprocess.Popen(
        command(CASE, folder, LONG, "--resume"), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    wait_for(process, folder / file)
    while process.poll() is None:
        process.send_signal(signal.SIGTERM)
    check(process.returncode in (-signal.SIGTERM, 130), f"SIGTERM twice: {process.returncode}")
run(command(CASE, folder, LONG, "--resume"))
check_same(straight, folder)
check(not list(folder.rglob("*.tmp")), "temporary files are left behind")

# A kind that cannot stop is ended by the signal, and the next run goes on with what is stored.
fresh("packings")
process = subprocess.Popen([*PACK, "--set", "packing.grains=2000"], stdout=subprocess.DEVNULL)
time.sleep(0.5)
process.terminate()
check(process.wait(timeout=20) in (-signal.SIGTERM, 130), f"a packing that is made: {process.returncode}")
run(PACK)
check(not list(Path("packings").glob("*.tmp")), "temporary files are left in the folder of packings")

# The runs of a sweep that is killed stop after their increment; the sweep goes on with them.
Path("sweep.toml").write_text(
    f"base = '{ROOT / 'cases' / CASE / 'case.toml'}'\n"
    + "".join(f"[[run]]\nname = '{name}'\nset = {LONG}\n" for name in ("one", "two"))
)
folder = fresh("swept")
words = [PROGRAM, "sweep", "sweep.toml", "-o", str(folder), "-j", "2", "--threads", "1"]
process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
wait_for(process, folder / "one/increments/0005.h5")
children = [int(child) for child in Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()]
check(len(children) > 0, "the sweep has no children")
process.kill()
process.wait()


def state(pid):
    """A letter of /proc; Z and X are processes that have ended."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except FileNotFoundError:
        return "X"


deadline = time.monotonic() + 60
while any(state(child) not in "ZX" for child in children):
    check(time.monotonic() < deadline, "a run of a killed sweep goes on")
    time.sleep(0.01)
check(not (folder / "one/increments/0065.h5").exists(), "the run was finished before the sweep was killed")
done = output_to([*words, "--resume"], "pipe")
check(done.returncode == 0, f"a sweep whose output nobody reads: {done.returncode}, {done.stderr}")
check_same(straight, folder / "one")
check_same(straight, folder / "two")
