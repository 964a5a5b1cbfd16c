"""Sweeps over grids: the list as table and as JSON; one run alone and gathering later leave what `-j` leaves; points
with members become the ensembles of `voussoir ensemble`; a run without equilibrium is named with its reason and the
others are done; `sweep.h5` repeats `summary.csv`; kinds without a mesh have results; cases/study lists all its runs."""

import csv
import json
import subprocess
import time
from pathlib import Path

import h5py
import numpy as np
from program import PROGRAM, ROOT, SMALL_TUNNEL, check, fresh, run

SETTINGS = [
    *SMALL_TUNNEL,
    "packing.grains=60",
    "packing.candidates=2",
    "volume_loss.increments=2",
    "gravity.uniform_step=0.5",
    "output.rves=[]",
]
TUNNELS = f"""base = '{ROOT / "cases/tunnel_quick/case.toml"}'
set = {json.dumps(SETTINGS)}
[grid]
name = "tunnels"
members = 2
"ground.cover_ratio" = [1.5, 2]
"""
# The first increment of the column cannot meet the tolerance 1e-15.
ELASTIC = f"""base = '{ROOT / "cases/tunnel_elastic/case.toml"}'
set = ["volume_loss.increments=2"]
[grid]
"ground.cover_ratio" = [1, 1.5]
[grid.tolerance]
loose = "newton.tolerance=1e-6"
tight = ["newton.tolerance=1e-15"]
"""


def sweep(file, folder, *words, code=0):
    return run([PROGRAM, "sweep", file, "-o", str(folder), *words], code=code)


def rows_of(folder):
    return {row["name"]: row for row in csv.DictReader((folder / "summary.csv").read_text().splitlines())}


def without_costs(row):
    return {name: value for name, value in row.items() if "time_" not in name and name not in ("wall_s", "peak_memory")}


def bands(file):
    with h5py.File(file) as ensemble:
        return {name: curve["mean"][()] for name, curve in ensemble["curves"].items()}


Path("tunnels.toml").write_text(TUNNELS)
Path("elastic.toml").write_text(ELASTIC)
NAMES = [f"tunnels/cover_ratio_{c}/member_00{m}" for c in ("1.5", "2") for m in (0, 1)]

# The list, before anything is run.
at_once = fresh("at_once")
listed = json.loads(sweep("tunnels.toml", at_once, "--list", "--json").stdout)
check([one["name"] for one in listed["runs"]] == NAMES, f"the runs of the list: {listed}")
first = listed["runs"][0]
check(first["axes"] == {"cover_ratio": "1.5", "member": "0"} and first["kind"] == "tunnel", f"the first run: {first}")
check(first["memory_mb"] > 1 and first["disk_mb"] > 0 and first["core_hours"] > 0, f"the first run's cost: {first}")
check(len({one["fingerprint"] for one in listed["runs"]}) == 4, "two runs have one fingerprint")
check(listed["points"][1]["members"] == NAMES[2:], f"the points of the list: {listed['points']}")
table = sweep("tunnels.toml", at_once, "--list").stdout
check(all(name in table for name in NAMES) and "4 runs take about" in table, f"the table: {table}")
check(not at_once.exists(), "--list has written something")

# All at once; one by one and then gathered.
sweep("tunnels.toml", at_once, "-j", "2", "--threads", "1")
one_by_one = fresh("one_by_one")
for name in reversed(NAMES):
    sweep("tunnels.toml", one_by_one, "--only", name, "--threads", "1")
check(not (one_by_one / "summary.csv").exists(), "--only has gathered")
sweep("tunnels.toml", one_by_one, "--gather")
ours, theirs = rows_of(at_once), rows_of(one_by_one)
check(list(ours) == NAMES and list(theirs) == NAMES, f"the rows of both: {list(ours)}, {list(theirs)}")
for name in NAMES:
    check(without_costs(ours[name]) == without_costs(theirs[name]), f"{name} differs between both ways")
check(float(ours[NAMES[0]]["surface_settlement"]) > float(ours[NAMES[2]]["surface_settlement"]) > 0, "the settlements")
check(0 < float(ours[NAMES[0]]["least_ground_reaction"]) < 1, "the ground reaction")
files = [sorted(str(path.relative_to(top)) for path in top.rglob("*")) for top in (at_once, one_by_one)]
check(files[0] == files[1], f"the folders differ: {set(files[0]) ^ set(files[1])}")

