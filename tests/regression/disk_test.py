"""A disk that fails: at some calls of each kind of run (disk_long_test.py tries all of them), a folder that vanishes,
files that are replaced or cut."""

import os
import shutil
import subprocess
import time

from faulty_disk import SCENARIOS, try_faults
from program import check, check_same, command, fresh, run

# The specimen's call 102 lies between its last checkpoint and its last table.
for name, every, first in (
    ("tunnel", 69, 2),
    ("grains", 200, 150),
    ("specimen", 41, 20),
    ("pack", 9, 2),
    ("probe", 9, 2),
    ("biaxial", 16, 2),
):
    try_faults(name, every, first)
try_faults("tunnel", 1, pattern="{root}/result/column/k0.csv*")
try_faults("tunnel", 9, first=3, pattern="{root}/result/run.log")
try_faults("sweep", 4, first=3, pattern="{root}/result@(|/summary*)")

SLOW = [*SCENARIOS["tunnel"].settings, "volume_loss.increments=30", "output.every=2", "output.checkpoint_every=1"]
straight = fresh("straight_slow")
run(command("tunnel_elastic", straight, SLOW, "--threads", "1"))


def disturbed(name, disturb):
    """A run whose folder is disturbed behind its seventh increment; it must end with exit status 4 and one line."""
    folder = fresh(name)
    process = subprocess.Popen(
        command("tunnel_elastic", folder, SLOW, "--threads", "1"),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    deadline = time.monotonic() + 120
    while not (folder / "increments/0007.h5").exists():
        check(process.poll() is None and time.monotonic() < deadline, f"{name}: the run did not come far")
        time.sleep(0.002)
    disturb(folder)
    said = process.communicate(timeout=120)[1]
    check(process.returncode == 4 and said.count("\n") == 1 and name in said, f"{name}: {process.returncode}, {said}")
    print(said.strip())
    return folder


def resumed(folder):
    return run(command("tunnel_elastic", folder, SLOW, "--resume"))


# A folder that vanishes and comes back, a folder in the place of a file.
away = fresh("away")
folder = disturbed("vanished", lambda folder: folder.rename(away))
check(not folder.exists(), f"a folder that has vanished was made anew with {list(folder.rglob('*'))}")
away.rename(folder)
resumed(folder)
check_same(straight, folder)


def put_folder_for_file(folder):
    (folder / "result.xdmf").unlink()
    (folder / "result.xdmf").mkdir()


folder = disturbed("replaced", put_folder_for_file)
(folder / "result.xdmf").rmdir()

# A checkpoint that is cut is passed over with a word. An increment that is cut stops the resume until it is removed.
checkpoint = max((folder / "checkpoints").glob("*.bin"))
os.truncate(checkpoint, checkpoint.stat().st_size // 2)
increment = folder / "increments/0002.h5"
shutil.copy(increment, "kept.h5")
os.truncate(increment, increment.stat().st_size // 2)
said = run(command("tunnel_elastic", folder, SLOW, "--resume"), code=4).stderr
check(said.count("\n") == 1 and "0002.h5" in said and "removed" in said, f"an increment that is cut: {said}")
without = fresh("without")
shutil.copytree(folder, without)
(without / "increments/0002.h5").unlink()
check("1 of the" in resumed(without).stdout, "a result file has vanished, and nothing is said")
shutil.copy("kept.h5", increment)
check("damaged" in resumed(folder).stdout, "a checkpoint that is cut is passed over in silence")
check_same(straight, folder)

# A log that is a pipe without a reader would make the run wait for ever.
folder = fresh("piped")
folder.mkdir()
os.mkfifo(folder / "run.log")
said = run(command("tunnel_elastic", folder, SLOW), code=4, timeout=60).stderr
check(said.count("\n") == 1 and "run.log" in said, f"a log that is a pipe: {said}")
