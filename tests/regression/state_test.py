"""States, checkpoints and packings that do not fit a case are refused with the key and both values, what may differ is
said, and nothing that is not at rest is called converged."""

import csv
import json
import shutil
from pathlib import Path

import h5py
import numpy as np
from program import PROGRAM, ROOT, check, content, fresh, run

FIRST = """kind = "probe"
title = "first"
[packing]
grains = 60
seed = 1
folder = "packings"
[engine]
precision = "double"
[probe]
pressure = "100 kPa"
strain = 1e-5
[[probe.path]]
gradient = [0, 0, 0, -1e-3]
increments = 3
constant_xx = true
"""
SECOND = """kind = "probe"
title = "second"
[packing]
file = "first/end_1.h5"
[engine]
precision = "double"
[probe]
strain = 1e-5
[[probe.path]]
gradient = [0, 0, 0, -1e-3]
increments = 1
"""
Path("first.toml").write_text(FIRST)
Path("second.toml").write_text(SECOND)


def words(command, case, settings=(), folder=None, *further):
    made = [PROGRAM, command, case, *further]
    if folder is not None:
        made += ["-o", str(folder)]
    for setting in settings:
        made += ["--set", setting]
    return made


def one_line(done, *parts):
    check(done.stderr.count("\n") == 1, f"not one line: {done.stderr}")
    for part in parts:
        check(part in done.stderr, f'"{part}" is not said: {done.stderr}')


run(words("run", "first.toml", [], fresh("first")))

# The state with its own soil goes on where it was; with another one it is refused by `check` and by `run`.
run(words("run", "second.toml", [], fresh("second")))
with Path("first/path.csv").open(newline="") as opened:
    last = list(csv.DictReader(opened))[-1]
with Path("second/path.csv").open(newline="") as opened:
    rows = list(csv.DictReader(opened))
for name in ("stress_xx_Pa", "stress_yy_Pa"):
    check(abs(float(rows[0][name]) / float(last[name]) - 1) < 1e-3, f"the state begins with another {name}")
check(all(row["status"] == "converged" for row in rows), f"a path that rests is called {rows}")
OTHER_SOILS = {
    "soil.modulus=300 MPa": ("soil.modulus: this case has 300 MPa", "was made with 3 GPa"),
    "soil.thickness=50 mm": ("soil.thickness: this case has 5 cm", "was made with 0.1 m"),
    "soil.friction=30 deg": ("soil.friction: this case has 30 deg", "was made with 25 deg"),
    "soil.rolling_limit=0": ("soil.rolling_limit: this case has 0", "was made with 0.6"),
    "soil.damping=0.2": ("soil.damping: this case has 0.2", "was made with 0.3"),
    "soil.size_maximum=5 mm": ("soil.size_maximum: this case has 5 mm", "was made with 4.75 mm"),
    'soil.sizes=["2 mm", "4.75 mm"]': ("soil.size", "this case has nothing"),
}
for setting, parts in OTHER_SOILS.items():
    settings = [setting] + (["soil.passing=[0, 1]"] if "sizes" in setting else [])
    for command in ("check", "run"):
        folder = fresh("refused") if command == "run" else None
        one_line(run(words(command, "second.toml", settings, folder), code=2), *parts)
    check(not Path("refused").exists(), "a refused run has written something")

# The engine's settings may differ and are said; a state that is not at rest for them is not called converged.
said = run(words("check", "second.toml", ["engine.precision=float"])).stdout
check("engine.precision: this case has float, the state in" in said, f"another precision is not said: {said}")
# Its results are written, and the run ends as one of an invalid test does.
strict = run(words("run", "second.toml", ["engine.hold_tolerance=1e-6", "engine.hold_cap=10"], fresh("strict")), code=3)
check("does not begin at rest" in strict.stderr, f"a restless state is not said: {strict.stderr}")
held = run(words("run", "second.toml", ["engine.hold_cap=0"], fresh("held")), code=3)
check("rows of the path ended at the step limit" in held.stderr, f"a restless path is not said: {held.stderr}")
check(Path("held/probe.csv").exists(), "a probe that is not at rest has lost its results")
with Path("strict/path.csv").open(newline="") as opened:
    for row in csv.DictReader(opened):
        rests = float(row["unbalanced_ratio"]) <= 1e-6
        check((row["status"] == "converged") == rests, f"status and unbalanced ratio disagree: {row}")

# Keys that a state makes idle are said, with the place.
said = run(words("check", "second.toml", ["probe.pressure=200 kPa", "packing.seed=3"])).stdout
check("warning: packing.seed (--set): not used" in said, f"an idle key is not said: {said}")
check("warning: probe.pressure (--set): not used, because packing.file is a stored state" in said, said)
check("not used" not in run(words("check", "first.toml")).stdout, "a key that counts is called idle")

# A state of an older version does not say its soil; one of another law has other histories.
old = Path("first/end_1.h5")
shutil.copy(old, "kept.h5")
with h5py.File(old, "r+") as opened:
    for name in [name for name in opened["labels"].attrs if name.startswith("soil.")]:
        del opened["labels"].attrs[name]