# sweep.h5 repeats the table, and each point is the ensemble that `voussoir ensemble` makes.
with h5py.File(at_once / "sweep.h5") as file:
    check(file.attrs["format"] in ("voussoir sweep", b"voussoir sweep"), "the format of sweep.h5")
    check([name.decode() for name in file["runs/name"]] == NAMES, "the names in sweep.h5")
    check([value.decode() for value in file["axes/cover_ratio"]] == ["1.5", "1.5", "2", "2"], "an axis in sweep.h5")
    check(
        [name.decode() for name in file["ensembles/name"]] == ["tunnels/cover_ratio_1.5", "tunnels/cover_ratio_2"], ""
    )
    settlement = file["results/surface_settlement"]
    check(settlement.attrs["unit"] in ("m", b"m"), "the unit of a result")
    wanted = [float(ours[name]["surface_settlement"]) for name in NAMES]
    check(np.allclose(settlement[()], wanted, rtol=1e-8), f"results in sweep.h5: {settlement[()]}, {wanted}")
alone = fresh("ensemble")
words = [word for setting in (*SETTINGS, "ground.cover_ratio=2") for word in ("--set", setting)]
run([PROGRAM, "ensemble", str(ROOT / "cases/tunnel_quick/case.toml"), "-n", "2", "-o", str(alone), *words])
mean, wanted = bands(at_once / "tunnels/cover_ratio_2/ensemble.h5"), bands(alone / "ensemble.h5")
check(mean.keys() == wanted.keys() and len(mean) > 10, f"the curves of the ensembles: {mean.keys() ^ wanted.keys()}")
check(all(np.array_equal(mean[name], wanted[name], equal_nan=True) for name in mean), "the means of the ensembles")

# A missing first member: the others keep their own seeds.
seeds = [int(row["seed"]) for row in csv.DictReader((at_once / "tunnels/cover_ratio_2/members.csv").open())]
(one_by_one / "outcomes/tunnels__cover_ratio_2__member_000.json").unlink()
done = sweep("tunnels.toml", one_by_one, "--gather", code=130)
left = list(csv.DictReader((one_by_one / "tunnels/cover_ratio_2/members.csv").open()))
check([int(row["seed"]) for row in left] == seeds[1:], f"the seeds of the members that are left: {left}, {seeds}")
check("voussoir: tunnels/cover_ratio_2: means and bands need two members" in done.stderr, f"which point: {done.stderr}")
check(not (one_by_one / "tunnels/cover_ratio_2/ensemble.h5").exists(), "an ensemble of one member")

# Runs without equilibrium are named with their reason; the others are done.
failing = fresh("failing")
done = sweep("elastic.toml", failing, "-j", "2", "--threads", "1", code=3)
check("2 of 4 runs did not end well" in done.stderr, f"the failed runs: {done.stderr}")
rows = rows_of(failing)
for name, row in rows.items():
    check(row["status"] == ("no equilibrium" if "tight" in name else "finished"), f"{name}: {row['status']}")
    if "tight" in name:
        check(
            f"{name} (no equilibrium): no equilibrium was found" in done.stderr, f"{name} has no reason: {done.stderr}"
        )
        check("column failed: max_iterations" in done.stderr, f"the reason is not that of the log: {done.stderr}")
sweep("elastic.toml", failing, "--gather", code=3)
check(rows_of(failing) == rows, "gathering again has changed the table")
sweep("elastic.toml", failing, "--only", "cover_ratio_1-tight", "--resume", code=3)
for kept in (failing / "outcomes").glob("*"):
    outcome = json.loads(kept.read_text())
    check((outcome["exit_code"] == 3) == ("tight" in kept.name), f"{kept}: {outcome}")
(failing / "outcomes/cover_ratio_1-loose.json").write_text("{")
done = sweep("elastic.toml", failing, "--gather", code=4)
check("cover_ratio_1-loose.json is no outcome" in done.stderr, f"a damaged outcome: {done.stderr}")
(failing / "outcomes/cover_ratio_1-loose.json").unlink()
done = sweep("elastic.toml", failing, "--gather", code=130)
check("cover_ratio_1-loose (not run)" in done.stderr, f"a run without an outcome: {done.stderr}")

