"""A small tunnel of grains that has a hard life: it is killed with -9 at 50 random moments, goes on with another number
of threads each time, and meets a full disk ten times. Whenever it comes to its end, every dataset is that of a run that
was left alone; it then begins anew until all has happened.

The disk is a tmpfs that other files fill to their last pages, where this process may mount one (root); elsewhere the
library of tests/faults lets a call of the run find the disk full. An argument is the seed of an earlier life:

    ctest --preset openmp -R endurance_long_test --verbose
"""

import os
import random
import shutil
import subprocess
import sys
import time
from pathlib import Path

from faulty_disk import check_readable, started
from program import SMALL_TUNNEL, check, check_same, command, ended_or_killed, fresh, run

KILLS, FULL_DISKS = 50, 10
SETTINGS = [*SMALL_TUNNEL, "volume_loss.total=2 %", "volume_loss.increments=60", "output.rves=[3]"]
SIZE = 200_000_000  # of the tmpfs [bytes]; the run takes 20 MB of it

seed = int(sys.argv[1]) if len(sys.argv) > 1 else random.randrange(10**6)
chance = random.Random(seed)
print(f"seed {seed}")


class Disk:
    """A folder for the run: a tmpfs where it can be mounted, otherwise a plain folder with the library."""

    def __init__(self):
        self.folder = Path("disk")
        subprocess.run(["umount", str(self.folder)], check=False, capture_output=True)
        fresh(self.folder).mkdir()
        mount = ["mount", "-t", "tmpfs", "-o", f"size={SIZE}", "tmpfs", str(self.folder)]
        self.is_tmpfs = subprocess.run(mount, check=False, capture_output=True).returncode == 0
        print("the disk is a tmpfs" if self.is_tmpfs else "the disk is a folder, and a library makes it full")

    def run_until_full(self, words):
        """Fills the disk but for some pages, starts the run and frees the disk again; returns how the run ended."""
        if not self.is_tmpfs:
            pattern = f"{self.folder.resolve()}/*"
            return started(Path(), words, pattern, at=chance.randrange(1, 150))
        filler = self.folder / "filler"
        free = shutil.disk_usage(self.folder).free - chance.randrange(1_000_000)
        with filler.open("wb") as opened:
            os.posix_fallocate(opened.fileno(), 0, max(free, 1))
        done = subprocess.run(words, check=False, capture_output=True, text=True, timeout=600)
        filler.unlink()
        return done

    def close(self):
        if self.is_tmpfs:
            subprocess.run(["umount", str(self.folder)], check=True)


class Life:
    """The run in its folder, which begins anew when it has come to its end."""

    def __init__(self, folder, straight):
        self.folder, self.straight = folder, straight
        self.threads, self.ends = 1, 0

    def words(self):
        """The command that goes on, with another number of threads than before."""
        self.threads = chance.choice([n for n in (1, 2, 3, 4) if n != self.threads])
        return command("tunnel_quick", self.folder, SETTINGS, "--threads", str(self.threads), "--resume")

    def ended(self):
        check_same(self.straight, self.folder)
        leftovers = list(self.folder.rglob("*.tmp"))
        check(not leftovers, f"seed {seed}: left behind: {leftovers}")
        self.ends += 1
        fresh(self.folder)


def live(life, disk, whole):
    """All kills and full disks in a random order."""
    events = ["kill"] * KILLS + ["full"] * FULL_DISKS
    chance.shuffle(events)
    for event in events:
        while True:  # until the event has happened; a run that ends before begins anew
            if event == "kill":
                if ended_or_killed(life.words(), chance.uniform(0.02, 0.3) * whole):
                    break
            else:
                done = disk.run_until_full(life.words())
                if done.returncode == 4:
                    check(done.stderr.count("\n") == 1, f"seed {seed}: not one line: {done.stderr}")
                    check("No space left" in done.stderr, f"seed {seed}: {done.stderr}")
                    print(done.stderr.strip())
                    check_readable(life.folder)
                    break
                check(done.returncode == 0, f"seed {seed}: a full disk: {done.returncode}, {done.stderr}")
            life.ended()
    run(life.words(), timeout=1200)
    life.ended()


begun = time.monotonic()
fresh("packings")
straight = fresh("straight")
run(command("tunnel_quick", straight, SETTINGS, "--threads", "2"), timeout=1200)
whole = time.monotonic() - begun
disk = Disk()
try:
    life = Life(disk.folder / "tunnel", straight)
    live(life, disk, whole)
finally:
    disk.close()
print(
    f"seed {seed}: {KILLS} kills, {FULL_DISKS} full disks, {life.ends} runs came to their end with the same bits; "
    f"a run takes {whole:.0f} s, all took {time.monotonic() - begun:.0f} s"
)
