"""Grains that are pressed into one another: foretold by `check`, refused as packings, counted on a mesh, invalid as
tests of strength; and no alarm at 800 kPa."""

from pathlib import Path

import h5py
import numpy as np
from program import PROGRAM, ROOT, check, fresh, run, table

PACKING = '[packing]\ngrains = 60\nseeds = [1]\nfolder = "packings"\n'
fresh("packings")
Path("pack.toml").write_text(f'kind = "pack"\n{PACKING}')
Path("test.toml").write_text(
    f'kind = "biaxial"\n{PACKING}[biaxial]\nstrain = "10 %"\ninertial_number = 1e-3\npressures = ["800 kPa"]\n'
)
Path("column.toml").write_text(
    f'kind = "column"\n{PACKING}[engine]\npreset = "fast"\n[ground]\nheight = "20 m"\n[column]\nelements = 2\n'
    "[gravity]\nratio = 3\nuniform_step = 0.5\n"
)


def words(command, case, *settings, folder=None):
    made = [PROGRAM, command, case]
    if folder is not None:
        made += ["-o", str(fresh(folder))]
    for setting in settings:
        made += ["--set", setting]
    return made


# `check` says kappa and overlap, and warns beyond the range only.
for case, near, far in (
    ("pack.toml", "packing.pressure=800 kPa", "packing.pressure=10 MPa"),
    ("test.toml", "biaxial.strain=4 %", 'biaxial.pressures=["100 kPa", "5 MPa"]'),
    ("column.toml", "ground.height=40 m", "ground.height=230 m"),
    ("column.toml", "ground.unit_weight=29 kN/m3", "ground.unit_weight=500 kN/m3"),
):
    within, beyond = (run(words("check", case, setting)).stdout for setting in (near, far))
    check("kappa = " in within and "mean overlap about" in within, f"{case}: kappa is not foretold: {within}")
    check("warning" not in within, f"{case} at {near}: a false alarm: {within}")
    check("beyond what the contact law is good for: kappa =" in beyond, f"{case} at {far}: no warning: {beyond}")
    check("will interpenetrate" in beyond, f"{case} at {far}: interpenetration is not foretold: {beyond}")

# A unit weight that no ground has, with grains and without, and contacts that are softer or stiffer than all measured.
UNLIKELY = "# warning: ground.unit_weight (--set) is {} kN/m3, but ground weighs 7 kN/m3"
for case, setting, warning in (
    ("column.toml", "ground.unit_weight=2 kN/m3", UNLIKELY.format(2)),
    ("column.toml", "ground.unit_weight=31 kN/m3", UNLIKELY.format(31)),
    (str(ROOT / "cases/tunnel_elastic/case.toml"), "ground.unit_weight=2 kN/m3", UNLIKELY.format(2)),
    ("pack.toml", "soil.modulus=30 MPa", "# warning: soil.modulus of 30 MPa with soil.thickness of 0.1 m makes soft"),
    ("pack.toml", "soil.modulus=300 GPa", "makes stiff contacts: kappa = 5.06e+04 at 100 kPa"),
    ("test.toml", "soil.thickness=5 m", "makes soft contacts: kappa = 10.1 at 100 kPa, outside of 60 to 6000"),
):
    told = run(words("check", case, setting)).stdout
    check(told.count(warning) == 1, f"{case} at {setting} is not warned of once: {told}")
for case, setting in (
    ("column.toml", "ground.unit_weight=7 kN/m3"),
    ("column.toml", "ground.unit_weight=30 kN/m3"),
    ("pack.toml", "soil.modulus=400 MPa"),
    ("pack.toml", "soil.modulus=30 GPa"),
    ("column.toml", "soil.modulus=400 MPa"),
):
    told = run(words("check", case, setting)).stdout
    check("warning" not in told, f"{case} at {setting}: a false alarm: {told}")
for own in sorted((ROOT / "cases").glob("*/case.toml")):
    told = run(words("check", str(own))).stdout
    check("ground.unit_weight (" not in told and "contacts: kappa" not in told, f"{own}: a false alarm: {told}")

