"""RVEs spread over processes: the bits of one process, and one end for all of them, whatever happens to one."""

import errno
import os
import re
import resource
import signal
import subprocess
import time
from pathlib import Path

from launcher import end, on_ranks, skip_without_mpi, start, worker
from program import PROGRAM, SMALL_TUNNEL, check, check_same, command, fresh, run

skip_without_mpi()
SETTINGS = [*SMALL_TUNNEL, "volume_loss.increments=1"]


def ranks(n, folder, *further, settings=SETTINGS):
    return on_ranks(n, command("tunnel_quick", folder, settings, "--threads", "1", *further))


# One process, two, three with a rank of another share; stopped on two and resumed on one and the other way round.
straight = fresh("straight")
run(command("tunnel_quick", straight, SETTINGS, "--threads", "2"))
for n in (2, 3):
    spread = fresh(f"ranks_{n}")
    run(ranks(n, spread))
    check_same(straight, spread)
log = (spread / "run.log").read_text()
check("3 ranks: " in log, "the log does not say that there were ranks")
shares = [float(share) for share in re.findall(r"gravity: ([\d.]+) % of the steps of the lanes moved a grain", log)]
check(len(shares) == 1 and 5 < shares[0] < 100, f"the log says that these shares of the lanes worked: {shares}")

stopped = fresh("stopped")
process = start(ranks(2, stopped), stopped / "increments/0004.h5")
process.send_signal(signal.SIGUSR1)  # mpirun passes it on
said = end(process, 130)
check(len(said) == 1 and "--resume" in said[0], f"not one line about resuming: {said}")
run(command("tunnel_quick", stopped, SETTINGS, "--resume"))
check_same(straight, stopped)
stopped = fresh("stopped")
process = start(command("tunnel_quick", stopped, SETTINGS), stopped / "increments/0003.h5")
process.terminate()
end(process, 130)
run(ranks(2, stopped, "--resume"))
check_same(straight, stopped)

# Wrong input, no equilibrium: one message, the program's exit code.
wrong = fresh("wrong")
process = subprocess.Popen(ranks(2, wrong, settings=["packing.grains=two"]), stderr=subprocess.PIPE, text=True)
said = end(process, 2)
check(len(said) == 1 and "packing.grains" in said[0] and not wrong.exists(), f"wrong input: {said}")
failed = fresh("failed")
settings = [*SETTINGS, "newton.tolerance=1e-15", "newton.maximum_iterations=2", "newton.smallest_cut=1"]
said = end(
    subprocess.Popen(ranks(2, failed, settings=settings), stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True),
    3,
)
check(len(said) == 1 and "no equilibrium" in said[0], f"no equilibrium: {said}")

# A rank that has no memory says so through the first one; a rank that is killed takes the others with it. Results stay
# usable.
starved = fresh("starved")
process = start(ranks(2, starved), starved / "column/increments/0001.h5")
pid = worker(process)
pages = int(Path(f"/proc/{pid}/statm").read_text().split()[0])
resource.prlimit(pid, resource.RLIMIT_AS, (pages * resource.getpagesize(),) * 2)
said = end(process, 4)
check(len(said) == 1 and "rank 1 on " in said[0] and "memory" in said[0], f"no memory on a rank: {said}")

# A disk that fails on the first rank ends all of them.
full = fresh("full")
faults = {"PATTERN": f"{full.resolve()}*", "AT": 120, "ERRNO": errno.ENOSPC, "MODE": "on"}
environment = os.environ | {f"DISK_FAULTS_{name}": str(value) for name, value in faults.items()}
process = subprocess.Popen(
    ["mpirun", "-x", f"LD_PRELOAD={os.environ['VOUSSOIR_DISK_FAULTS']}", *ranks(2, full)[1:]],
    stdout=subprocess.DEVNULL,
    stderr=subprocess.PIPE,
    text=True,
    env=environment,
)
said = end(process, 4)
check(len(said) == 1 and "No space left" in said[0], f"a full disk on the first rank: {said}")
run(ranks(2, full, "--resume"))
check_same(straight, full)

killed = fresh("killed")
process = start(ranks(2, killed), killed / "increments/0003.h5")
os.kill(worker(process), signal.SIGKILL)
begun = time.monotonic()
end(process, 137)
stopped = fresh("stopped")
process = start(ranks(2, stopped), stopped / "increments/0002.h5")
process.send_signal(signal.SIGINT)  # mpirun gives the ranks one second
end(process, 1)
check(time.monotonic() - begun < 60, "the other ranks went on without the one that was killed")
run(ranks(2, killed, "--resume"))
check_same(straight, killed)

end(
    subprocess.Popen(
        ["mpirun", "--oversubscribe", "-n", "2", PROGRAM, "sweep", "none.toml"], stderr=subprocess.PIPE, text=True
    ),
    2,
)
