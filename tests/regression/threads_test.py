"""Threads: how many are used and why is one line of the log. What the machine, the affinity, OpenMP's variables and
Kokkos' pool allow is respected, and nothing of it ends the program."""

import os
import subprocess
from pathlib import Path

from program import check, command, fresh

SETTINGS = ["volume_loss.increments=1", "ground.mesh_size_opening=2.5 m", "ground.mesh_size_far=8 m", "gravity.ratio=5"]
CORES = sorted(os.sched_getaffinity(0))


def threads(variables, *options, cores=None, code=0):
    """The log's line about threads of a short run, or the complaint about it."""
    out = fresh("out")
    before = ["taskset", "-c", ",".join(map(str, cores))] if cores else []
    clean = {k: v for k, v in os.environ.items() if not k.startswith(("OMP_", "KOKKOS_", "GOMP_"))}
    words = [*before, *command("tunnel_elastic", out, SETTINGS, *options)]
    environment = {**clean, "OMP_WAIT_POLICY": "passive", **variables}
    done = subprocess.run(words, check=False, capture_output=True, text=True, timeout=120, env=environment)
    check(done.returncode == code, f"{variables} {options}: exit {done.returncode}: {done.stderr}")
    if code:
        check(not out.exists() and done.stderr.count("\n") == 1, f"{variables} {options}: {done.stderr}")
        return done.stderr
    lines = [line for line in (out / "run.log").read_text().splitlines() if "threads: " in line]
    check(len(lines) == 1, f"{variables} {options}: {len(lines)} lines about threads")
    print(f"ok: {variables} {options}: {lines[0]}")
    return lines[0]


def expect(line, *fragments):
    for fragment in fragments:
        check(fragment in line, f"'{fragment}' is missing in: {line}")


plain = threads({})
expect(plain, "one for each core")
if "threads: 1 (one" not in plain:  # a container may grant one core only, which is what the last line says
    expect(threads({}, cores=CORES[:1]), "threads: 1 (one for each core); 1 core is available", "may run on 1")
expect(threads({}, "--threads", "3", cores=CORES[:1]), "threads: 3 (--threads); 1 core is available", "take turns")
expect(threads({"OMP_NUM_THREADS": "3,2"}), "threads: 3 (OMP_NUM_THREADS=3,2)")
expect(threads({"KOKKOS_NUM_THREADS": "2"}), "threads: 2 (KOKKOS_NUM_THREADS=2)")
expect(threads({"OMP_NUM_THREADS": "600"}), "threads: 512", "Kokkos' pool holds only 512")
expect(threads({"KOKKOS_NUM_THREADS": "600"}), "threads: 512", "Kokkos' pool holds only 512")
for garbage in ("abc", "-3", "0"):
    expect(threads({"KOKKOS_NUM_THREADS": garbage}), f"KOKKOS_NUM_THREADS={garbage} is no number of threads")
expect(threads({"OMP_NUM_THREADS": "abc"}), "OMP_NUM_THREADS=abc is no number of threads")
expect(threads({"OMP_THREAD_LIMIT": "1"}, "--threads", "2"), "threads: 1 (--threads)", "OMP_THREAD_LIMIT allows only 1")
expect(threads({"OMP_DYNAMIC": "true"}), "OMP_DYNAMIC=true is not obeyed")
expect(threads({"OMP_PROC_BIND": "true"}), plain.split("threads: ")[1].split(" (")[0] + " (one", "OMP_PROC_BIND=true")
expect(threads({"OMP_PLACES": "{9999}"}), "OMP_PLACES={9999}")
for name in ("KOKKOS_DEVICE_ID", "KOKKOS_PRINT_CONFIGURATION", "KOKKOS_TUNE_INTERNALS", "KOKKOS_DISABLE_WARNINGS"):
    threads({name: "abc"})

expect(threads({}, "--threads", "600", code=2), "--threads", "512")
for number in ("0", "-1", "two", "99999999999999999999"):
    expect(threads({}, "--threads", number, code=2), "--threads")

# A library that ends the program by itself cannot leave a status that means nothing: OpenMP finds no room for a thread.
done = subprocess.run(
    command("tunnel_elastic", fresh("out"), SETTINGS, "--threads", "2"),
    check=False, capture_output=True, text=True, timeout=120, env={**os.environ, "OMP_STACKSIZE": "1000G"},
)  # fmt: skip
check(done.returncode == 4 and "Thread creation failed" in done.stderr, f"exit {done.returncode}: {done.stderr}")
check(not list(Path("out").glob("*.h5")), "results without threads")
