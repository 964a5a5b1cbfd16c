"""Exit statuses: the table of docs/reference/exit_status.md is that of `--help`; what finds no rest is 3 wherever it
happens; a sweep tells its runs apart."""

import csv
import os
import re
import signal
import subprocess
import time
from pathlib import Path

from program import PROGRAM, ROOT, check, command, fresh, run

# One table in the program, the same in the page, whose other tables stand behind it.
TABLE = (ROOT / "docs/reference/exit_status.md").read_text().split("<!-- end -->")[0]
documented = {int(code): text for code, text in re.findall(r"^\| (\d+) \| (.*) \|$", TABLE, re.MULTILINE)}
shown = {
    int(code): text for code, text in re.findall(r"^  (\d+) +(\S.*)$", run([PROGRAM, "--help"]).stdout, re.MULTILINE)
}
check(documented == shown, f"exit_status.md says {documented}, --help says {shown}")
check(sorted(shown) == [0, 2, 3, 4, 130], f"the codes are {sorted(shown)}")
check("first of these that holds" in run([PROGRAM, "--help"]).stdout, "--help has no rule for sweeps")

# A packing that finds no rest: 30 grains are never as loose as this. Wherever packings are made, it is 3.
LOOSE = ["packing.grains=30", "packing.candidates=1", "packing.void_ratio=0.9", "packing.folder=packings"]
GROUND = ["ground.mesh_size_opening=2.5 m", "ground.mesh_size_far=8 m", "column.elements=2"]
Path("probe.toml").write_text('kind = "probe"\n')
probe = [PROGRAM, "run", "probe.toml", "-o", str(fresh("out_probe"))]
for setting in LOOSE:
    probe += ["--set", setting]
calibration = ["calibrate.rolling_stiffness=[0.5, 1.0]", "calibrate.rolling_limit=[0.1]", "calibrate.confirm_grains=60",
               "calibrate.rounds=0"]  # fmt: skip
commands = {
    "pack": command("pack", fresh("out_pack"), LOOSE),
    "probe": probe,
    "biaxial": command("biaxial", fresh("out_biaxial"), LOOSE),
    "calibrate": command("calibrate_cps_d", fresh("out_calibrate"), [*LOOSE, *calibration]),
    "biaxial_bvp": command("biaxial_bvp", fresh("out_biaxial_bvp"), LOOSE),
    "column": command("column", fresh("out_column"), [*LOOSE, "column.elements=2"]),
    "tunnel": command("tunnel_quick", fresh("out_tunnel"), [*LOOSE, "packing.variety=1", *GROUND]),
}
for kind, words in commands.items():
    done = run(words, code=3)
    check(done.stderr.count("\n") == 1, f"{kind}: not one line: {done.stderr}")
    print(f"ok: {kind}: {done.stderr.strip()}")
for kind in ("biaxial_bvp", "column", "tunnel"):
    check("packings of this recipe" in Path(f"out_{kind}/run.log").read_text(), f"{kind}: the log has no reason")

# One pressure at which no packing can be used loses no test at the others: grains of 10 MPa lie in one another.
some = ["packing.grains=60", "packing.seeds=[1]", "packing.folder=packings", "biaxial.strain=5 %",
        "biaxial.pressures=['100 kPa', '10 MPa']", "biaxial.inertial_number=1e-3"]  # fmt: skip
done = run(command("biaxial", fresh("out_some"), some), code=3)
check("1 of 2 tests were left out" in done.stderr and "at 1e+04 kPa" in done.stdout, f"{done.stdout}{done.stderr}")
check("100" in (run([PROGRAM, "info", "out_some/run.h5"]).stdout), "the test at 100 kPa is lost")

# A store that cannot be written to is a failure of the machine, in a calibration too, where a packing without rest is
# only a set that cannot be used.
run([*commands["calibrate"], "--replace", "--set", "packing.folder=/proc/packings"], code=4)

# Runs of a sweep that end in different ways.
Path("sweep.toml").write_text(f"""base = '{ROOT / "cases/tunnel_elastic/case.toml"}'
[[run]]
name = "good"
set = ["volume_loss.increments=1", "ground.mesh_size_opening=2.5 m", "ground.mesh_size_far=8 m", "gravity.ratio=5"]
[[run]]
name = "numbers"
set = ["newton.tolerance=1e-15", "newton.maximum_iterations=2", "newton.smallest_cut=0.5", "newton.relax_substeps=0"]
[[run]]
name = "loose"
set = {["material=grains", *LOOSE, *GROUND]}
[[run]]
name = "disk"
[[run]]
name = "killed"
set = ["volume_loss.increments=300"]
""")


out = fresh("swept")
out.mkdir()
# A link that leads nowhere: the run's folder cannot be made. `good` is not looked at before its turn.
sweep = subprocess.Popen([PROGRAM, "sweep", "sweep.toml", "-o", str(out), "--threads", "1"], stdout=subprocess.DEVNULL)
(out / "disk").symlink_to("/proc/no/such/folder")
deadline = time.monotonic() + 200
while not (out / "killed/increments/0001.h5").exists():
    check(sweep.poll() is None and time.monotonic() < deadline, "the last run of the sweep did not begin")
    time.sleep(0.005)
(holder,) = re.findall(r"^process (\d+)$", (out / "killed/run.lock").read_text(), re.MULTILINE)
os.kill(int(holder), signal.SIGKILL)
check(sweep.wait(timeout=120) == 4, f"the sweep ended with {sweep.returncode}")
with (out / "summary.csv").open(newline="") as opened:
    ends = {row["name"]: (row["status"], row["exit_code"]) for row in csv.DictReader(opened)}
expected = {
    "good": ("finished", "0"),
    "numbers": ("no equilibrium", "3"),
    "loose": ("no equilibrium", "3"),
    "disk": ("machine failure", "4"),
    "killed": ("killed by SIGKILL", "137"),
}
check(ends == expected, f"the summary says {ends}")

# Without a failure of the machine a sweep is 3 where a run found no equilibrium.
text = Path("sweep.toml").read_text()
Path("numbers.toml").write_text(text[: text.index('[[run]]\nname = "disk"')])
run([PROGRAM, "sweep", "numbers.toml", "-o", str(fresh("swept_numbers")), "-j", "2"], code=3)


# No memory, at whatever place: 4 and one line, or the run has enough. Below that the program cannot even be loaded.
# Where OpenBLAS is the BLAS, it starts threads before the program begins, and ends the process when it cannot.
codes = []
one_thread = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
few = ["volume_loss.increments=1", "ground.mesh_size_opening=1.5 m", "gravity.ratio=9"]
for megabytes in range(100, 300, 16):
    words = command("tunnel_elastic", fresh("out_memory"), few, "--threads", "2")
    limited = ["sh", "-c", f'ulimit -v {megabytes * 1024}; exec "$@"', "sh", *words]
    done = subprocess.run(limited, check=False, capture_output=True, text=True, timeout=120, env=one_thread)
    codes.append(done.returncode)
    check(done.returncode in (0, 4, 127), f"{megabytes} MB: exit {done.returncode}: {done.stderr}")
    check(done.returncode != 4 or done.stderr.count("\n") <= 2, f"{megabytes} MB: {done.stderr}")
    if done.returncode == 0:
        break
check(4 in codes and codes[-1] == 0, f"runs with little memory ended with {codes}")
