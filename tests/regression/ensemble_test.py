"""Ensembles: members draw seeds of their own; means and bands are numpy's of the members' files; an ensemble that was
killed or lost a member's folder and was resumed has the bits of one that was left alone; a member that finds no rest is
named and counted; `--until` adds members; what has nothing to draw is refused; the figures show the bands."""

import csv
import re
import shutil
import signal
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import h5py
import numpy as np
from program import PROGRAM, ROOT, SMALL_TUNNEL, check, content, fresh, run, start_and_signal, table

sys.path.insert(0, str(ROOT / "python"))
from voussoir.figures import reaction, troughs
from voussoir.figures.result import Result, plain

CASE = ROOT / "cases/tunnel_quick/case.toml"
SETTINGS = [
    *SMALL_TUNNEL,
    "packing.grains=60",
    "packing.candidates=2",
    "packing.seed=5",
    "volume_loss.increments=2",
    "gravity.uniform_step=0.5",
    "output.rves=[]",
    'output.microstructure=["fabric"]',
]
MEMBERS = 4
T = 3.182446305284263  # t_0.975 for 3 degrees of freedom


def ensemble(case, folder, *words, settings=SETTINGS):
    started = [PROGRAM, "ensemble", str(case), "-o", str(folder), *words]
    for setting in settings:
        started += ["--set", setting]
    return started


def refused(sentence, *words):
    done = run([PROGRAM, "ensemble", *words, "-o", "refused"], code=2)
    check(re.search(sentence, done.stderr) and done.stderr.count("\n") == 1, f"{words}: {done.stderr}")
    check(not Path("refused").exists(), f"{words} left a folder")


# What has nothing to draw, or no number.
fresh("refused")
refused("pack/case.toml:[0-9]+: kind: is pack: an ensemble needs a kind", str(ROOT / "cases/pack/case.toml"), "-n", "4")
refused("case.toml:[0-9]+: material: ", str(ROOT / "cases/tunnel_elastic/case.toml"), "-n", "4")
ONE = ["-n", "4", "--set", "packing.variety=1"]
refused("--set packing.seeds: names the seeds", str(CASE), *ONE, "--set", "packing.seeds=[1, 2]")
packing = next((ROOT / "tests/data/packings").glob("*_particles.csv"))
refused("--set packing.file: names the packings", str(CASE), *ONE, "--set", f"packing.file={packing}")
refused("-n: Value 1 not in range", str(CASE), "-n", "1")
refused("needs the number of members", str(CASE))
refused('--until: "5 m" is a length', str(CASE), "--until", "5 m")
refused("--until: must be a share between 0 and 1", str(CASE), "--until", "5")
refused(
    "--result: is wall_s; results of this case are .*surface_settlement",
    str(CASE),
    "--until",
    "5 %",
    "--result",
    "wall_s",
)
refused(
    "--result: is trough_width; ",
    str(CASE),
    "--until",
    "5 %",
    "--result",
    "trough_width",
    "--set",
    'output.fields=["stress"]',
)
refused("packing.seed: must be at most", str(CASE), "-n", "4", "--set", "packing.seed=8999999999999990")

# Four members.
fresh("packings")
whole = fresh("whole")
begun = time.monotonic()
done = run(ensemble(CASE, whole, "-n", str(MEMBERS), "-j", "2"))
print(f"{MEMBERS} members took {time.monotonic() - begun:.1f} s")
check("means and bands of 4 members" in done.stdout and not done.stderr, f"{done.stdout}{done.stderr}")

folders = [whole / f"member_{k:03}" for k in range(MEMBERS)]
seeds: list[int] = []
for folder in folders:
    with h5py.File(folder / "run.h5") as opened:
        packing = tomllib.loads(opened["input"][()].decode())["packing"]
    seeds += range(packing["seed"], packing["seed"] + packing["candidates"])
check(seeds == list(range(5, 5 + 2 * MEMBERS)), f"the members draw the seeds {seeds}")
rows = [table(folder) for folder in folders]
check(len({r[-1]["surface_settlement"] for r in rows}) == MEMBERS, "two members are the same")