one_line(run(words("check", "second.toml"), code=2), "packing.file", "does not say which soil")
shutil.copy("kept.h5", old)
with h5py.File(old, "r+") as opened:
    keys = [name for name in opened["labels"].attrs if name.startswith("soil.")]
for key in keys:
    with h5py.File(old, "r+") as opened:
        del opened["labels"].attrs[key]
    for command in ("check", "run"):
        one_line(run(words(command, "second.toml"), code=2), "packing.file", f"does not say {key} of the soil")
    shutil.copy("kept.h5", old)
with h5py.File(old, "r+") as opened:
    opened["history"].attrs["names"] = np.bytes_("tangential_force,twist")
one_line(run(words("check", "second.toml"), code=2), "law: this program's contact law keeps", "twist")
shutil.copy("kept.h5", old)

# Numbers that another program has changed, through which the file's own checksums go: a state is refused, a packing of
# the store is made anew.
with h5py.File(old, "r+") as opened:
    opened.attrs["thickness"] = 0.3
one_line(run(words("check", "second.toml"), code=2), "packing.file", "were changed after this program had written them")
shutil.copy("kept.h5", old)
Path("store.toml").write_text('kind = "pack"\n[packing]\ngrains = 60\nseeds = [1]\nfolder = "store"\n')
shutil.rmtree("store", ignore_errors=True)
run([PROGRAM, "run", "store.toml"])
(stored,) = Path("store").glob("packing_*.h5")
kept = content(stored)
with h5py.File(stored, "r+") as opened:
    opened["radius"][3] *= 1.01
check("packing made" in run([PROGRAM, "run", "store.toml"]).stdout, "a changed packing was taken from the store")
check(content(stored) == kept, "a packing that is made anew has other bits")

# A file of another version, and one with a damaged byte anywhere, is refused in one line.
for version in (0, 2, 99, 1.5, "one"):
    with h5py.File(old, "r+") as opened:
        opened.attrs["format_version"] = version
    for command in ("check", "run"):
        one_line(run(words(command, "second.toml"), code=2), "packing.file", "format_version")
    shutil.copy("kept.h5", old)
whole = old.read_bytes()
refused = 0
for place in range(0, len(whole), 307):
    old.write_bytes(whole[:place] + bytes([whole[place] ^ 0x10]) + whole[place + 1 :])
    done = run(words("check", "second.toml"), code=None)
    check(done.returncode in (0, 2), f"byte {place} is damaged: exit {done.returncode}")
    refused += done.returncode == 2
    if done.returncode == 2:
        one_line(done, "packing.file")
check(refused > 0.5 * len(range(0, len(whole), 307)), f"only {refused} damaged files were refused")
shutil.copy("kept.h5", old)

# A stored packing of a recipe is compared by its recipe, too.
packing = next(Path("packings").glob("packing_*.h5"))
settings = [f"packing.file={packing.absolute()}"]
run(words("check", "second.toml", settings))
one_line(run(words("check", "second.toml", [*settings, "soil.damping=0.1"]), code=2), "soil.damping: this case has 0.1")

# A packing of another code comes to rest anew: its soil may differ and is said, its thickness must not.
SOURCE = ROOT / "tests/data/packings"
shutil.copy(SOURCE / "cps_d_150_particles.csv", "disc_particles.csv")
meta = json.loads((SOURCE / "cps_d_150_meta.json").read_text())
del meta["recipe"]  # which would say the soil before E does
Path("disc_meta.json").write_text(json.dumps({**meta, "Lz": 0.1, "E": 1e9}))
settings = ["packing.file=disc_particles.csv"]
said = run(words("check", "second.toml", settings)).stdout
check("soil.modulus: this case has 3 GPa, the packing in" in said and "was made with 1 GPa" in said, said)
one_line(
    run(words("check", "second.toml", [*settings, "soil.thickness=20 cm"]), code=2),
    "soil.thickness: this case has 0.2 m",
    "was made with 0.1 m",
)

# Resume names the key and both values, and says what may differ.
ELASTIC = """kind = "column"
material = "linear_elastic"
[ground]
height = "10 m"
surcharge = "1 kPa"
[column]
elements = 2
[gravity]
uniform_step = 0.5
"""
Path("column.toml").write_text(ELASTIC)
column = fresh("column")
run(words("run", "column.toml", [], column))
one_line(
    run(words("run", "column.toml", ["elastic.modulus=60 MPa", "column.elements=3"], column, "--resume"), code=2),
    "column.elements: this case has 3, the run was made with 2",
    "elastic.modulus: this case has 60 MPa, the run was made with 50 MPa",
)
said = run(words("run", "column.toml", ["output.every=2", "elastic.modulus=0.05 GPa"], column, "--resume")).stdout
check("output.every: this process has 2, the run was begun with 1" in said, f"what may differ is not said: {said}")
said = run(words("check", "column.toml", ["engine.preset=fast", "soil.modulus=1 GPa", "newton.relax_near=0.1"])).stdout
check("engine.preset (--set), " not in said and "soil.modulus (--set): not used" in said, said)
said = run(words("check", "column.toml", ["newton.relax_substeps=0", "newton.relax_near=0.1"])).stdout
check("newton.relax_near (--set): not used, because newton.relax_substeps = 0" in said, said)
