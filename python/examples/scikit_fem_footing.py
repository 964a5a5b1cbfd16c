"""A smooth, rigid strip footing on weightless sand under a surcharge: scikit-fem's elements, Voussoir's grains.

Half of the ground is computed, since it is symmetric about x = 0. It begins under the isotropic pressure at which the
packings were made. `Ground` of scikit_fem_biaxial.py finds the equilibrium of an increment; here steps are cut where
there is none, and half of the points answer as mirror images. Lengths are in m, stresses in Pa.

    python scikit_fem_footing.py [FIGURE.png [STEPS of 1.5 mm]]
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
import voussoir
from matplotlib.collections import PolyCollection
from scikit_fem_biaxial import Ground
from skfem import MeshQuad

HALF_WIDTH = 0.5  # of the footing


def graded(start, end, cells, ratio):
    """Places of a row of cells, each `ratio` times as wide as the one before."""
    return start + (end - start) * np.append(0, np.cumsum(ratio ** np.arange(cells))) / np.sum(
        ratio ** np.arange(cells)
    )


def grid(width=4.0, depth=2.5, cells=(4, 8, 8)):
    """Cells under the footing, beside it and in a column; the smallest ones are at the footing's edge."""
    x = np.append(np.linspace(0, HALF_WIDTH, cells[0] + 1), graded(HALF_WIDTH, width, cells[1], 1.3)[1:])
    y = -graded(0, depth, cells[2], 1.25)[::-1]
    boundaries = {
        "base": lambda p: np.isclose(p[1], -depth),
        "sides": lambda p: np.isclose(p[0], 0) | np.isclose(p[0], width),
        "surface": lambda p: np.isclose(p[1], 0),
        "footing": lambda p: np.isclose(p[1], 0) & (p[0] < HALF_WIDTH),
    }
    return MeshQuad.init_tensor(x, y), boundaries


def in_turn(basis):
    """Two of the four points of each element answer as mirror images, so that a packing prefers no side."""
    x, y = basis.global_coordinates().value
    return ((x > x.mean(1, keepdims=True)) != (y > y.mean(1, keepdims=True))).ravel()


def footing(make_batch, settlement=0.03, steps=20, p0=100e3, smallest=1 / 64, mesh=None, **criterion):
    """Yields settlement [m], pressure under the footing [Pa], and the ground, after each increment."""
    mesh, boundaries = mesh or grid()
    ground = Ground(mesh, boundaries, make_batch)
    dofs = ground.basis.get_dofs
    base, sides, under = dofs("base").all(), dofs("sides").all("u^1"), dofs("footing").all("u^2")
    fixed = np.unique(np.concatenate([base, sides, under]))
    planned = np.where(np.isin(fixed, under), -settlement / steps, 0.0)
    done, share, last = 0.0, 1.0, 1.0  # steps done, share of a step that is tried, share that was committed last
    while done < steps - 1e-9:
        share = min(share, steps - done)
        load, above = ground.pressure("surface", p0), ground.pressure("footing", p0)[under].sum()
        try:
            ground.increment(load, fixed, share * planned, share / last, **criterion)
        except voussoir.NoEquilibrium as reason:  # ground and grains are as they were: try half of it
            share /= 2
            if share < smallest:
                raise
            print(f"step {done + 1:.3f} is cut to {share:g}: {reason}")
            continue
        done, last, share = done + share, share, min(1.0, 2 * share)
        yield done * settlement / steps, -(above + ground.reaction[under].sum()) / HALF_WIDTH, ground


def draw(ground, curve, file):
    """Deviatoric strain since the start, on the deformed mesh, and the pressure under the footing."""
    gradient = ground.start.interpolate(ground.total).grad
    strain = np.hypot(gradient[0, 0] - gradient[1, 1], gradient[0, 1] + gradient[1, 0]).mean(1)
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.6), width_ratios=(2, 1), layout="constrained")
    corners = ground.mesh.doflocs[:, ground.mesh.t].T
    drawn = left.add_collection(PolyCollection(corners, array=100 * strain, cmap="viridis", edgecolor="w", lw=0.3))
    left.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    left.autoscale()
    figure.colorbar(drawn, label="deviatoric strain [%]")
    right.plot(1e3 * curve[:, 0], curve[:, 1] / 1e3, ".-")
    right.set(xlabel="settlement [mm]", ylabel="pressure under the footing [kPa]", xlim=0)
    figure.savefig(file, dpi=150)


if __name__ == "__main__":
    packings = voussoir.make_packings(seeds=4, grains=200, pressure=100e3)
    file, steps = sys.argv[1] if len(sys.argv) > 1 else "footing.png", int(sys.argv[2]) if len(sys.argv) > 2 else 20
    curve = [(0.0, 100e3)]

    def make_batch(basis):
        return voussoir.RveBatch(packings, basis.dx.size, mirrored=in_turn(basis))

    try:
        for settlement, pressure, ground in footing(make_batch, 1.5e-3 * steps, steps):
            curve.append((settlement, pressure))
            print(f"{1e3 * settlement:5.1f} mm: {pressure / 1e3:6.1f} kPa after {ground.evaluations} evaluations")
    except voussoir.NoEquilibrium as reason:
        print(f"no further: {reason}")
    draw(ground, np.array(curve), file)
