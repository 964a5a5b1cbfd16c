"""Wrong input gives one line, exit code 2, and writes nothing."""

import os
import shutil
import subprocess
from pathlib import Path

from bad_settings import LINES, SCENES, SETTINGS, SWEEPS
from program import PROGRAM, ROOT, check, command, fresh, run, table

CASE = ROOT / "cases" / "tunnel_elastic" / "case.toml"
OUT = fresh("results")


def expect_complaint(words, *fragments):
    done = subprocess.run([PROGRAM, *map(str, words)], check=False, capture_output=True, text=True, timeout=60)
    said = done.stderr
    check(done.returncode == 2, f"{words}: exit {done.returncode} instead of 2: {said}")
    check(said.count("\n") == 1, f"{words}: not one line: {said}")
    for fragment in fragments:
        check(fragment in said, f"{words}: '{fragment}' is missing in: {said}")
    check(not OUT.exists(), f"{words}: something was written")
    print(f"ok: {said.strip()}")


def with_line(text, name="bad.toml"):
    """The case with a line appended; returns its path."""
    Path(name).write_text(CASE.read_text() + "\n" + text + "\n")
    return name


def fresh_file(name):
    Path(name).unlink(missing_ok=True)
    return name


def run_with(*settings, case=CASE):
    return ["run", case, "-o", OUT, *(word for setting in settings for word in ("--set", setting))]


place = f"bad.toml:{CASE.read_text().count(chr(10)) + 3}"
for text, fragments, _ in LINES:
    expect_complaint(["run", with_line(text), "-o", OUT], "bad.toml", *fragments)
    expect_complaint(["check", with_line(text)], "bad.toml", *fragments)
expect_complaint(["check", with_line("[soil]\nfrictoin = '30 deg'")], place)
for settings, fragments, _ in SETTINGS:
    expect_complaint(run_with(*settings), *fragments)
for settings, fragments, _ in SCENES:
    expect_complaint(run_with(*settings, case=ROOT / "cases" / "trapdoor" / "case.toml"), *fragments)
expect_complaint(["run", "no_such_case.toml", "-o", OUT], "no_such_case.toml")
expect_complaint(["check", CASE, "--set", "output.rves=[1000000]"], "output.rves", "1000000")
os.mkfifo(fresh_file("pipe.h5"))
expect_complaint(run_with(f"packing.file={Path('pipe.h5').absolute()}"), "packing.file", "pipe")
Path("bad_particles.csv").write_text("id,x_m,y_m,r_m,theta_z_rad\n0,nowhere,0,0.001,0\n")
Path("bad_meta.json").write_text('{"hSize": [[0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]}')
Path("bad_packing.h5").write_text("no packing")
for name in ("bad_particles.csv", "bad_packing.h5"):
    for words in (["check", CASE], ["run", CASE, "-o", OUT]):
        expect_complaint([*words, "--set", f"packing.file={Path(name).absolute()}"], "packing.file", name)
expect_complaint(run_with("no_equals_sign"), "no_equals_sign")
expect_complaint(["run", CASE, "-o", CASE.parent], "no results of this program")
expect_complaint(["run", CASE, "-o", OUT, "--threads", "0"], "--threads")
expect_complaint(["run", CASE, "-o", OUT, "--resume", "--replace"], "--re")
expect_complaint(["walk", CASE], "unknown command walk")
expect_complaint([])
expect_complaint(["info", CASE], "case.toml")
for text, fragments, _ in SWEEPS:
    Path("sweep.toml").write_text(f"base = '{CASE}'\n{text}")
    expect_complaint(["sweep", "sweep.toml", "-o", OUT], *fragments)
