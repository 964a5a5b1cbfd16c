"""The examples with scikit-fem: closed forms by linear elasticity in place of the grains, steps that are cut, and with
grains the biaxial test of the program."""

import os
import sys
import time
from pathlib import Path

import numpy as np
from elastic_batch import ElasticBatch, plane_strain_stiffness
from program import ROOT, check, command, fresh, run, table
from python_package import voussoir
from skfem import MeshQuad
from tutorial_pages import Reader, follow

sys.path.insert(0, str(ROOT / "python/examples"))
os.environ["MPLBACKEND"] = "agg"

STIFFNESS = plane_strain_stiffness(50e6, 0.3)
P0 = 100e3


def elastic(basis):
    return ElasticBatch(basis.dx.size, P0)


def close(found, wanted, tolerance, what):
    error = abs(found / wanted - 1)
    check(error <= tolerance, f"{what}: {found} is off {wanted} by {error:.1e}")


def check_elastic_biaxial():
    """sigma_yy = -p0 + (D22 - D12^2/D11) ln(h/h0) with sigma_xx held. The criterion on the residual is 1e-10."""
    from scikit_fem_biaxial import biaxial  # noqa: PLC0415

    stiffness = STIFFNESS[1, 1] - STIFFNESS[0, 1] ** 2 / STIFFNESS[0, 0]
    for k, (stress, ground) in enumerate(biaxial(elastic, 5, tolerance=1e-10)):
        close(stress, P0 - stiffness * np.log(1 - 1e-3 * (k + 1)), 1e-11, f"elastic biaxial test, increment {k + 1}")
        check(ground.evaluations <= 3 * (k + 1), f"elastic increments took {ground.evaluations} evaluations")


def check_elastic_footing():
    """A footing on the whole surface: sigma_yy = -p0 + D22 ln(h/h0). Where points fail, steps are cut."""
    from scikit_fem_footing import HALF_WIDTH, footing, grid  # noqa: PLC0415

    mesh = MeshQuad.init_tensor(np.linspace(0, HALF_WIDTH, 3), np.linspace(-1, 0, 3))
    boundaries = grid(HALF_WIDTH, 1.0)[1]

    def column(fails):
        def make_batch(basis):
            batch = elastic(basis)
            batch.fails = fails
            return batch

        return footing(make_batch, 0.02, 4, P0, mesh=(mesh, boundaries), tolerance=1e-10)

    for fails, increments in ((lambda h: np.zeros(len(h), bool), 4), (lambda h: h[:, 1, 1] < -3e-3, 8)):
        rows = [(settlement, pressure) for settlement, pressure, _ in column(fails)]
        check(len(rows) == increments, f"the column took {len(rows)} increments, not {increments}")
        check(np.isclose(rows[-1][0], 0.02), f"the column ends at {rows[-1][0]} m")
        for settlement, pressure in rows:
            close(pressure, P0 - STIFFNESS[1, 1] * np.log(1 - settlement), 1e-11, f"column at {settlement} m")


def check_grains_biaxial():
    """The program's `biaxial_bvp` with the same packing and the same criterion, without relaxation. Every second point
    is a mirror image, so that the specimen deforms unevenly. 1e-4 is what was measured for 10 increments."""
    from scikit_fem_biaxial import biaxial  # noqa: PLC0415
    from scikit_fem_footing import in_turn  # noqa: PLC0415

    packing = voussoir.make_packings(grains=150, pressure=P0, folder="packings")
    settings = {
        "packing.grains": 150,
        "packing.mirrored": "true",
        "packing.folder": "packings",
        "newton.tolerance": 1e-4,
        "newton.relax_substeps": 0,
        "biaxial_bvp.strain": "1 %",
    }
    run(command("biaxial_bvp", fresh("program"), [f"{key}={value}" for key, value in settings.items()]))
    check(len(list(Path("packings").glob("*.h5"))) == 1, "the program and Python do not use the same packing")
    rows = table("program")
    evaluations = 0
    for row, (stress, ground) in zip(
        rows, biaxial(lambda basis: voussoir.RveBatch(packing, basis.dx.size, mirrored=in_turn(basis)), tolerance=1e-4)
    ):
        close(stress, row["axial_stress"], 4e-4, f"biaxial test at {row['load_parameter']}")
        evaluations = ground.evaluations
        check(np.ptp(ground.answer.stress[:, 0, 1]) > 100, "the specimen deforms evenly, which shows little")
    print(f"evaluations: {evaluations}, of the program {sum(row['evaluations'] for row in rows)}")


def follow_page():
    """Every block of the page runs, and the scripts that it starts."""
    folder = fresh("page").absolute()
    folder.mkdir()
    (folder / "python").symlink_to(ROOT / "python")
    follow(ROOT / "docs/how-to/own_finite_elements.md", Reader(folder, whole=False))
    check((folder / "footing.png").stat().st_size > 20000, "the footing was not drawn")


def main():
    begin = time.monotonic()
    check_elastic_biaxial()
    check_elastic_footing()
    check_grains_biaxial()
    follow_page()
    print(f"{time.monotonic() - begin:.1f} s")


if __name__ == "__main__":
    main()
