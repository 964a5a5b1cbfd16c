"""A run that is stopped or killed and resumed gives the bits of a run that was left alone."""

import shutil
import signal

import h5py
import numpy as np
from program import check, check_same, command, fresh, run, start_and_signal, table

CASE = "tunnel_elastic"
SETTINGS = ["volume_loss.increments=30", "volume_loss.total=5 %", "output.every=2"]

straight = fresh("straight")
run(command(CASE, straight, SETTINGS))

# Ctrl-C, once in each stage: the column, gravity, volume loss.
stopped = fresh("stopped")
code = start_and_signal(command(CASE, stopped, SETTINGS), stopped / "column/increments/0003.h5", signal.SIGINT)
check(code == 130, f"a run stopped by SIGINT ended with {code} instead of 130")
for wait_for in ("increments/0005.h5", "increments/0020.h5"):
    code = start_and_signal(command(CASE, stopped, SETTINGS, "--resume"), stopped / wait_for, signal.SIGTERM)
    check(code == 130, f"a run stopped by SIGTERM ended with {code} instead of 130")
run(command(CASE, stopped, SETTINGS, "--resume"))
check_same(straight, stopped)

# kill -9 leaves the last increment readable.
killed = fresh("killed")
for wait_for, resume in (("increments/0007.h5", []), ("increments/0019.h5", ["--resume"])):
    code = start_and_signal(command(CASE, killed, SETTINGS, *resume), killed / wait_for, signal.SIGKILL)
    check(code == -signal.SIGKILL, f"a killed run ended with {code}")
    with h5py.File(killed / "run.h5", "r") as result:
        last = max(result["increments"])
        check(result["increments"][last]["gauss/stress"].shape[1:] == (4, 3), "the last increment is not readable")
run(command(CASE, killed, SETTINGS, "--resume"))
check_same(straight, killed)

with h5py.File(killed / "run.h5", "r") as result:
    check("--resume" not in str(result["provenance"].attrs["command"]), "a resumed run says it began with --resume")

# A finished run has nothing to do; results are neither overwritten nor continued by another case.
before = (straight / "run.h5").read_bytes(), (straight / "run.h5").stat().st_mtime_ns
again = run(command(CASE, straight, SETTINGS, "--resume"))
check("finished already" in again.stdout, "a finished run does not say so")
check(
    before == ((straight / "run.h5").read_bytes(), (straight / "run.h5").stat().st_mtime_ns),
    "a finished run was written anew",
)
check_same(straight, killed)
run(command(CASE, straight, SETTINGS), code=2)
run(command(CASE, straight, [*SETTINGS, "elastic.poisson=0.2"], "--resume"), code=2)
column = run(command(CASE, straight / "column", SETTINGS, "--resume"), code=2)
check("kind column" in column.stderr, f"the column of a tunnel passes for the tunnel: {column.stderr}")
check_same(straight, killed)
run(command(CASE, straight, SETTINGS, "--replace"))
check_same(straight, killed)

# An increment of another run, one under another name and one of another version stop a resume; so do missing files of a
# run that its checkpoints call finished.
mixed = fresh("mixed")
start_and_signal(command(CASE, mixed, SETTINGS), mixed / "increments/0006.h5", signal.SIGTERM)
kept = (mixed / "increments/0003.h5").read_bytes()
for source, said in (
    (straight / "column/increments/0003.h5", "another run, whose case_kind is column"),
    (mixed / "increments/0005.h5", "a copy of increment 5"),
):
    shutil.copy(source, mixed / "increments/0003.h5")
    refused = run(command(CASE, mixed, SETTINGS, "--resume"), code=4)
    check(said in refused.stderr and "0003.h5" in refused.stderr, f"a wrong increment is not named: {refused.stderr}")
for attribute, value in (("fingerprint", "0123456789abcdef"), ("format_version", 2)):
    (mixed / "increments/0003.h5").write_bytes(kept)
    with h5py.File(mixed / "increments/0003.h5", "r+") as opened:
        opened.attrs[attribute] = value
    refused = run(command(CASE, mixed, SETTINGS, "--resume"), code=4)
    check(attribute in refused.stderr and "0003.h5" in refused.stderr, f"{attribute}: {refused.stderr}")
# A byte of a field that has changed, which no number of the increment's own tells.
with h5py.File(straight / "increments/0003.h5") as opened:
    dataset = opened["gauss/stress"]
    at = dataset.id.get_offset() + dataset.nbytes // 2
damaged = bytearray(kept)
damaged[at] ^= 0x10
(mixed / "increments/0003.h5").write_bytes(damaged)
refused = run(command(CASE, mixed, SETTINGS, "--resume"), code=4)
check("0003.h5" in refused.stderr and "checksum" in refused.stderr, f"a damaged field: {refused.stderr}")
(mixed / "increments/0003.h5").write_bytes(kept)
shutil.rmtree(mixed / "checkpoints")
shutil.copytree(straight / "checkpoints", mixed / "checkpoints")
refused = run(command(CASE, mixed, SETTINGS, "--resume"), code=4)
check("result files, but there are" in refused.stderr, f"missing results are not said: {refused.stderr}")