# Gathering looks at what lies in the folders: results of another case, damaged ones, none.
Path("changed.toml").write_text(ELASTIC.replace("volume_loss.increments=2", "volume_loss.increments=3"))
done = sweep("changed.toml", failing, "--gather", code=2)
check(done.stderr.count("(wrong input): its folder holds results of another case") == 4, f"{done.stderr}")
check("surface_settlement" not in rows_of(failing)["cover_ratio_1.5-loose"], "results of another case in the table")
(failing / "cover_ratio_1.5-loose/run.h5").write_text("junk")
check("(machine failure)" in sweep("elastic.toml", failing, "--gather", code=130).stderr, "a damaged run.h5")
(failing / "cover_ratio_1.5-loose/run.h5").unlink()
check("its run.h5 is missing" in sweep("elastic.toml", failing, "--gather", code=130).stderr, "a missing run.h5")
for path, sentence in ((failing / "cover_ratio_1-tight", "choose another folder"), ("elastic.toml", "is not a folder")):
    check(sentence in sweep("elastic.toml", path, "--gather", code=2).stderr, f"--gather in {path}")

# While another process holds the sweep, --only leaves its outcomes alone.
Path("long.toml").write_text(ELASTIC.split("[grid]", maxsplit=1)[0] + '[grid]\n"volume_loss.increments" = [2, 3000]\n')
first = fresh("held") / "outcomes/increments_2.json"
with subprocess.Popen([PROGRAM, "sweep", "long.toml", "-o", "held", "--threads", "1"]) as holder:
    while not first.exists() and holder.poll() is None:
        time.sleep(0.02)
    kept = first.read_text()
    refused = sweep("long.toml", "held", "--only", "increments_2", "--resume", code=None)
    holder.terminate()
check("is held by process" in refused.stderr and refused.returncode == 2, f"--only beside a sweep: {refused}")
check(first.read_text() == kept, "--only has changed an outcome")

# What cannot be asked for.
for options, sentence in (
    (("--only", "nothing"), "is no run of"),
    (("--only", "cover_ratio_1-loose", "--list"), "excludes"),
    (("--gather", "--list"), "excludes"),
    (("--json",), "requires"),
):
    refused = sweep("elastic.toml", fresh("refused"), *options, code=2)
    check(sentence in refused.stderr and not Path("refused").exists(), f"{options}: {refused.stderr}")

# Tests of packings: means over the packings, with standard errors.
Path("tests.toml").write_text(f"""base = '{ROOT / "cases/biaxial/case.toml"}'
set = ["packing.grains=150", "packing.seeds=[1, 2]", "packing.folder=packings", "biaxial.strain=4 %", \
"biaxial.inertial_number=1e-3", "biaxial.samples=200"]
[grid]
"biaxial.pressures" = [["100 kPa"], ["200 kPa", "400 kPa"]]
""")
tests = fresh("tests_of_packings")
sweep("tests.toml", tests, "-j", "2", "--threads", "1", code=None)
rows = rows_of(tests)
check(list(rows) == ["pressures_100kPa", "pressures_200kPa_400kPa"], f"the names of arrays: {list(rows)}")
row = rows["pressures_200kPa_400kPa"]
with h5py.File(tests / row["name"] / "run.h5") as file:
    strength = file["tables/strength"]
    of_packing = [strength["peak_angle"][()][strength["seed"][()] == seed].mean() for seed in (1, 2)]
    check(row["tests"] == "4" and strength["valid"][()].all(), f"the tests: {row}")
check(np.isclose(float(row["peak_angle"]), np.mean(of_packing)), f"the mean angle: {row['peak_angle']}, {of_packing}")
error = abs(of_packing[0] - of_packing[1]) / 2
check(np.isclose(float(row["peak_angle_error"]), error, rtol=1e-6), f"its standard error: {row}, {error}")
check(row["pressures"] == '["200 kPa", "400 kPa"]', f"the axis: {row['pressures']}")

# The study: its cases are accepted, and its runs have the names of its folders.
study = sweep(str(ROOT / "cases/study/study.toml"), "study", "--list").stdout
for name in ("tunnels/cps_d_cd3/member_003", "element_tests/cpg_d", "rve_size/cpg_d-grains_2500"):
    check(name in study, f"cases/study has no run {name}")
