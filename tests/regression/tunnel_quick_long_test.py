"""The whole of cases/tunnel_quick: its expected.csv, its figures, its XDMF file."""

from program import ROOT, check, check_expected, command, draw_and_read_back, fresh, run, table

results = fresh("results")
run(command("tunnel_quick", results, ["packing.folder=packings"]), timeout=3000)
check_expected(results, ROOT / "cases/tunnel_quick/expected.csv")
check(all(row["converged"] == 1 for row in table(results)), "an increment did not converge")
draw_and_read_back(
    results,
    [
        "settlement_troughs.png",
        "displacement.png",
        "deviatoric_strain.png",
        "void_ratio.png",
        "grain_rotation.png",
        "ground_reaction.png",
        "geostatic_stress.png",
        "convergence.png",
    ],
)
