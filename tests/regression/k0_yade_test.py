"""K0 of Yade's packing, unloaded from 100 kPa to 1 kPa: a column has the numbers that Yade had.

docs/validation/yade.md tells where these numbers are from. A packing made at 1 kPa has 0.39 to 0.41 at 5 kPa, so that
the test notices a packing whose lost contacts were made again."""

import numpy as np
from program import ROOT, check, command, fresh, run

K0_OF_YADE = {5e3: 0.59, 20e3: 0.44, 100e3: 0.32, 200e3: 0.30, 700e3: 0.29}
PACKING = ROOT / "tests/data/yade/CPS_D_particles.csv"
ALLOWED = 0.02  # measured: 0.007 at the most; two programs that unload the same packing differ by 0.011

folder = fresh("column")
run(command("column", folder, [f"packing.file={PACKING}"]))
stress, k0 = np.loadtxt(folder / "k0.csv", delimiter=",", skiprows=1, unpack=True)
for vertical, expected in K0_OF_YADE.items():
    found = float(np.interp(vertical, stress, k0))
    check(abs(found - expected) < ALLOWED, f"K0 at {vertical / 1e3:g} kPa is {found:.3f}, Yade had {expected}")
    print(f"K0 at {vertical / 1e3:g} kPa: {found:.3f}, Yade {expected}")
