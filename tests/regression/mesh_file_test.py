"""Stored meshes (`voussoir mesh`, ground.mesh_file): a run on the file has the bits of a run on the mesh that Gmsh
makes at once, also in a program that was built without Gmsh. Wrong files and files of another ground are refused."""

import os
import shutil
import subprocess
from pathlib import Path

import h5py
from program import PROGRAM, ROOT, check, check_same, command, fresh, run

WITHOUT_GMSH = os.environ["VOUSSOIR_WITHOUT_GMSH"]
CASE = ROOT / "cases" / "tunnel_elastic" / "case.toml"
GROUND = ["ground.mesh_size_opening=2.5 m", "ground.mesh_size_far=8 m"]
SETTINGS = [*GROUND, "volume_loss.increments=2", "gravity.ratio=2", "gravity.uniform_step=0.5"]
MESH = fresh("meshes") / "tunnel.h5"


def words(verb, settings, *further, program=PROGRAM):
    return [
        program,
        verb,
        str(CASE),
        *map(str, further),
        *(word for setting in settings for word in ("--set", setting)),
    ]


def on(file, *further):
    return [*SETTINGS, f"ground.mesh_file={Path(file).absolute()}", *further]


def expect_refusal(arguments, *fragments):
    done = subprocess.run(list(map(str, arguments)), check=False, capture_output=True, text=True, timeout=60)
    check(done.returncode == 2, f"{arguments}: exit {done.returncode} instead of 2: {done.stderr}")
    check(done.stderr.count("\n") == 1, f"{arguments}: not one line: {done.stderr}")
    for fragment in fragments:
        check(fragment in done.stderr, f"{arguments}: '{fragment}' is missing in: {done.stderr}")
    print(f"ok: {done.stderr.strip()}")


# The file is written once, and says what it holds.
said = run(words("mesh", GROUND, "-o", MESH)).stdout
check(said.startswith(f"{MESH}: ") and "elements" in said, f"mesh says {said}")
expect_refusal(words("mesh", GROUND, "-o", MESH), "is there already: add --replace")
before = MESH.read_bytes()
run(words("mesh", GROUND, "-o", MESH, "--replace"))
with h5py.File(MESH) as opened:
    check(opened.attrs["format"].decode().rstrip("\0") == "voussoir mesh", "the format is not named")
    corners, quads = opened["corners"][:], opened["quads"][:]
check(quads.min() == 0 and quads.max() == len(corners) - 1, "the nodes are not those of the elements")

# The same bits from the file, also without Gmsh; a run that was begun in one way goes on in the other.
made, stored, portable = fresh("made"), fresh("stored"), fresh("portable")
run(command("tunnel_elastic", made, SETTINGS))
run(command("tunnel_elastic", stored, on(MESH)))
check_same(made, stored, but=["input"])
run([WITHOUT_GMSH, *command("tunnel_elastic", portable, on(MESH))[1:]])
check_same(made, portable, but=["input"])
run([WITHOUT_GMSH, *command("tunnel_elastic", made, on(MESH), "--resume")[1:]])
expect_refusal(words("check", SETTINGS, program=WITHOUT_GMSH), "built without Gmsh", "ground.mesh_file")
expect_refusal(words("mesh", GROUND, "-o", "none.h5", program=WITHOUT_GMSH), "built without Gmsh")

# A file whose numbers were changed is refused; a run does not go on on another mesh.
other = MESH.parent / "other.h5"
shutil.copy(MESH, other)
with h5py.File(other, "r+") as opened:
    opened["corners"][len(corners) // 2, 0] += 1e-9
    opened["corners"].attrs.pop("checksum", None)  # arrays of 4096 bytes have none
expect_refusal(words("check", on(other)), "ground.mesh_file", "other.h5", "its mesh was changed")
with h5py.File(made / "run.h5", "r+") as opened:
    opened["mesh/coordinates"][len(corners) // 2, 0] += 1e-3
    opened["mesh/coordinates"].attrs.pop("checksum", None)
expect_refusal(command("tunnel_elastic", made, SETTINGS, "--resume"), "--resume", "was begun on another mesh")

# Another ground, wrong files, kinds without such a mesh.
for key, value, file_has in (
    ("diameter", "5.1 m", "ground.diameter = 5 m, but the case has 5.1 m"),
    ("cover_ratio", "2.5", "ground.cover_ratio = 2, but the case has 2.5"),
    ("mesh_size_far", "8.1 m", "ground.mesh_size_far = 8 m, but the case has 8.1 m"),
):
    expect_refusal(words("check", on(MESH, f"ground.{key}={value}")), "ground.mesh_file", "was made for " + file_has)
run(words("check", on(MESH, "ground.diameter=500 cm")))
truncated = MESH.parent / "truncated.h5"
truncated.write_bytes(before[: len(before) // 2])
expect_refusal(words("check", on(truncated)), "ground.mesh_file", "truncated.h5: cannot open the file")
expect_refusal(words("run", on(truncated), "-o", fresh("nothing")), "ground.mesh_file", "truncated.h5")
check(not Path("nothing").exists(), "a run on a truncated mesh has written something")
damaged = MESH.parent / "damaged.h5"
at = before.index(corners.tobytes()) + 80  # a number in the middle of the nodes' places
damaged.write_bytes(before[:at] + b"\xff" + before[at + 1 :])
expect_refusal(words("check", on(damaged)), "ground.mesh_file", "damaged.h5")
expect_refusal(words("check", on(CASE)), "ground.mesh_file", "case.toml")
expect_refusal(words("check", on(made / "run.h5")), "ground.mesh_file", "run.h5", "mesh")
expect_refusal(words("check", on("no_such.h5")), "ground.mesh_file", "does not exist")
expect_refusal(words("check", [*SETTINGS, "ground.mesh_file=[]"]), "ground.mesh_file", "must be text")
expect_refusal(words("mesh", on(MESH), "-o", "none.h5"), "ground.mesh_file", "stored already")
expect_refusal([PROGRAM, "mesh", ROOT / "cases/column/case.toml", "-o", "none.h5"], "kind", "only a tunnel")
expect_refusal([PROGRAM, "mesh", CASE], "--output")
check(not Path("none.h5").exists(), "a refused mesh was written")
