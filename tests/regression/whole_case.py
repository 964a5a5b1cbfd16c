"""A whole case against its expected.csv: ctest's NAME_long_test for every cases/NAME that has one.

The case's name is the only argument. A tunnel's increments must all have converged, and its figures are drawn.
"""

import sys

from expected import check_expected
from program import ROOT, check, command, draw_and_read_back, fresh, run, table

case = sys.argv[1]
results, packings = fresh("results"), fresh("packings")
run(command(case, results, [f"packing.folder={packings}"]), timeout=3500)
check_expected(results, ROOT / "cases" / case / "expected.csv", packings)
if case.startswith("tunnel_"):
    check(all(row["converged"] == 1 for row in table(results)), "an increment did not converge")
    names = [
        "settlement_troughs",
        "displacement",
        "deviatoric_strain",
        "ground_reaction",
        "convergence",
    ]
    if case != "tunnel_scene":  # a scene has no check of the stresses after gravity
        names.append("geostatic_stress")
    if case != "tunnel_elastic":
        names += ["void_ratio", "grain_rotation"]
    draw_and_read_back(results, [f"{name}.png" for name in names])
