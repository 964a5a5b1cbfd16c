"""One tiny run of each kind in the folder runs, an ensemble and a sweep: what the tests of Python read and draw."""

import json
import shutil
from pathlib import Path

import tiny_scene
from program import PROGRAM, command, run

GROUND = """
kind = "tunnel"
material = "linear_elastic"
[ground]
unit_weight = "20 kN/m3"
surcharge = "1 kPa"
width = "35 m"
height = "35 m"
diameter = "5 m"
cover_ratio = 2
mesh_size_opening = "2.4 m"
mesh_size_far = "9 m"
[gravity]
ratio = 3
uniform_step = 0.25
[volume_loss]
total = "10 %"
increments = 4
"""
SPECIMEN = """
kind = "biaxial_bvp"
packing = {grains = 60, candidates = 1, variety = 1, folder = "packings_of_runs"}
output = {rves = [0]}
[biaxial_bvp]
strain = 0.002
"""
# One iteration and no smaller step: no equilibrium.
FAULT = ["newton.maximum_iterations=1", "newton.tolerance=1e-6", "newton.relax_substeps=0", "newton.smallest_cut=1"]
SWEEP = f"""
base = "specimen.toml"
set = ["output.rves=[]"]
[grid]
name = "grid"
[grid.newton]
patient = ["packing.seed=1"]
hasty = {json.dumps(FAULT)}
"""
PACKED = ["packing.grains=60", "packing.folder=packings_of_runs"]
TESTS = [
    *PACKED,
    "biaxial.inertial_number=1e-4",
    "biaxial.strain=5 %",
    "biaxial.samples=60",
    "engine.precision=float",
    'biaxial.pressures=["400 kPa"]',
]
SEARCH = [
    "packing.seeds=[1]",
    "calibrate.rounds=0",
    "calibrate.confirm_grains=60",
    "calibrate.confirm_seeds=[1, 2]",
    'calibrate.thickness=["0.1 m", "0.2 m"]',
    "calibrate.rolling_stiffness=[0.5, 1]",
    "calibrate.rolling_limit=[0.5, 1]",
]


def _run(name):
    run([PROGRAM, "run", f"{name}.toml", "-o", f"runs/{name}"])


MAKES = {
    "tunnel": lambda: _run("tunnel"),
    "specimen": lambda: _run("specimen"),
    "scene": lambda: _run("scene"),
    "ensemble": lambda: run(
        [PROGRAM, "ensemble", "specimen.toml", "-o", "runs/ensemble", "-n", "2", "--set", "output.rves=[]"]
    ),
    "sweep": lambda: run([PROGRAM, "sweep", "sweep.toml", "-o", "runs/sweep"], code=3),
    "packings": lambda: run(
        command("pack", "runs/pack", ["packing.grains=60", "packing.folder=runs/packings", "packing.seeds=[1, 2]"])
    ),
    "probe": lambda: run(command("probe", "runs/probe", [*PACKED, "packing.seeds=[1]"])),
    "biaxial": lambda: run(command("biaxial", "runs/biaxial", [*TESTS, "packing.seeds=[1, 2]"])),
    "calibrate": lambda: run(command("calibrate_cps_d", "runs/calibrate", [*TESTS, *SEARCH])),
}


def make(*names):
    """Makes these runs anew, or all of them."""
    for folder in ("runs", "packings_of_runs"):
        shutil.rmtree(folder, ignore_errors=True)
    texts = {"tunnel": GROUND, "specimen": SPECIMEN, "sweep": SWEEP, "scene": tiny_scene.CASE}
    for name, text in texts.items():
        Path(f"{name}.toml").write_text(text)
    for name in names or MAKES:
        MAKES[name]()
