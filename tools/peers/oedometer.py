"""K0 of the same packings in Voussoir and in Yade: oedometer.py VOUSSOIR FOLDER.

Three packings that Voussoir makes at 1 kPa, and the packing of tests/data/yade, made at 100 kPa and unloaded to 1 kPa.
Each is compressed from 1 kPa without lateral strain. Prints K0 at several vertical stresses."""

import json
import os
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
from compare import Packing

PEERS = Path(__file__).resolve().parent
ROOT = PEERS.parent.parent
UNLOADED = ROOT / "tests/data/yade/CPS_D_particles.csv"
SEEDS = (1, 2, 3)
STRESSES = np.array([2e3, 5e3, 10e3, 20e3, 50e3, 100e3])  # vertical, at which K0 is printed [Pa]
END = 105e3  # vertical stress at which Yade stops [Pa]
INERTIAL_NUMBERS = (1e-3, 1e-4)
CASE = """extends = "{soil}"
kind = "probe"
title = "oedometer"
[packing]
{packing}
[engine]
precision = "double"
inertial_number = 1e-4
hold_tolerance = 1e-4
hold_cap = 200000
maximum_steps = 100000
[probe]
pressure = "1 kPa"
strain = 1e-6
"""
PATH = ((1e-5, 40), (5e-5, 20), (2e-4, 25))  # axial strain of an increment, increments


def text_of(stress, ratio):
    return "  ".join(f"{np.interp(np.log(s), np.log(stress), ratio):.3f}" for s in STRESSES)


def run_voussoir(program, folder, packing):
    """Runs a probe of the packing that the lines of [packing] describe, and returns its path by seed."""
    soil = ROOT / "cases/soils/cps_d_literal.toml"
    segment = "[[probe.path]]\ngradient = [0, 0, 0, -{}]\nincrements = {}\n"
    folder.mkdir(parents=True, exist_ok=True)
    case = folder / "case.toml"
    case.write_text(CASE.format(soil=soil, packing=packing) + "".join(segment.format(*part) for part in PATH))
    with (folder / "run.log").open("w") as log:
        words = [program, "run", str(case), "-o", str(folder / "run"), "--replace"]
        subprocess.run(words, check=True, stdout=log, stderr=log)
    rows = np.genfromtxt(folder / "run/path.csv", delimiter=",", names=True)
    return {int(seed): rows[rows["seed"] == seed] for seed in np.unique(rows["seed"])}


def made_packings(folder):
    """{seed: packing} of Voussoir's store."""
    packings = {}
    for path in folder.glob("packing_*.h5"):
        with h5py.File(path) as file:
            cell = file["cell"][()].ravel()
            radius, x, y = (file[name][()].tolist() for name in ("radius", "x", "y"))
            packings[int(file["numbers"].attrs["seed"])] = Packing(radius, x, y, float(cell[0]), float(cell[3]))
    return packings


def given_packing(path):
    rows = np.genfromtxt(path, delimiter=",", names=True)
    size = json.loads(Path(str(path).replace("_particles.csv", "_meta.json")).read_text())["hSize"]
    return Packing(rows["r_m"].tolist(), rows["x_m"].tolist(), rows["y_m"].tolist(), size[0][0], size[1][1])


def run_yade(folder, packing):
    folder.mkdir(parents=True, exist_ok=True)
    task = vars(packing) | {"pressure": 1e3, "end": END, "inertial_numbers": INERTIAL_NUMBERS}
    (folder / "oedometer.json").write_text(json.dumps(task))
    words = ["yade", "-j1", "-x", "-n", str(PEERS / "yade_oedometer.py"), str(folder)]
    with (folder / "yade.log").open("w") as log:
        environment = os.environ | {"PYTHONPATH": str(PEERS)}
        subprocess.run(words, check=False, stdout=log, stderr=log, cwd=folder, env=environment)
    if not (folder / "yade.json").exists():
        sys.exit(f"Yade failed: see {folder / 'yade.log'}")
    return json.loads((folder / "yade.json").read_text())


def compare(name, path, folder, packing):
    stress, lateral = -path["stress_yy_Pa"], -path["stress_xx_Pa"]
    print(f"{name}, Voussoir                {text_of(stress, lateral / stress)}", flush=True)
    answer = run_yade(folder, packing)
    for number, rows in answer["curves"].items():
        xx, yy, _ = np.array(rows).T
        print(f"{name}, Yade, I = {float(number):<7g}       {text_of(yy, xx / yy)}", flush=True)
    print(f"{name}, Yade at rest: coordination {answer['coordination']:.2f}, unbalanced {answer['unbalanced']:.1e}")


def main():
    program, folder = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    print("vertical stress [kPa]:", "  ".join(f"{s / 1e3:g}" for s in STRESSES))
    file = f'file = "{UNLOADED}"'
    unloaded = run_voussoir(program, folder / "unloaded", file)
    compare("unloaded from 100 kPa", next(iter(unloaded.values())), folder / "unloaded", given_packing(UNLOADED))
    store = folder / "packings"
    seeds = f'seeds = {list(SEEDS)}\ngrains = 700\ncandidates = 1\nfolder = "{store}"'
    paths = run_voussoir(program, folder / "made", seeds)
    for seed, packing in sorted(made_packings(store).items()):
        compare(f"made at 1 kPa, seed {seed}", paths[seed], folder / f"made_{seed}", packing)


if __name__ == "__main__":
    main()
