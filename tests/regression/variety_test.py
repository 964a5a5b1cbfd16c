"""Several packings at the points of a mesh (`packing.variety`): who holds which, the bits of one packing without the
key, stops and ranks, files of another code, and what is refused."""

import json
import shutil
import signal
import subprocess
from pathlib import Path

import h5py
import numpy as np
from program import PROGRAM, ROOT, SMALL_TUNNEL, check, check_same, command, fresh, run, start_and_signal

SETTINGS = [*SMALL_TUNNEL, "packing.grains=60", "packing.candidates=4", "volume_loss.increments=1"]
MIXED = [*SETTINGS, "packing.variety=3"]


def packing_of_points(folder):
    """The field `packing` in the last result file of a run, which must be the same in all of its files."""
    fields = []
    for name in sorted(Path(folder).glob("increments/*.h5")):
        with h5py.File(name) as file:
            fields.append(file["gauss/packing"][()].ravel())
    check(len(fields) > 1, f"{folder} has no increments")
    check(all(np.array_equal(fields[0], field) for field in fields), f"{folder}: a point has changed its packing")
    return fields[-1]


def refuse(settings, *fragments, case="tunnel_quick"):
    words = [PROGRAM, "check", str(ROOT / "cases" / case / "case.toml")]
    for setting in settings:
        words += ["--set", setting]
    said = run(words, code=2).stderr
    check(said.count("\n") == 1 and all(part in said for part in fragments), f"{settings}: {said}")


# Equal shares to within one point, in the column as in the ground; another seed makes another mix.
straight = fresh("straight")
run(command("tunnel_quick", straight, MIXED, "--threads", "2"))
for folder in (straight, straight / "column"):
    share = np.bincount(packing_of_points(folder).astype(int))
    check(len(share) == 3 and share.max() - share.min() <= 1, f"{folder}: shares {share}")
log = (straight / "run.log").read_text()
check(all(f"is used as packing {k}:" in log for k in range(3)), f"the log does not say the packings: {log}")

# Stopped and resumed, on other threads; on two ranks.
stopped = fresh("stopped")
words = command("tunnel_quick", stopped, MIXED, "--threads", "1")
start_and_signal(words, stopped / "increments/0004.h5", signal.SIGKILL)
run(command("tunnel_quick", stopped, MIXED, "--threads", "2", "--resume"))
check_same(straight, stopped)
version = subprocess.run([PROGRAM, "--version"], check=False, capture_output=True, text=True).stdout
if "no MPI" not in version and shutil.which("mpirun") is not None:
    spread = fresh("spread")
    launcher = ["env", "OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1", "mpirun", "--oversubscribe"]
    run([*launcher, "--bind-to", "none", "-n", "2", *command("tunnel_quick", spread, MIXED, "--threads", "1")])
    check_same(straight, spread)

# One packing has the bits of a case without the key, and no field.
plain, one = fresh("plain"), fresh("one")
short = ["column.elements=2", "gravity.uniform_step=0.5"]
run(command("tunnel_quick", plain, [*SETTINGS, *short]))
run(command("tunnel_quick", one, [*SETTINGS, *short, "packing.variety=1"]))
for name in sorted(path.name for path in plain.glob("increments/*.h5")):
    with h5py.File(plain / "increments" / name) as a, h5py.File(one / "increments" / name) as b:
        check("packing" not in a["gauss"] and set(a["gauss"]) == set(b["gauss"]), f"{name}: the fields differ")
        check(np.array_equal(a["gauss/stress"][()], b["gauss/stress"][()]), f"{name}: one packing has other bits")

# Files of another code: all of them, or the least biased.
SOURCE = ROOT / "tests/data/packings"
for name in ("a", "b"):
    for end in ("_particles.csv", "_meta.json"):
        shutil.copy(SOURCE / f"cps_d_150{end}", name + end)
text = Path("b_particles.csv").read_text().splitlines()
Path("b_particles.csv").write_text("\n".join([text[0], *reversed(text[1:])]) + "\n")
FILES = f"packing.file=['{Path('a_particles.csv').absolute()}', '{Path('b_particles.csv').absolute()}']"
SPECIMEN = ["biaxial_bvp.strain=0.2 %", "biaxial_bvp.strain_step=0.1 %", "biaxial_bvp.pressure=1 kPa"]
for twin in ("a_particles.csv", "a_meta.json"):
    refuse([FILES.replace("b_particles.csv", twin)], "packing.file", "twice", case="biaxial_bvp")
refuse([FILES], "packing.file", "twice", case="biaxial_bvp")  # the same grains in another order
Path("b_particles.csv").write_text((SOURCE / "cps_md_150_particles.csv").read_text())
Path("b_meta.json").write_text((SOURCE / "cps_md_150_meta.json").read_text())
two = fresh("two_files")
run(command("biaxial_bvp", two, [*SPECIMEN, FILES]))
check(np.array_equal(np.bincount(packing_of_points(two).astype(int)), [16, 16]), "two files are not mixed")
refuse([FILES], "packing.file", "several files", case="biaxial")
refuse([FILES, "packing.variety=3"], "packing.variety", "packing.file has only 2", case="biaxial_bvp")
refuse(["packing.file=[]"], "packing.file", "empty list", case="biaxial_bvp")
meta = json.loads(Path("b_meta.json").read_text())
Path("b_meta.json").write_text(json.dumps({**meta, "Lz": 0.05}))
refuse([FILES], "thickness", case="biaxial_bvp")

# A variety that cannot be had is no result of less variety.
refuse(["packing.variety=3", "packing.candidates=2"], "packing.variety", "packing.candidates has only 2")
refuse(["packing.variety=3", "packing.seeds=[1, 2]"], "packing.variety", "packing.seeds has only 2")
refuse(["packing.variety=0"], "packing.variety", "at least 1")
refuse(["packing.variety=33"], "packing.variety", "only 32 points", case="biaxial_bvp")
loose = ["packing.grains=30", "packing.void_ratio=0.9", "packing.variety=2", "packing.folder=packings"]
said = run(command("biaxial_bvp", fresh("loose"), [*SPECIMEN, *loose]), code=3)
check("of this recipe" in (said.stdout + said.stderr), f"a mix without packings: {said.stdout}{said.stderr}")
said = run([PROGRAM, "check", str(ROOT / "cases/biaxial/case.toml"), "--set", "packing.variety=2"]).stdout
check("packing.variety" in said and "only kinds with a mesh mix packings" in said, f"the idle key is not said: {said}")
check("candidates = 1 " in said, f"a key that is not used makes more packings: {said}")
print("ok")
