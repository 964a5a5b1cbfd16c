"""Kinds without a mesh and sweeps: what is replaced, resumed, stopped; which fields a result file holds."""

import csv
import signal
import subprocess
import time
from pathlib import Path

import h5py
from program import PROGRAM, ROOT, check, check_same, command, fresh, run

PACK = ["packing.grains=60", "packing.seeds=[1]", "packing.candidates=1", "packing.folder=packings"]

# A probe is done again where that is asked for.
Path("probe.toml").write_text('kind = "probe"\n')
probe = [PROGRAM, "run", "probe.toml", "-o", str(fresh("probed"))]
for setting in PACK:
    probe += ["--set", setting]
check("6 tests take about" in run([PROGRAM, "check", "probe.toml"]).stdout, "`check` says nothing of a probe's cost")
run(probe)
first = Path("probed/probe.csv").read_bytes()
check("--replace" in run(probe, code=2).stderr, "a probe's folder does not say what to do")
run([*probe, "--resume"], code=2)
run([*probe, "--replace"])
check(Path("probed/probe.csv").read_bytes() == first, "a probe done again is another one")
with Path("probed/probe.csv").open(newline="") as opened:
    probes = {row["probe"]: row for row in csv.DictReader(opened)}
for name in ("xxxx", "yyyy"):
    before, turned, pushed = (
        float(probes[probe][column])
        for probe, column in (
            ("rotation", f"tangent_{name}_Pa"),
            ("rotation", f"tangent_after_{name}_Pa"),
            ("-yy", f"tangent_after_{name}_Pa"),
        )
    )
    check(abs(turned / before - 1) < 2e-3, f"tangent {name} {before} after a rotation of 1e-4: {turned}")
    check(pushed != before, f"tangent {name} after compression is the one before")

# The loading tangent is that of the probes' own strain, column by column; elsewhere rows have the tangent that was
# found.
words = [
    PROGRAM,
    "run",
    "probe.toml",
    "-o",
    str(fresh("probed_tangent")),
    "--set",
    "probe.tangent=loading",
    "--set",
    "probe.strain=1e-6",
    "--set",
    "engine.precision=double",
    "--set",
    "engine.hold_tolerance=1e-6",
    "--set",
    "engine.hold_cap=100000",
]
for setting in PACK:
    words += ["--set", setting]
check("tangent (loading)" in run(words).stdout, "the loading tangent is not shown")
with Path("probed_tangent/probe.csv").open(newline="") as opened:
    rows = {row["probe"]: row for row in csv.DictReader(opened)}
for probed, changed in (("xx", "xx"), ("xx", "yy"), ("yy", "xx"), ("yy", "yy"), ("xy", "xy")):
    tangent, change = float(rows[probed][f"tangent_{changed}{probed}_Pa"]), float(rows[probed][f"change_{changed}_Pa"])
    check(
        abs(tangent * 1e-6 / change - 1) < 0.02,
        f"tangent {changed}{probed} is {tangent:g} Pa, probed {change * 1e6:g} Pa",
    )
check(
    rows["xx"]["tangent"] == "loading" and rows["xx"]["tangent_xxyy_Pa"] != rows["xx"]["tangent_yyxx_Pa"],
    "the tangent's kind",
)

# A packing stored by this program is one to read: it comes to rest again where it was.
stored = next(Path("packings").glob("packing_*.h5"))
words = [PROGRAM, "run", "probe.toml", "-o", str(fresh("probed_file")), "--set", f"packing.file={stored.absolute()}"]
said = run(words).stdout
check("packing read" in said and "grains    60" in said, f"a stored packing is not read: {said}")

# Finished biaxial tests stay as they are.
settings = [*PACK, 'biaxial.pressures=["100 kPa"]', "biaxial.strain=3 %", "biaxial.inertial_number=1e-3"]
tests = fresh("biaxial")
code = subprocess.run(command("biaxial", tests, settings), check=False, capture_output=True).returncode
check(code in (0, 3), f"biaxial tests ended with {code}")
before = (tests / "run.h5").stat().st_mtime_ns
check(
    "finished already" in run(command("biaxial", tests, settings, "--resume"), code=code).stdout,
    "resume of biaxial tests",
)
check((tests / "run.h5").stat().st_mtime_ns == before, "finished biaxial tests were done again")
foretold = run([PROGRAM, "check", str(ROOT / "cases/biaxial/case.toml")]).stdout
check("tests take about" in foretold, "`check` says nothing of the cost of biaxial tests")

# Every field that a run writes can be asked for by its name, and then the others are not written.
GROUND = [
    "packing.grains=60",
    "packing.candidates=1",
    "packing.folder=packings",
    "column.elements=2",
    "gravity.ratio=10",
    "gravity.uniform_step=1",
    "newton.tolerance=0.05",
    'output.microstructure=["fabric", "coordination", "strong_networks"]',
]
whole = fresh("column")
run(command("column", whole, GROUND))
with h5py.File(whole / "increments/0001.h5", "r") as result:
    names = [name for group in ("node", "gauss") for name in result.get(group, ())]
run([PROGRAM, "check", str(ROOT / "cases/column/case.toml"), "--set", f"output.fields={names}".replace("'", '"')])
some = fresh("column_some")
run(command("column", some, [*GROUND, 'output.fields=["stress", "displacement"]']))
with h5py.File(some / "increments/0001.h5", "r") as result:
    written = sorted(name for group in ("node", "gauss") for name in result.get(group, ()))
    check(result.attrs["peak_memory"] > 1e6, "the peak memory is not recorded")
check(written == ["displacement", "stress"], f"output.fields was not obeyed: {written}")
check("peak memory" in (some / "run.log").read_text(), "the log does not tell memory and disk")

# A request to stop reaches the runs of a sweep, which end after their increment and are gone on from.
SWEPT = [
    "volume_loss.increments=15",
    "volume_loss.total=2 %",
    "ground.mesh_size_opening=2.5 m",
    "ground.mesh_size_far=8 m",
]
Path("sweep.toml").write_text(f"""base = '{ROOT / "cases/tunnel_elastic/case.toml"}'
[[run]]
name = "one"
set = {SWEPT}
[[run]]
name = "two"
set = {SWEPT[1:]}
""")
out = fresh("swept")
words = [PROGRAM, "sweep", "sweep.toml", "-o", str(out), "--threads", "1"]
process = subprocess.Popen(words, stdout=subprocess.DEVNULL)
deadline = time.monotonic() + 120
while not (out / "one/increments/0003.h5").exists():
    check(process.poll() is None and time.monotonic() < deadline, "the sweep did not begin")
    time.sleep(0.002)
process.send_signal(signal.SIGTERM)
check(process.wait(timeout=120) == 130, f"a stopped sweep ended with {process.returncode}")
rows = (out / "summary.csv").read_text().splitlines()
check("one,interrupted,130" in rows[1] and "two,not run" in rows[2], f"summary of a stopped sweep: {rows}")
run([*words, "--resume"])
run(command("tunnel_elastic", fresh("alone"), SWEPT))
check_same("alone", out / "one")