def expect(group, members, what):
    """Mean, deviation and both bands are those of these values, one row a member."""
    members = np.asarray(members)
    deviation = members.std(axis=0, ddof=1)
    wanted = {
        "mean": members.mean(axis=0),
        "deviation": deviation,
        "mean_half_width": T * deviation / np.sqrt(MEMBERS),
        "prediction_half_width": T * deviation * np.sqrt(1 + 1 / MEMBERS),
    }
    # Sums of four numbers in another order differ in last bits; a deviation loses what the mean has more digits.
    size = np.nanmax(np.abs(members), initial=0)
    for name, values in wanted.items():
        found = group[name][()]
        same = np.allclose(found, values, rtol=1e-9, atol=1e-13 * size, equal_nan=True)
        check(same and found.shape == values.shape, f"{what}/{name}: {found} instead of {values}")
    if "members" in group:
        check(np.array_equal(group["members"][()], members, equal_nan=True), f"{what}/members")


results = [Result(folder) for folder in folders]
with h5py.File(whole / "ensemble.h5") as file:
    check(plain(file.attrs["format"]) == "voussoir ensemble", "its format")
    check(list(file["members/seed"][()]) == seeds[::2] and all(file["members/reduced"][()] == 1), "its members")
    check(abs(file["bands"].attrs["student_t"] - T) < 1e-9, "its t")
    loads = file["table/load_parameter"][()]
    check(np.array_equal(loads, [row["load_parameter"] for row in rows[0]]), "its increments are not the members'")
    for name in ("surface_settlement", "crown_settlement", "residual", "iterations", "evaluations"):
        expect(file["curves"][name], [[row[name] for row in r] for r in rows], name)
    times = ("wall_s", "time_grains", "time_tangents")
    for name in (*times, "peak_memory", "slowest_point", "converged", "load_parameter"):
        check(name not in file["curves"], f"{name} is no result of the study")

    # The columns that are made of fields are those of the tools.
    losing = np.flatnonzero([row["stage"] == "volume_loss" for row in rows[0]])
    for name in ("trough_settlement", "ground_reaction"):
        check(np.isnan(file["curves"][name]["mean"][: losing[0]]).all(), f"{name} before the volume loss")
    curves = np.array([reaction.curve(result)[1] for result in results])
    expect({k: v[()][..., losing] for k, v in file["curves/ground_reaction"].items()}, curves, "ground_reaction")
    least = file["curves/least_ground_reaction/members"][:, -1]
    check(np.array_equal(least, curves.min(axis=1)), f"the least ground reactions are {least}")
    with_loss = losing[1:]
    fits = [[troughs.Trough(result, i, 0.0) for i in result.loss_increments[1:]] for result in results]
    for name, of in (
        ("trough_settlement", lambda t: t.fit.largest),
        ("trough_inflection", lambda t: t.fit.inflection),
        ("trough_alpha", lambda t: t.fit.alpha),
        ("trough_width", lambda t: t.width),
        ("trough_misfit", lambda t: t.fit.misfit),
    ):
        ours = file["curves"][name]["members"][:, with_loss]
        theirs = np.array([[of(trough) for trough in member] for member in fits])
        check(np.allclose(ours, theirs, rtol=1e-6, atol=0), f"{name}: {ours} and of the tools {theirs}")
    settlements = [[trough.settlement for trough in member] for member in fits]
    check(
        np.allclose(file["trough/settlement/members"][:, with_loss], settlements, rtol=1e-9, atol=1e-12), "the troughs"
    )
    check(np.allclose(file["trough/x"], fits[0][0].x, rtol=0, atol=1e-12), "the places of the troughs")
    good = [sum(trough.fit.good for trough in column) for column in zip(*fits)]
    check(list(file["table/good_troughs"][with_loss]) == good, "the number of troughs that have the curve's shape")
    check(list(file["tables/k0/ratio/mean"].shape) == [33] and file["tables/k0/ratio/mean"][0] == 1, "K0")

    # Fields, of all increments.
    compared = 0
    for row in rows[0]:
        fields = file[f"fields/{row['index']:04}"]
        members = [h5py.File(folder / f"increments/{row['index']:04}.h5") for folder in folders]
        for location in ("node", "gauss"):
            left_out = {"rve_status", "packing", "fabric_direction"} & set(members[0][location])
            check(set(fields[location]) == set(members[0][location]) - left_out, f"{row}: {list(fields[location])}")
            for name, group in fields[location].items():
                expect(group, [member[location][name][()] for member in members], name)
                compared += 1
        for member in members:
            member.close()
    check(compared > 10 * len(loads), f"only {compared} fields")

