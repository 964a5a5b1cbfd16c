"""tools/workflow with a sweep of 3 × 2 × 2 tunnels: killed with all its jobs in the middle and resumed, on this machine
and on the stand-in for Slurm, it leaves the folder of `voussoir sweep -j 2`: eleven results, and one run that is
named."""

import os
import signal

from program import PROGRAM, ROOT, check, fresh, run, wait_until
from tiny_sweep import (
    DEPTHS,
    DRAWS,
    SOILS,
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
SWEEP = write_sweep("grid.toml", depth=DEPTHS, soil=SOILS, draw=DRAWS)
FAILED = "tunnels/deep-loose-two"

own = fresh("own")
run([PROGRAM, "sweep", str(SWEEP), "-o", str(own), "-j", "2", "--threads", "1"], code=3)


def check_whole(folder, said):
    codes = outcomes(folder)
    check(len(codes) == 12 and sorted(codes.values()) == [0] * 11 + [3], f"not eleven results: {codes}")
    check(
        f"{FAILED} (no equilibrium)" in said.splitlines()[-1], f"the failed run is not named at the end: {said[-500:]}"
    )
    check_same_sweeps(own, folder)


# Killed with all that it has started.
killed = fresh("killed")
words = by_workflow(SWEEP, killed, "--cores", "2")
first = start(words, "killed.log")
wait_until(lambda: len(outcomes(killed)) >= 3, first, "third outcome")
kill(first, killed, all_jobs=True)
check(len(outcomes(killed)) < 10, f"killed too late: {outcomes(killed)}")
check_whole(killed, end(start(words, "resumed.log"), 3, "resumed.log"))

# Asked to stop: 130, and the next call goes on.
stopped = fresh("stopped")
words = by_workflow(SWEEP, stopped, "--cores", "2")
first = start(words, "stopped.log")
wait_until(lambda: len(outcomes(stopped)) >= 3, first, "third outcome")
first.send_signal(signal.SIGTERM)
said = end(first, 130, "stopped.log")
check("the same call goes on" in said, said)
check_whole(stopped, end(start(words, "again.log"), 3, "again.log"))

# On Slurm Snakemake alone is killed: its jobs stay in the queue, and the next call waits for them.
slurm = fresh("slurm").resolve()
slurm.mkdir()
environment = {"SLURM_STUB": str(slurm), "PATH": f"{ROOT / 'tests/regression/slurm_stub'}:{os.environ['PATH']}"}
cluster = fresh("cluster")
words = by_workflow(SWEEP, cluster, "--slurm", "--jobs", "4", "--slurm-init-seconds-before-status-checks", "1")
first = start(words, "cluster.log", **environment)
wait_until(lambda: len(outcomes(cluster)) >= 2, first, "second outcome")
check(process_of(cluster / ".workflow/lock") is not None, "no Snakemake holds the folder")
kill(first, cluster, all_jobs=False)
said = end(start(words, "cluster_again.log", **environment), 3, "cluster_again.log")
check("jobs of an earlier call" in said, f"the jobs in the queue were not waited for: {said[:500]}")
check_whole(cluster, said)