expect_complaint(["run", CASE, "-o", ""], "--output", "is empty")
expect_complaint(["keys", "tunel"], "tunel is no kind of case, no table and no key; did you mean tunnel?")
expect_complaint(["keys", "soil.thicknes"], "soil.thicknes is no kind", "did you mean soil.thickness?")
expect_complaint(["keys", "rolling_limit"], "soil.rolling_limit or calibrate.rolling_limit?")
expect_complaint(["keys", "weather forecast"], "weather forecast is no kind", "`voussoir keys` lists them all")
expect_complaint(["keys", "x" * 100_000], "is no kind of case", "lists them all")
expect_complaint(["keys", "soil", "--json-schema"], "--json-schema is of a kind of case or of sweep files, not of soil")
expect_complaint(["keys", ""], "empty")
expect_complaint(["keys", "--markdown", "--json-schema"], "--json-schema", "--markdown")
expect_complaint(["keys", "tunnel", "pack"], "pack")
expect_complaint(["keys", "--mardkown"], "--mardkown")

# A run whose run.h5 has vanished or is damaged is known by its other files, and the line says the way on.
whole = fresh("whole")
settings = ["ground.mesh_size_opening=2.5 m", "ground.mesh_size_far=8 m", "volume_loss.increments=2", "gravity.ratio=2",
            "gravity.uniform_step=0.5"]  # fmt: skip
run(command("tunnel_elastic", whole, settings))
rows = table(whole)


def altered(change, left_out=()):
    """A copy of the run whose run.h5 was changed, without the folders named."""
    folder = fresh("altered")
    shutil.copytree(whole, folder)
    for name in left_out:
        shutil.rmtree(folder / name)
    (folder / "run.h5").unlink()
    change(folder / "run.h5")
    return folder


def attempt(folder, code, option, *fragments):
    said = run(command("tunnel_elastic", folder, settings, *option), code=code).stderr
    check(code == 0 or said.count("\n") == 1, f"{option}: not one line: {said}")
    for fragment in fragments:
        check(fragment in said, f"{option}: '{fragment}' is missing in: {said}")
    print(f"ok: {said.strip()}")


def vanish(_file):
    pass


def truncate(file):
    file.write_bytes((whole / "run.h5").read_bytes()[:1000])


kept = altered(vanish)
attempt(kept, 2, [], "run.h5 is missing", "--resume", "--replace")
attempt(kept, 0, ["--resume"])
columns = ("stage", "stage_index", "load_parameter", "residual")
check([[row[c] for c in columns] for row in table(kept)] == [[row[c] for c in columns] for row in rows], "other rows")
check("has vanished; it is made anew" in (kept / "run.log").read_text(), "the log does not tell of the new run.h5")
attempt(altered(vanish), 0, ["--replace"])
attempt(altered(vanish, ["checkpoints"]), 2, ["--resume"], "no checkpoint", "--replace")
# The checkpoint of a column is none of a tunnel, though both have one fingerprint.
kept = altered(vanish)
shutil.rmtree(kept / "checkpoints")
shutil.copytree(kept / "column" / "checkpoints", kept / "checkpoints")
attempt(kept, 2, ["--resume"], "kind column")
for change in (truncate, Path.touch, Path.mkdir, os.mkfifo):
    kept = altered(change)
    attempt(kept, 4, [], "its run.h5 cannot be used", "--resume", "--replace")
    attempt(kept, 4, ["--resume"], "its run.h5 cannot be used", "--resume", "--replace")
attempt(kept, 0, ["--replace"])
attempt(altered(truncate, ["checkpoints", "column"]), 0, ["--replace"])
# A finished run whose increments have vanished or are damaged is not simply finished.
kept = fresh("altered")
shutil.copytree(whole, kept)
(kept / "increments/0002.h5").unlink()
attempt(kept, 4, ["--resume"], "result files, but there are")
said = f"1 of the {len(rows)} result files that the run had written have vanished"
check(said in (kept / "run.log").read_text(), "the log does not say that an increment has vanished")
(kept / "increments/0001.h5").write_bytes(b"z" * 100)
attempt(kept, 4, ["--resume"], "0001.h5")
foreign = fresh("foreign")
foreign.mkdir()
(foreign / "run.h5").write_text("of somebody else")
for option in ([], ["--resume"], ["--replace"]):
    attempt(foreign, 2, option, "its run.h5 cannot be used")
check((foreign / "run.h5").read_text() == "of somebody else", "a file of somebody else is gone")