with (whole / "curves.csv").open() as opened:
    lines = list(csv.DictReader(opened))
last = np.array([r[-1]["surface_settlement"] for r in rows])
check(len(lines) == len(loads) and lines[-1]["stage"] == "volume_loss", "curves.csv has other rows")
check(abs(float(lines[-1]["surface_settlement_mean"]) / last.mean() - 1) < 1e-8, f"curves.csv: {lines[-1]}")
half = T * last.std(ddof=1) * np.sqrt(1 + 1 / MEMBERS)
check(abs(float(lines[-1]["surface_settlement_prediction_half_width"]) / half - 1) < 1e-8, f"curves.csv: {lines[-1]}")
check(lines[0]["trough_width_mean"] == "", "curves.csv has a trough before the volume loss")
with (whole / "members.csv").open() as opened:
    lines = list(csv.DictReader(opened))
check([line["seed"] for line in lines] == [str(seed) for seed in seeds[::2]], f"members.csv: {lines}")
check(abs(float(lines[2]["surface_settlement"]) / last[2] - 1) < 1e-8, f"members.csv: {lines[2]}")
check((whole / "summary.csv").exists(), "there is no summary.csv")
print("means and bands are those of numpy, troughs and ground reaction those of the tools")


def check_same_ensemble(first, second):
    names = sorted(p.relative_to(first) for p in [*first.glob("*.h5"), *first.glob("fields/*.h5")])
    check(names == sorted(p.relative_to(second) for p in [*second.glob("*.h5"), *second.glob("fields/*.h5")]), "files")
    for name in names:
        left, right = content(first / name), content(second / name)
        check(left.keys() == right.keys(), f"{name}: {left.keys() ^ right.keys()}")
        different = [key for key in left if left[key] != right[key] and not key.startswith("provenance")]
        check(not different, f"{name}: {different} differ")
    for name in ("curves.csv", "members.csv"):
        check((first / name).read_bytes() == (second / name).read_bytes(), f"{name} differs")
    print(f"{first} and {second}: the same bits")


# Killed in the middle: the member that runs ends by itself after its increment, and nothing is reduced yet.
killed = fresh("killed")
process = subprocess.Popen(ensemble(CASE, killed, "-n", str(MEMBERS)), stdout=subprocess.DEVNULL)
deadline = time.monotonic() + 100
while not (killed / "member_001/increments/0002.h5").exists():
    check(process.poll() is None and time.monotonic() < deadline, "the second member did not begin")
    time.sleep(0.005)
process.kill()
process.wait()
while (killed / "member_001/run.lock").exists():
    check(time.monotonic() < deadline, "the member of a killed ensemble did not end")
    time.sleep(0.02)
check(not (killed / "ensemble.h5").exists(), "a killed ensemble has means and bands")
check(len(table(killed / "member_001")) < len(loads), "the member was not killed in its middle")
refusal = run(ensemble(CASE, killed, "-n", str(MEMBERS)), code=2).stderr
check("holds results already: add --resume" in refusal, refusal)

# A request to stop is passed on to the members and ends the ensemble with 130, without means and bands.
words = ensemble(CASE, killed, "-n", str(MEMBERS), "--resume")
code = start_and_signal(words, killed / "member_002/increments/0001.h5", signal.SIGTERM)
check(code == 130 and not (killed / "ensemble.h5").exists(), f"stopped with exit {code}")
with (killed / "summary.csv").open() as opened:
    ends = [line["status"] for line in csv.DictReader(opened)]
