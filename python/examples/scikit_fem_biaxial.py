"""Drained biaxial test with scikit-fem's elements and Voussoir's grains as their material.

Eight-node quadrilaterals with 2 x 2 points, plane strain, updated Lagrangian: gradients, volumes and loads are those of
the committed shape, stresses are Cauchy's. Units are Pa, m and N/m, and tension is positive.
"""

import numpy as np
import voussoir
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementQuadS2, ElementVector, FacetBasis, LinearForm, MeshQuad, MeshQuad2

ELEMENT = ElementVector(ElementQuadS2())


@BilinearForm
def stiffness(u, v, w):  # B^T D B, without geometric part: stresses are small beside the stiffness of grains
    strain, virtual = [(g[0, 0], g[1, 1], g[0, 1] + g[1, 0]) for g in (u.grad, v.grad)]  # xx, yy, gamma_xy
    return sum(w.tangent[i, j] * virtual[i] * strain[j] for i in range(3) for j in range(3))


@LinearForm
def internal_force(v, w):
    return np.einsum("ij...,ij...", w.stress, v.grad)


@LinearForm
def pressure_force(v, w):
    return -w.pressure * (w.n[0] * v[0] + w.n[1] * v[1])


def accelerated(history):
    """The next iterate, from iterates and their corrections (Anderson 1965): grains are softer than their tangents."""
    x, f = (np.array(column) for column in zip(*history[-6:]))
    dx, df = np.diff(x, axis=0), np.diff(f, axis=0)
    return x[-1] + f[-1] - np.linalg.lstsq(df.T, f[-1], rcond=1e-6)[0] @ (dx + df)


class Ground:
    """A mesh whose Gauss points are the points of one batch, which `make_batch(basis)` makes."""

    def __init__(self, mesh, boundaries, make_batch):
        self.mesh = MeshQuad2.from_mesh(mesh).with_boundaries(boundaries)
        self.basis = Basis(self.mesh, ELEMENT, intorder=3)
        self.move(self.basis.zeros())
        self.start, self.batch = self.basis, make_batch(self.basis)
        self.answer = self.batch.committed()
        self.tangent = self.first_tangent = self.answer.tangent
        self.last, self.total, self.evaluations = self.basis.zeros(), self.basis.zeros(), 0

    def move(self, du):
        x, nodes = self.mesh.doflocs.copy(), self.mesh.dofs.element_dofs
        moved = np.hstack([self.basis.nodal_dofs, self.basis.facet_dofs])  # as doflocs: corners, midsides
        x[:, : moved.shape[1]] += du[moved]
        x[:, nodes[8]] = 0.5 * x[:, nodes[4:8]].sum(1) - 0.25 * x[:, nodes[:4]].sum(1)  # as the eight shape functions
        self.mesh = MeshQuad2(x, self.mesh.t, _boundaries=self.mesh.boundaries)
        self.basis = Basis(self.mesh, ELEMENT, intorder=3)

    def field(self, values):
        """Values of the points, (n, ...), as scikit-fem takes them: (..., elements, 4)."""
        return np.moveaxis(values, 0, -1).reshape(*values.shape[1:], *self.basis.dx.shape)

    def internal(self):
        return internal_force.assemble(self.basis, stress=self.field(self.answer.stress))

    def pressure(self, boundary, value):
        return pressure_force.assemble(FacetBasis(self.mesh, ELEMENT, facets=boundary, intorder=3), pressure=value)

    def matrix(self):  # a share of the first tangents keeps it regular where contacts open
        tangent = self.field(self.tangent + 0.02 * self.first_tangent)
        return stiffness.assemble(self.basis, tangent=tangent).tocsc()

    def increment(self, load, fixed, motion, share=1.0, tolerance=1e-3, iterations=40):
        """Brings the load and the motion of fixed degrees of freedom to equilibrium, or raises and changes nothing."""
        free, history, norm = np.setdiff1d(np.arange(self.basis.N), fixed), [], np.linalg.norm
        self.answer = self.batch.committed()
        self.batch.begin_increment()
        du, k = share * self.last, self.matrix()  # first guess: this share of the last increment
        right = -k[:, fixed] @ (motion - du[fixed]) + (0 if du.any() else load - self.internal())
        du[fixed] = motion
        du[free] += splu(k[free][:, free]).solve(right[free])
        for i in range(iterations):
            gradient = self.basis.interpolate(du).grad.reshape(2, 2, -1)  # du_i/dx_j is F - I since the last commit
            self.answer = self.batch.evaluate(np.moveaxis(gradient, -1, 0), tangent=i == 0)
            self.evaluations += 1
            if not self.answer.usable:  # some point of grains found no answer
                raise voussoir.NoEquilibrium(self.answer.message)
            if i == 0:  # tangents are dear: once an increment, and acceleration does the rest
                self.tangent = self.answer.tangent
                solve = splu(self.matrix()[free][:, free]).solve
            residual = load - self.internal()
            correction = solve(residual[free])
            left = norm(residual[free]) / max(norm(load), norm(residual[fixed])), norm(correction) / norm(du)
            if left[0] <= tolerance and left[1] <= 1e-2:
                self.batch.commit()
                self.last, self.total, self.reaction = du, self.total + du, -residual
                return self.move(du)
            history.append((du[free], correction))
            du[free] = accelerated(history)
        raise voussoir.NoEquilibrium("residual and correction are still {:.1e} and {:.1e}".format(*left))


def biaxial(make_batch, increments=10, strain=1e-3, p0=100e3, width=0.05, height=0.1, cells=(2, 4), **criterion):
    """Yields the axial stress [Pa] after each increment, compression positive, and the ground."""
    mesh = MeshQuad.init_tensor(np.linspace(0, width, cells[0] + 1), np.linspace(0, height, cells[1] + 1))
    boundaries = {"base": lambda x: x[1] == 0, "top": lambda x: x[1] == height, "sides": lambda x: x[0] % width == 0}
    ground = Ground(mesh, boundaries, make_batch)
    base, top = (ground.basis.get_dofs(name).all("u^2") for name in ("base", "top"))
    corner, platen = ground.basis.nodal_dofs[0, np.argmin(mesh.p.sum(0))], ground.mesh.doflocs[1] == height
    fixed = np.concatenate([base, top, [corner]])
    for _ in range(increments):
        load, breadth = ground.pressure("sides", p0), np.ptp(ground.mesh.doflocs[0, platen])
        ground.increment(load, fixed, np.where(np.isin(fixed, top), -strain * height, 0.0), **criterion)
        yield -ground.reaction[top].sum() / breadth, ground


if __name__ == "__main__":
    packing = voussoir.make_packings(grains=300, pressure=100e3)
    for k, (stress, ground) in enumerate(biaxial(lambda basis: voussoir.RveBatch(packing, basis.dx.size))):
        print(f"strain {k + 1:2} permille: {stress / 1e3:6.2f} kPa after {ground.evaluations} evaluations")
