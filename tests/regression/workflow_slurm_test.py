"""tools/workflow on a stand-in for Slurm: a dry run submits nothing; the jobs ask for the threads, memory and time that
the program's list gives; their results are those of this machine."""

import json
import os
from pathlib import Path

from program import PROGRAM, ROOT, check, fresh, run
from tiny_sweep import DEPTHS, by_workflow, check_same_sweeps, end, need_snakemake, start, write_sweep

need_snakemake()
SWEEP = write_sweep("two.toml", depth={name: DEPTHS[name] for name in ("near", "deep")})
SAFETY, MORE_MEMORY_MB, LEAST_MINUTES = 3, 500, 10
WORDS = ["--slurm", "--threads", "4", "--safety", str(SAFETY), "--slurm-init-seconds-before-status-checks", "1"]

slurm = fresh("slurm").resolve()
slurm.mkdir()
environment = {"SLURM_STUB": str(slurm), "PATH": f"{ROOT / 'tests/regression/slurm_stub'}:{os.environ['PATH']}"}
swept = fresh("swept")

said = end(start(by_workflow(SWEEP, swept, *WORDS, "--dry-run"), "dry.log", **environment), 0, "dry.log")
check(not list(slurm.iterdir()), "a dry run has submitted jobs")
check("member" in said and not (swept / "tunnels").exists(), f"a dry run says nothing or runs: {said}")

end(start(by_workflow(SWEEP, swept, *WORDS), "slurm.log", **environment), 3, "slurm.log")
calls = {file.name: file.read_text().splitlines() for file in slurm.glob("*.call")}
check(len(calls) == 2, f"{len(calls)} jobs instead of 2")
listed = json.loads(run([PROGRAM, "sweep", str(SWEEP), "-o", str(swept), "--list", "--json"]).stdout)
memory_mb = {run["name"].replace("/", "__"): run["memory_mb"] for run in listed["runs"]}
for name, words in calls.items():
    value = {word: words[k + 1] for k, word in enumerate(words[:-1])}
    member = value["--comment"].split("wildcards_")[1]
    asked = int(value["--mem"])
    wanted = SAFETY * memory_mb[member] + MORE_MEMORY_MB
    check(0 <= asked - wanted < 1, f"{name}: {asked} MB instead of {wanted}")
    check(int(value["-t"]) == LEAST_MINUTES + 1, f"{name}: {value['-t']} min: seconds of work take a minute")
    check("--cpus-per-task=1" in words, f"{name}: seconds of work take one thread: {words}")
    check(Path(value["-D"]).is_dir() and value["--job-name"].startswith("voussoir-"), f"{name}: {words}")

own = fresh("own")
run([PROGRAM, "sweep", str(SWEEP), "-o", str(own), "-j", "2", "--threads", "1"], code=3)
check_same_sweeps(own, swept)