check(ends[:2] == ["finished"] * 2 and ends[3] == "not run", f"the summary of a stopped ensemble says {ends}")
run(ensemble(CASE, killed, "-n", str(MEMBERS), "--resume", "-j", "2"))
check_same_ensemble(whole, killed)

# A disk that takes no file of this size ends the reduction with 4 and leaves no half ensemble.
limited = ["sh", "-c", 'ulimit -f 60; exec "$@"', "sh", *ensemble(CASE, killed, "-n", str(MEMBERS), "--resume")]
done = run(limited, code=4)
check(done.stderr.count("\n") == 1 and "fields/0001.h5" in done.stderr, f"ulimit -f: {done.stderr}")
check(not (killed / "ensemble.h5").exists() and not list(killed.rglob("*.tmp")), "ulimit -f left files")
run(ensemble(CASE, killed, "-n", str(MEMBERS), "--resume", "-j", "2"))
check_same_ensemble(whole, killed)

# A member whose folder cannot be made, since a link there leads nowhere: it is named and counted, the others reduced.
lost = fresh("lost")
lost.mkdir()
shutil.copytree(whole / "member_000", lost / "member_000")
shutil.copytree(whole / "member_002", lost / "member_002")
shutil.copytree(whole / "member_003", lost / "member_003")
(lost / "member_001").symlink_to("/proc/no/such/folder")
done = run(ensemble(CASE, lost, "-n", str(MEMBERS), "--resume"), code=4)
named = (
    "1 of 4 members has no results up to the end and is no part of the means and bands: member_001 (machine failure)"
)
check(named in done.stderr, done.stderr)
with h5py.File(lost / "ensemble.h5") as file:
    check(list(file["members/reduced"][()]) == [1, 0, 1, 1] and file["members/exit_code"][1] == 4, "its members")
    check(
        plain(file["members/status"][1]) == "machine failure" and file["bands"].attrs["members"] == 3, "the lost member"
    )
    mean = np.delete(last, 1).mean()
    check(abs(file["curves/surface_settlement/mean"][-1] / mean - 1) < 1e-12, "the mean of three")
(lost / "member_001").unlink()
shutil.copytree(whole / "member_001", lost / "member_001")
run(ensemble(CASE, lost, "-n", str(MEMBERS), "--resume"))
check_same_ensemble(whole, lost)

# --until: the share that four members reach, and one that they do not.
share = last.std(ddof=1) / np.sqrt(MEMBERS) / last.mean()
done = run(ensemble(CASE, whole, "--until", f"{150 * share} %", "--resume"))
check(f"it took 4 members: the standard error of surface_settlement is {100 * share:.3g} %" in done.stdout, done.stdout)
with h5py.File(whole / "ensemble.h5") as file:
    check(abs(file["until"].attrs["reached"] / share - 1) < 1e-9, "the share that was reached")
done = run(ensemble(CASE, whole, "--until", "0.0001 %", "-n", "5", "-j", "2", "--resume"), code=3)
check(re.search(r"5 members were not enough: .* asks for 0.0001 %", done.stderr), done.stderr)
check("4 members: the standard error" in done.stdout and (whole / "member_004/run.h5").exists(), done.stdout)
with h5py.File(whole / "ensemble.h5") as file:
    check(file["bands"].attrs["members"] == 5, "five members")

# A loose packing finds rest with some seeds and not with others. Which ones depends on last bits: they are looked for.
LOOSE = ["packing.grains=60", "packing.folder=packings", "packing.candidates=1", "column.elements=2", "gravity.ratio=4"]


def seeds_without_rest(ratio):
    words = [PROGRAM, "run", str(ROOT / "cases/pack/case.toml"), "-o", str(fresh("looked"))]
    for setting in (*LOOSE[:2], f"packing.void_ratio={ratio}", "packing.seeds=[1, 2, 3, 4, 5]"):
        words += ["--set", setting]
    return {
        int(seed) for seed in re.findall(r"packing of seed (\d+) does not come to rest", run(words, code=None).stdout)
    }


def some_without_rest():
    for ratio in (0.29, 0.285, 0.295, 0.28, 0.3, 0.275, 0.305):
        restless = seeds_without_rest(ratio)
        if 1 <= len(restless) <= 3:
            return ratio, restless
    check(False, "no void ratio was found at which some of five packings find no rest")
    return None


