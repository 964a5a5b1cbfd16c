"""Runs LAMMPS on a packing, with one input script for each run. The rates come from the "Loop time" that LAMMPS prints."""

import re
import shutil
import statistics
import subprocess
import tempfile
from pathlib import Path

DENSITY = 2650.0  # [kg/m3]
MODULUS, RATIO, FRICTION, ROLLING, LIMIT = 3.0e9, 0.5, 0.466307658, 1.0, 0.6  # host/case/case.hpp, SoilCase

SCRIPT = """
units si
dimension 2
atom_style sphere
boundary p p p
newton {newton}
comm_modify vel yes
read_data {data}
neighbor {skin} bin
neigh_modify delay 0 every 1 check yes
pair_style granular
pair_coeff * * hooke {kn} {eta} tangential linear_history {kt} 1.0 {friction} rolling sds {kr} {eta_r} {limit} damping velocity
timestep {dt}
fix move all nve/sphere disc
fix plane all enforce2d
fix rest all viscous {viscous}
compute contact all contact/atom
compute coordination all reduce ave c_contact
thermo_style custom step c_coordination
thermo_modify norm no
thermo 100000
run {settle}
unfix rest
fix shear all deform 1 x erate {rate} y erate -{rate} remap v
{runs}
"""


def installed():
    return shutil.which("lmp") is not None


def write_data(path, packing):
    lines = ["packing", "", f"{len(packing.radius)} atoms", "1 atom types", ""]
    lines += [f"0 {packing.width!r} xlo xhi", f"0 {packing.height!r} ylo yhi", "-0.005 0.005 zlo zhi", "", "Atoms", ""]
    for k, (r, x, y) in enumerate(zip(packing.radius, packing.x, packing.y), 1):
        lines.append(f"{k} 1 {2 * r!r} {DENSITY} {x!r} {y!r} 0")
    path.write_text("\n".join(lines) + "\n")


def run(packing, skin, newton, steps, repetitions):
    """(particle-steps/s of each repetition, contacts per grain at the end)."""
    mean = statistics.fmean(packing.radius)
    kn = MODULUS * mean
    lightest = (
        4.0 / 3.0 * 3.14159265 * min(packing.radius) ** 3 * DENSITY
    )  # discs have the weight of spheres here, which changes no rate
    dt = 0.1 * (lightest / kn) ** 0.5
    eta = 0.2 * (lightest * kn) ** 0.5
    with tempfile.TemporaryDirectory() as folder:
        data, script = Path(folder) / "packing.data", Path(folder) / "in.packing"
        write_data(data, packing)
        # R_eff = r/2 in LAMMPS' rolling: k_r = beta k_t r1 r2 and M <= eta r f_n become these.
        script.write_text(
            SCRIPT.format(
                newton=newton,
                data=data,
                skin=skin * 2 * mean,
                kn=kn,
                eta=eta,
                kt=RATIO * kn,
                friction=FRICTION,
                kr=4 * ROLLING * RATIO * kn,
                eta_r=eta,
                limit=2 * LIMIT,
                dt=dt,
                viscous=0.1 * lightest / dt,
                settle=5000,
                rate=1e-3 / (steps * repetitions * dt),
                runs=f"run {steps}\n" * repetitions,
            )
        )
        done = subprocess.run(
            ["lmp", "-in", script.name, "-log", "none"],
            cwd=folder,
            check=False,
            capture_output=True,
            text=True,
            env={"OMP_NUM_THREADS": "1", "PATH": "/usr/bin:/bin"},
        )
    if done.returncode != 0:
        raise RuntimeError("LAMMPS failed: " + " ".join(done.stdout.strip().splitlines()[-2:]))
    times = [float(t) for t in re.findall(r"Loop time of ([\d.eE+-]+)", done.stdout)][1:]
    contacts = re.findall(r"^\s*\d+\s+([\d.eE+-]+)\s*$", done.stdout, re.MULTILINE)
    return [len(packing.radius) * steps / t for t in times], float(contacts[-1])


def best(packing):
    """(particle-steps/s, contacts per grain, settings as text) with the best of the skins and newton settings."""
    tries = [
        (statistics.median(run(packing, skin, newton, 3000, 3)[0]), skin, newton)
        for skin in (0.03, 0.06, 0.1, 0.2)
        for newton in ("on", "off")
    ]
    _, skin, newton = max(tries)
    rates, contacts = run(packing, skin, newton, 10000, 5)
    return statistics.median(rates), contacts, f"skin {skin} d, newton {newton}"
