"""Stand-ins for grains: points of a linear elastic law behind the interface of voussoir.RveBatch, whose answers are
known in closed form, and which fail where a test wants it."""

import pickle
from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np
from voussoir.paths.tensors import pressure_of, strain_of_gradient

BULK, SHEAR = 100e6, 60e6  # Pa
REPORT = np.dtype([("status", "i4"), ("steps", "i4"), ("contacts", "i4"), ("unbalanced", "f8"), ("mean_overlap", "f8")])


def stiffness(bulk, shear):
    return np.array([[bulk + shear, bulk - shear, 0], [bulk - shear, bulk + shear, 0], [0, 0, shear]])


STIFFNESS = stiffness(BULK, SHEAR)
NO_ANSWER = 5


@dataclass
class Packing:
    """What a dataset notes of a packing."""

    seed: int = 1
    pressure: float = 100e3
    void_ratio: float = 0.2
    coordination: float = 4.0
    thickness: float = 0.1
    soil: dict = field(default_factory=dict)
    radius: np.ndarray = field(default_factory=lambda: np.ones(10))

    def __post_init__(self):
        self.position, self.rotation = np.full((10, 2), float(self.seed)), np.zeros(10)
        self.cell, self.contacts, self.history = np.eye(2), np.zeros((0, 2), int), np.zeros((0, 2))


class Batch:
    """Points whose stress is stiffness times the logarithmic strain of each increment, summed. The shear modulus of the
    tangent that they tell is `told` times the true one. A point whose strain in an increment exceeds `limit` fails."""

    def __init__(self, packings, packing_of, told=1.0, limit=0.05):
        self.told, self.limit, self.evaluations, self.closed = told, limit, 0, False
        self.seed = np.array([packings[k].seed for k in packing_of], float)
        pressure = np.array([packings[k].pressure for k in packing_of], float)
        self.stress = -pressure[:, None] * [1.0, 1.0, 0.0]
        self.trial = self.stress

    def evaluate(self, gradient, tangent=True):
        self.evaluations += 1
        strain = strain_of_gradient(np.asarray(gradient))
        self.trial = self.stress + (1 + 0.01 * self.seed)[:, None] * (strain @ STIFFNESS)
        failed = np.abs(strain).max(axis=1) > self.limit
        self.trial[failed] = np.nan
        return self._answer(self.trial, np.where(failed, NO_ANSWER, 0), tangent)

    def commit(self):
        if not np.isfinite(self.trial).all():
            raise RuntimeError("a point has no answer")
        self.stress = self.trial

    def committed(self, tangent=True):
        return self._answer(self.stress, np.zeros(len(self.stress), int), tangent)

    def state(self):
        return pickle.dumps(self.stress)

    def set_state(self, state):
        self.stress = pickle.loads(state)

    @property
    def void_ratio(self):
        return 0.2 - pressure_of(self.stress) / BULK

    def close(self):
        self.closed = True

    def _answer(self, stress, status, tangent):
        report = np.zeros(len(stress), REPORT)
        report["status"], report["steps"] = status, 7
        tensor = stress[:, [[0, 2], [2, 1]]]
        matrix = (
            np.where(np.isnan(stress[:, :1, None]), np.nan, stiffness(BULK, self.told * SHEAR)) if tangent else None
        )
        return SimpleNamespace(
            stress=tensor, tangent=matrix, report=report, usable=bool((status == 0).all()), message=""
        )
