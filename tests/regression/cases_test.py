"""Every case is checked and run, shrunk where it is long, and compared with what its expected.csv says."""

import subprocess
from pathlib import Path

from program import PROGRAM, ROOT, check, check_expected, command, fresh, run

# Settings that shorten a case; expected.csv is compared only where a case runs as it stands or nearly so.
SMALL_GRAINS = ["packing.grains=100", "packing.candidates=1", "packing.folder=packings"]
RUNS = {
    "tunnel_elastic": ([], True),
    "tunnel_quick": ([*SMALL_GRAINS, "ground.mesh_size_opening=2.5 m", "ground.mesh_size_far=8 m",
                      "gravity.uniform_step=0.1", "volume_loss.total=1 %", "volume_loss.increments=2",
                      "newton.tolerance=0.01"], False),
    "column": (["packing.grains=300", "packing.candidates=1", "packing.folder=packings", "column.elements=6"], True),
    "pack": (["packing.grains=100", "packing.seeds=[1]", "packing.folder=packings"], False),
}

for folder in sorted(path.parent for path in (ROOT / "cases").glob("*/case.toml")):
    case = folder.name
    check((folder / "README.md").exists(), f"cases/{case} has no README.md")
    checked = subprocess.run([PROGRAM, "check", str(folder / "case.toml")], capture_output=True, text=True, timeout=60)
    check(checked.returncode == 0, f"check of cases/{case}: {checked.stderr}")
    check(case in RUNS, f"cases/{case} is run by no test")
    settings, compare = RUNS[case]
    results = fresh(f"results_{case}")
    run(command(case, results, settings))
    if compare:
        check_expected(results, folder / "expected.csv")
    print(f"cases/{case}: ran")

# A sweep: two runs at a time, one summary, finished runs skipped when it is resumed.
Path("sweep.toml").write_text(f"""base = '{ROOT / "cases/tunnel_elastic/case.toml"}'
[[run]]
name = "stiff"
set = ["elastic.modulus=100 MPa", "volume_loss.increments=2"]
[[run]]
name = "soft"
set = ["elastic.modulus=20 MPa", "volume_loss.increments=2"]
""")
out = fresh("results_sweep")
for more in ([], ["--resume"]):
    run([PROGRAM, "sweep", "sweep.toml", "-o", str(out), "-j", "2", "--threads", "1", *more])
    rows = (out / "summary.csv").read_text().splitlines()
    check(len(rows) == 3 and all("finished,0" in row for row in rows[1:]), f"summary of the sweep: {rows}")
    check("crown_settlement" in rows[0], f"columns of the sweep: {rows[0]}")
