"""kill -9 at random moments, wherever they fall (a packing, a column, half a file, a checkpoint): whenever the run is
resumed, it gives the bits of one that was left alone. Elastic increments take milliseconds, so that most kills hit a
file being written."""

import random
import time

from program import SMALL_TUNNEL, check, check_same, command, ended_or_killed, fresh, run

ELASTIC = [
    "volume_loss.increments=15",
    "volume_loss.total=2 %",
    "ground.mesh_size_opening=2.5 m",
    "ground.mesh_size_far=8 m",
    "output.checkpoint_every=4",
]
GRAINS = [*SMALL_TUNNEL, "volume_loss.increments=2"]

seed = random.randrange(10**6)
chance = random.Random(seed)
print(f"seed {seed}")


def kill_at_random(case, settings, kills):
    since = time.monotonic()
    fresh("packings")
    straight = fresh(f"straight_{case}")
    run(command(case, straight, settings, "--threads", "2"))
    whole = time.monotonic() - since
    fresh("packings")
    killed = fresh(f"killed_{case}")
    hits = 0
    for _ in range(kills):
        words = command(case, killed, settings, "--threads", "2", "--resume")
        hits += ended_or_killed(words, chance.uniform(0.05, 0.4) * whole)
    run(command(case, killed, settings, "--threads", "1", "--resume"))
    check_same(straight, killed)
    check(hits > 0, f"seed {seed}: {case} was never killed")
    print(f"{case}: {hits} of {kills} runs killed")


kill_at_random("tunnel_elastic", ELASTIC, 10)
kill_at_random("tunnel_quick", GRAINS, 5)
