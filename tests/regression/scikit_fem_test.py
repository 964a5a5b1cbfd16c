"""The examples with scikit-fem: closed forms by linear elasticity in place of the grains, steps that are cut, and with
grains the biaxial test of the program."""

import sys
import time

import numpy as np
from elastic_batch import ElasticBatch, plane_strain_stiffness
from program import ROOT, check

sys.path.insert(0, str(ROOT / "python/examples"))

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
    check(ground.evaluations <= 15, f"elastic increments take {ground.evaluations / 5} evaluations")


def check_elastic_footing():
    """A footing on the whole surface: sigma_yy = -p0 + D22 ln(h/h0). Where points fail, steps are cut."""
    from scikit_fem_footing import HALF_WIDTH, footing, grid  # noqa: PLC0415

    def column(fails):
        mesh, boundaries = grid(width=HALF_WIDTH, depth=1.0, cells=(2, 0, 2))

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


def main():
    begin = time.monotonic()
    check_elastic_biaxial()
    check_elastic_footing()
    print(f"{time.monotonic() - begin:.1f} s")


if __name__ == "__main__":
    main()