# A run killed before it had a run.h5 is no obstacle; another kind in its place leaves nothing of a replaced run.
for words in ([], ["--resume"], ["--replace"]):
    started = fresh("started")
    (started / "increments").mkdir(parents=True)
    (started / "run.log").write_text("")
    (started / "run.h5.1.tmp").write_text("half a file")
    run(command("column", started, ["material=linear_elastic"], *words))
run(command(CASE, started, SETTINGS, "--replace"))
check((started / "column").exists(), "a tunnel without a column")
run(command("column", started, ["material=linear_elastic"], "--replace"))
check(not (started / "column").exists(), "a replaced run left its column")

# The same with grains, and on another number of threads.
GRAINS = [
    "packing.grains=100",
    "packing.candidates=1",
    "packing.variety=1",
    "packing.folder=packings",
    "ground.mesh_size_opening=2.5 m",
    "ground.mesh_size_far=8 m",
    "gravity.uniform_step=0.1",
    "volume_loss.total=1 %",
    "volume_loss.increments=2",
    "newton.tolerance=0.01",
    "output.rves=[3, 4]",
]
straight = fresh("straight_grains")
run(command("tunnel_quick", straight, GRAINS, "--threads", "2"))
for folder, expected in ((straight, 2), (straight / "column", 0)):  # output.rves are points of the tunnel alone
    with h5py.File(folder / "increments/0001.h5", "r") as result:
        written = len(result.get("snapshots", ()))
        check(written == expected, f"{folder}: {written} snapshots instead of {expected}")
stopped = fresh("stopped_grains")
for wait_for, resume in (("column/increments/0010.h5", []), ("increments/0006.h5", ["--resume"])):
    code = start_and_signal(
        command("tunnel_quick", stopped, GRAINS, *resume, "--threads", "1"), stopped / wait_for, signal.SIGTERM
    )
    check(code == 130, f"a run of grains stopped by SIGTERM ended with {code} instead of 130")
run(command("tunnel_quick", stopped, GRAINS, "--resume", "--threads", "1"))
check_same(straight, stopped)

# A biaxial specimen, stopped in between: the same increments and the same histories.
SPECIMEN = ["material=linear_elastic", "biaxial_bvp.strain=20 %"]
straight = fresh("straight_specimen")
run(command("biaxial_bvp", straight, SPECIMEN))
stopped = fresh("stopped_specimen")
code = start_and_signal(command("biaxial_bvp", stopped, SPECIMEN), stopped / "increments/0005.h5", signal.SIGINT)
check(code == 130, f"a specimen stopped by SIGINT ended with {code} instead of 130")
run(command("biaxial_bvp", stopped, SPECIMEN, "--resume"))
check_same(straight, stopped)

# Other fields after a resume: the histories say what the earlier or the later files lack.
other = fresh("other_fields")
start_and_signal(command("biaxial_bvp", other, SPECIMEN), other / "increments/0005.h5", signal.SIGINT)
run(command("biaxial_bvp", other, [*SPECIMEN, 'output.fields=["stress"]'], "--resume"))
with h5py.File(other / "run.h5", "r") as result:
    columns = {name: column[:] for name, column in result["tables/gauss_histories"].items()}
check(len({len(column) for column in columns.values()}) == 1, "columns of different lengths")
check(
    not np.isnan(columns["stress_yy"]).any()
    and np.isnan(columns["strain_yy"][-1])
    and not np.isnan(columns["strain_yy"][0]),
    "the histories of a run resumed with other fields",
)

# A specimen of grains whose every increment is relaxed, some cut, stopped behind each few: the factor is kept as well.
GRAINS = [
    "packing.grains=60",
    "packing.candidates=1",
    "packing.folder=packings",
    "biaxial_bvp.columns=1",
    "biaxial_bvp.rows=2",
    "biaxial_bvp.strain=10 %",
    "biaxial_bvp.strain_step=0.5 %",
]
straight = fresh("straight_relaxed")
run(command("biaxial_bvp", straight, GRAINS, "--threads", "1"))
check(min(row["relaxations"] for row in table(straight)) > 0, "an increment was not relaxed: the test tests nothing")
stopped = fresh("stopped_relaxed")
for wait_for, resume in (("0003.h5", []), ("0008.h5", ["--resume"]), ("0014.h5", ["--resume"])):
    code = start_and_signal(
        command("biaxial_bvp", stopped, GRAINS, *resume, "--threads", "1"),
        stopped / "increments" / wait_for,
        signal.SIGTERM,
    )
    check(code == 130, f"a relaxed specimen stopped by SIGTERM ended with {code}")
run(command("biaxial_bvp", stopped, GRAINS, "--resume", "--threads", "1"))
check_same(straight, stopped)
