"""A scene of grains on an elastic bed, in which ground is dug out: killed and resumed in each stage, on two ranks, as
an ensemble and as a sweep."""

import json
import signal
from pathlib import Path

import numpy as np
from launcher import on_ranks
from program import PROGRAM, check, check_same, fresh, run, start_and_signal, table

CASE = """
kind = "scene"
title = "pit"
packing = {grains = 60, candidates = 1, pressure = "10 kPa", folder = "packings"}
gravity = {uniform_step = 0.5, ratio = 3}
newton = {tolerance = 0.01}
support = [{boundary = ["floor", "door"], fix = "xy"}, {boundary = ["left", "right"], fix = "x"}]
region = [{name = "rock", elastic = {modulus = "50 MPa"}}, {name = "sand"}, {name = "pit"}]
record = [{name = "rim", point = ["1 m", "1 m"]}, {name = "sand", region = "sand"},
          {name = "level", line = [["0 m", "0.75 m"], ["2 m", "0.75 m"]], points = 5}]

[mesh]
shape = "grid"
x = ["0 m", "1 m", "2 m"]
columns = [2, 2]
y = ["0 m", "0.5 m", "1 m", "1.5 m"]
rows = [1, 1, 1]
base = ["floor", "door"]
regions = [["rock", "rock"], ["sand", "sand"], ["pit", "pit"]]

[[stage]]
name = "weight"
gravity = 1
[[stage]]
name = "dig"
steps = 2
excavate = [{region = "pit"}]
[[stage]]
name = "lower"
steps = 2
move = [{boundary = "door", y = "-0.02 mm"}]
[[stage]]
name = "free"
steps = 2
release = [{boundary = "right", share = "50 %"}]
"""
Path("pit.toml").write_text(CASE)


def words(folder, *further):
    return [PROGRAM, "run", "pit.toml", "-o", str(folder), "--threads", "1", *further]


def balance(folder):
    """The reactions along y bear the weights and the pressure on the surface, before and after the pit is dug."""
    for row in table(folder):
        if row["load_parameter"] != 1 or row["stage"] == "free":
            continue
        dug = row["stage"] != "weight"
        load = 20e3 * 2 if dug else 20e3 * 3 + 10e3 * 2
        held = row["reaction_floor_y"] + row["reaction_door_y"]
        check(abs(held / load - 1) < 0.02, f"{row['stage']}: the floor bears {held} N/m, the loads are {load} N/m")


fresh("packings")
straight = fresh("straight")
run(words(straight))
balance(straight)
rows = table(straight)

# Killed with -9 in each stage, just after its first increment.
killed = fresh("killed")
for stage in ("weight", "dig", "lower", "free"):
    first = [row["index"] for row in rows if row["stage"] == stage][1]
    code = start_and_signal(words(killed, "--resume"), killed / f"increments/{first:04d}.h5", signal.SIGKILL)
    check(code in (0, -signal.SIGKILL), f"{stage}: ended with {code}")
run(words(killed, "--resume"))
check_same(straight, killed)

# A case whose stages have changed does not go on from a checkpoint of the old ones.
refused = run(words(killed, "--resume", "--set", "stage[2].steps=3"), code=None)
check(refused.returncode != 0, "a run was resumed although a stage had changed")

if "no MPI" not in run([PROGRAM, "--version"]).stdout:
    ranks = fresh("ranks")
    run(on_ranks(2, words(ranks)))
    check_same(straight, ranks)

# A record must not write into the columns of a boundary.
settings = ["record[0].name=door"]
refused = run(words(fresh("twice"), "--set", *settings), code=2)
check("displacement_door_x" in refused.stderr, f"two columns of one name: {refused.stderr}")

members = fresh("members")
run([PROGRAM, "ensemble", "pit.toml", "-o", str(members), "-n", "2", "--threads", "1"])
ends = [table(members / f"member_00{k}")[-1]["reaction_door_y"] for k in range(2)]
check(np.isfinite(ends).all() and ends[0] != ends[1], f"members: {ends}")

values = {name: [f"stage[2].move[0].y={y}"] for name, y in (("up", "0.02 mm"), ("down", "-0.02 mm"))}
Path("sweep.toml").write_text(
    'base = "pit.toml"\n[grid]\nname = "doors"\n[grid.motion]\n'
    + "".join(f"{name} = {json.dumps(value)}\n" for name, value in values.items())
)
swept = fresh("swept")
run([PROGRAM, "sweep", "sweep.toml", "-o", str(swept), "--threads", "1"])
found = {name: [file for file in swept.rglob("run.h5") if name in str(file)] for name in values}
check(all(len(files) == 1 for files in found.values()), f"the sweep has the runs {found}")
force = {name: table(files[0].parent)[-1]["reaction_door_y"] for name, files in found.items()}
check(force["up"] > force["down"], f"a door that is pushed up bears less than one that is lowered: {force}")