loose, restless = some_without_rest()
print(f"at a void ratio of {loose} the seeds {sorted(restless)} find no rest")
COLUMN = ROOT / "cases/column/case.toml"
column = fresh("column")
settings = [*LOOSE, f"packing.void_ratio={loose}"]
done = run(ensemble(COLUMN, column, "-n", "5", "-j", "2", settings=settings), code=3)
names = ", ".join(f"member_{seed - 1:03} (no equilibrium)" for seed in sorted(restless))
count = f"{len(restless)} of 5 members {'has' if len(restless) == 1 else 'have'} no results up to the end"
check(count in done.stderr and done.stderr.count(f"part of the means and bands: {names}\n") == 1, done.stderr)
with h5py.File(column / "ensemble.h5") as file:
    absent = {int(seed) for seed, there in zip(file["members/seed"], file["members/reduced"]) if not there}
    check(absent == restless and file["bands"].attrs["members"] == 5 - len(restless), f"left out: {absent}")
    at_base = [table(column / f"member_{k:03}")[-1]["k0_at_base"] for k in range(5) if k + 1 not in restless]
    check(abs(file["curves/k0_at_base/mean"][-1] / np.mean(at_base) - 1) < 1e-12, "K0 of the members that found rest")

# Where no member finds rest, --until does not go on trying.
none = fresh("none")
settings = [*LOOSE, "packing.void_ratio=0.9"]
done = run(ensemble(COLUMN, none, "--until", "5 %", "-j", "2", settings=settings), code=3)
check("bands need two members with results up to the end, and there is none" in done.stderr, done.stderr)
check("4 of 4 members have no results" in done.stderr and not (none / "ensemble.h5").exists(), done.stderr)
with (none / "members.csv").open() as opened:
    check([line["status"] for line in csv.DictReader(opened)] == ["no equilibrium"] * 4, "members.csv")


def figures(folder, *words):
    script = [sys.executable, str(ROOT / "tools/figures.py"), str(folder), *words]
    done = subprocess.run(script, check=False, capture_output=True, text=True, timeout=120)
    check("Traceback" not in done.stderr + done.stdout, f"{words}: {done.stderr}")
    return done.returncode, done.stdout.splitlines(), done.stderr.splitlines()


# Figures: each is drawn or says why not; what cannot be read is told in one line.
status, said, complaints = figures(whole, "-o", "figures")
check((status, complaints) == (0, []) and len(said) == 7, f"figures: {status} {said} {complaints}")
for name in ("settlement", "ground_reaction", "trough", "trough_width", "k0"):
    file = Path("figures") / f"ensemble_{name}.png"
    check(f"wrote {file}" in said and file.stat().st_size > 20000, f"{file}: {said}")
check("skipped ensemble_specimen.png: whole/ensemble.h5 has no curve q_over_p" in said, f"{said}")
status, said, _ = figures(column, "-o", "figures", "--only", "ensemble_k0", "ensemble_settlement")
check(status == 0 and "skipped ensemble_settlement.png: there is no stage volume_loss" in said, f"{status} {said}")
whole_file = (killed / "ensemble.h5").read_bytes()
for what, index, words in (
    ("an ensemble without ensemble.h5", None, "is an ensemble without ensemble.h5"),
    ("half an ensemble.h5", whole_file[: len(whole_file) // 2], "ensemble.h5 cannot be read: it is damaged"),
    ("another file", (killed / "member_000/run.h5").read_bytes(), 'is no "voussoir ensemble" of this program'),
):
    (killed / "ensemble.h5").unlink(missing_ok=True)
    if index is not None:
        (killed / "ensemble.h5").write_bytes(index)
    status, said, complaints = figures(killed)
    check((status, said, len(complaints)) == (2, [], 1) and words in complaints[0], f"{what}: {status} {complaints}")
status, _, complaints = figures(whole, "--trends")
check(status == 2 and "trends are judged for single runs" in complaints[0], f"--trends: {status} {complaints}")
