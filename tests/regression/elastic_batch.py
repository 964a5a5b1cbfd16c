"""Linear elasticity behind the interface of voussoir.RveBatch: the tests of examples and adapters compare with closed
forms by it, and they need no compiled module then.

The law is that of `fem/linear_elastic.cpp`: the committed stress turned by R plus D ln V, with F = V R since the last
commit. Stresses are in Pa with tension positive."""

from types import SimpleNamespace

import numpy as np


def plane_strain_stiffness(young, poisson):
    """D in Voigt order (xx, yy, gamma_xy), (3, 3) [Pa]."""
    scale = young / ((1 + poisson) * (1 - 2 * poisson))
    rows = [[1 - poisson, poisson, 0], [poisson, 1 - poisson, 0], [0, 0, 0.5 - poisson]]
    return scale * np.array(rows)


class ElasticBatch:
    """`n` points under the pressure `pressure` [Pa]."""

    def __init__(self, n, pressure=100e3, young=50e6, poisson=0.3):
        self.stiffness = plane_strain_stiffness(young, poisson)
        self.stress = np.tile(-pressure * np.eye(2), (n, 1, 1))
        self.trial = None
        self.begun = self.commits = self.closed = 0
        self.fails = lambda f_minus_i: np.zeros(len(f_minus_i), bool)  # which points find no answer

    def __len__(self):
        return len(self.stress)

    def answer(self, stress, tangent, failed=()):
        points = ", ".join(map(str, failed))
        return SimpleNamespace(
            stress=stress.copy(),
            tangent=np.tile(self.stiffness, (len(self), 1, 1)) if tangent else None,
            report=np.zeros(len(self), [("status", "i4"), ("steps", "i4")]),
            usable=len(failed) == 0,
            message=f"point {points}: the grains found no answer" if len(failed) else "",
        )

    def committed(self, tangent=True):
        return self.answer(self.stress, tangent)

    def begin_increment(self):
        self.begun += 1

    def evaluate(self, f_minus_i, tangent=True):
        f = np.eye(2) + np.asarray(f_minus_i)
        squares, axes = np.linalg.eigh(f @ f.transpose(0, 2, 1))
        log_v = np.einsum("nik,nk,njk->nij", axes, 0.5 * np.log(squares), axes)
        rotation = np.einsum("nik,nk,njk->nij", axes, squares**-0.5, axes) @ f
        e = np.stack([log_v[:, 0, 0], log_v[:, 1, 1], 2 * log_v[:, 0, 1]], 1) @ self.stiffness
        self.trial = rotation @ self.stress @ rotation.transpose(0, 2, 1)
        self.trial += np.stack([e[:, [0, 2]], e[:, [2, 1]]], 1)
        failed = np.flatnonzero(self.fails(f_minus_i))
        self.trial[failed] = np.nan
        answer = self.answer(self.trial, tangent, failed)
        if len(failed):
            self.trial = None
        return answer

    def commit(self):
        if self.trial is None:
            raise RuntimeError("there is no evaluation to commit")
        self.stress, self.trial = self.trial, None
        self.commits += 1

    def state(self):
        return self.stress.tobytes()

    def set_state(self, state):
        self.stress = np.frombuffer(state).reshape(self.stress.shape).copy()

    def fields(self):
        return {"mean_stress": 0.5 * np.trace(self.stress, axis1=1, axis2=2)}

    def close(self):
        self.closed += 1