# A packing below the void ratio of the densest one is neither kept nor used.
made = run(words("run", "pack.toml", "packing.pressure=800 kPa"))
check("packing made" in made.stdout and "warning" not in made.stdout, f"800 kPa: {made.stdout}")
kept = len(list(Path("packings").glob("*.h5")))
refused = run(words("run", "pack.toml", "packing.pressure=5 MPa", "packing.seeds=[1, 2]"), code=None)
check(refused.returncode in (3, 4), f"interpenetrating packings end with {refused.returncode}")
check("is refused and left out: its void ratio of" in refused.stdout, f"not refused: {refused.stdout}")
check(len(list(Path("packings").glob("*.h5"))) == kept, "an interpenetrating packing is kept")

# Tests of strength: valid at 800 kPa, invalid at 2 MPa, where the packing itself is still within the range.
# The closing line has the mean of the dilatancy angles with their standard deviation.
done = run(words("run", "test.toml", "packing.seeds=[1, 2]", folder="test"))
check(done.stdout.count("  valid\n") == 2 and "converged" not in done.stdout, f"800 kPa: {done.stdout}")
with h5py.File("test/run.h5") as opened:
    psi = opened["tables/strength/dilatancy_angle"][()]
mean, deviation = np.degrees(np.arcsin(np.sin(psi).mean())), np.degrees(psi.std(ddof=1))
check(psi.max() - psi.min() > np.radians(0.3), "the two tests have the same dilatancy")
said = f"psi_max {mean:.1f} +- {deviation:.1f} deg (the mean of 2 tests, smoothed over 1.0 % of axial strain)"
check(said in done.stdout, f"{said}: {done.stdout}")
done = run(words("run", "test.toml", 'biaxial.pressures=["2 MPa"]', "biaxial.strain=14 %", folder="beyond"), code=3)
check(
    "beyond the contact law's range" in done.stdout and "are invalid because" in done.stderr, done.stdout + done.stderr
)
with h5py.File("beyond/run.h5") as opened:
    strength = opened["tables/strength"]
    check(list(strength["valid"]) == [0] and strength["mean_overlap"][0] > 0.06, "the table calls the test valid")

# Ground: counted in the table, one warning at the stage's end, and nothing of it within the range.
run(words("run", "column.toml", folder="shallow"))
rows = table("shallow")
check(all(row["out_of_range_points"] == 0 and 0 < row["mean_overlap"] < 0.06 for row in rows), f"400 kPa: {rows}")
check("beyond what the contact law" not in Path("shallow/run.log").read_text(), "a false alarm at 400 kPa")
run(words("run", "column.toml", "ground.unit_weight=500 kN/m3", folder="deep"), code=None)
rows = table("deep")
check(rows[0]["out_of_range_points"] == 0 and rows[-1]["out_of_range_points"] > 0, f"10 MPa: {rows}")
log = Path("deep/run.log").read_text()
check(log.count("RVEs were pressed beyond what the contact law is good for") == 1, f"the stage's end: {log[-600:]}")
check("RVEs beyond the contact law's range" in log, "the increments do not say it")

# A test that ends while the strength still rises measures no strength.
done = run(words("run", "test.toml", "biaxial.strain=1 %", "biaxial.window=0.2 %", folder="short"), code=3)
check("the strength still rises" in done.stdout, f"a test without a peak: {done.stdout}")

# A ground whose RVEs never come to rest is computed to its end, but does not end as one in equilibrium.
# They have no hold, and their tolerance is out of reach.
RESTLESS = ["engine.preset=standard", "engine.precision=float", "engine.hold_cap=0", "engine.hold_tolerance=1e-6",
            "engine.minimum_steps=1", "engine.maximum_steps=1"]  # fmt: skip
done = run(words("run", "column.toml", *RESTLESS, folder="restless"), code=3)
check("did not converge" in done.stderr and done.stderr.count("\n") == 1, f"not one line: {done.stderr}")
