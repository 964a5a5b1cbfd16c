"""Stresses that keep their values: the strains of held components are found by an iteration over the tangent."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from .tensors import gradient_of_strain, pressure_of, strain_of_gradient, voigt_of

Array = np.ndarray


@dataclass(frozen=True)
class StressControl:
    """When the iteration ends: each held stress is within `tolerance` of its value, as a share of the path's mean
    stress or of `floor` [Pa] where that is larger, or `iterations` evaluations are done. A path that did not get there
    is committed with its best iterate; the file says by how much each increment misses (`control_error`), and the next
    increment aims at the same value again. No iterate changes a held strain by more than `largest_step`."""

    tolerance: float = 0.005
    iterations: int = 8
    largest_step: float = 2e-3
    floor: float = 1e3


@dataclass
class State:
    """Committed stresses (n, 3) [Pa] of paths, and what is known of d stress/d strain (n, 3, 3) [Pa]."""

    stress: Array
    tangent: Array

    @classmethod
    def of(cls, answer: Any) -> "State":
        return cls(voigt_of(answer.stress), np.array(answer.tangent, float))


class Search:
    """Strains of one increment of many paths, whose held stresses come to their targets by Broyden's method.

    The first guess of d stress/d strain is the tangent of the first state. After each evaluation the matrix of each
    path is changed by the least amount with which it explains the last change of stress (Broyden 1965, "A class of
    methods for solving nonlinear simultaneous equations", Mathematics of Computation 19), because an elastic tangent is
    several times too stiff where grains slide."""

    def __init__(self, start: State, gradient: Array, held: Array, target: Array, control: StressControl) -> None:
        self.held, self.target, self.control = held, target, control
        self.matrix = np.where(np.isfinite(start.tangent), start.tangent, 0.0)
        self.last_strain = np.zeros((len(held), 3))
        self.last_stress = np.where(np.isfinite(start.stress), start.stress, 0.0)
        self.error = np.full(len(held), np.inf)  # of the best iterate [Pa]
        self.failed = np.zeros(len(held), bool)
        given = np.where(held, 0.0, strain_of_gradient(gradient))
        self.strain = given + self._step(self.last_stress + np.einsum("nij,nj->ni", self.matrix, given))
        self.best = self.strain.copy()
        scale = np.maximum(pressure_of(self.last_stress), pressure_of(target))
        self.allowed = control.tolerance * np.maximum(scale, control.floor)

    def gradient(self) -> Array:
        """The strains to evaluate next, as F - I."""
        return gradient_of_strain(self.strain)

    def learn(self, stress: Array) -> None:
        """Takes the stresses (n, 3) that the present strains gave. NaN: the grains failed, and the path keeps its best
        iterate."""
        self.failed |= ~np.isfinite(stress).all(axis=1)
        stress = np.where(self.failed[:, None], self.last_stress, stress)
        error = np.where(self.held, np.abs(stress - self.target), 0.0).max(axis=1)
        better = (error < self.error) & ~self.failed
        self.error[better], self.best[better] = error[better], self.strain[better]
        change = self.strain - self.last_strain
        square = (change**2).sum(axis=1)
        missing = stress - self.last_stress - np.einsum("nij,nj->ni", self.matrix, change)
        use = ~self.failed & (square > 0)
        update = np.einsum("ni,nj->nij", missing, change) / np.where(use, square, 1.0)[:, None, None]
        self.matrix[use] += update[use]
        self.last_strain[use], self.last_stress[use] = self.strain[use], stress[use]

    def is_done(self) -> bool:
        return not self._open().any()

    def improve(self) -> None:
        """Next strains of the paths that are not near enough; the others keep their best ones."""
        open_ = self._open()[:, None]
        self.strain = np.where(open_, self.last_strain + self._step(self.last_stress), self.best)

    def settle(self) -> bool:
        """Goes back to the best strains. Returns whether the last evaluation had others."""
        differs = (self.strain != self.best).any(axis=1) & np.isfinite(self.error)
        self.strain[differs] = self.best[differs]
        return bool(differs.any())

    def _open(self) -> Array:
        return (self.error > self.allowed) & ~self.failed

    def _step(self, foretold: Array) -> Array:
        """The change of the held strains with which the matrices foretell the targets, from a stress that is reached or
        foretold; zero where a matrix cannot be solved."""
        size = np.maximum(np.abs(self.matrix).max(axis=(1, 2)), 1e-300)
        both = self.held[:, :, None] & self.held[:, None, :]
        system = np.where(both, self.matrix / size[:, None, None], 0.0) + np.eye(3) * ~self.held[:, None, :]
        rest = np.where(self.held, self.target - foretold, 0.0) / size[:, None]
        solvable = (np.abs(np.linalg.det(system)) > 1e-6) & (size > 1.0)
        system[~solvable] = np.eye(3)
        step = np.where(solvable[:, None], np.linalg.solve(system, rest[..., None])[..., 0], 0.0)
        largest = np.maximum(np.abs(step).max(axis=1), 1e-300)
        return step * np.minimum(1.0, self.control.largest_step / largest)[:, None]


@dataclass
class Outcome:
    """One increment that was evaluated."""

    answer: Any  # of the last evaluation
    gradient: Array  # (n, 2, 2) that it had
    error: Array  # (n,) by how much held stresses miss their targets [Pa]
    state: State  # after it, from which the next increment starts


def evaluate(
    batch: Any, start: State, gradient: Array, held: Array, target: Array, tangent: bool, control: StressControl
) -> Outcome:
    """Evaluates one increment of a batch whose committed state is `start`, and brings the stresses `held` (n, 3) to
    their values `target` (n, 3) [Pa]; `gradient` (n, 2, 2) has the other strains.

    The next increment begins with the matrices that this one has learned, which takes a quarter fewer evaluations of a
    test that is compressed to failure than to begin with the elastic tangents (docs/measurements/datasets.md). Paths
    that did not come to their targets begin with the tangents again."""
    if not held.any():
        answer = batch.evaluate(gradient, tangent=tangent)
        return Outcome(answer, gradient, np.zeros(len(held)), State(voigt_of(answer.stress), start.tangent))
    search = Search(start, gradient, held, target, control)
    for iteration in range(control.iterations):
        if iteration > 0:
            search.improve()
        answer = batch.evaluate(search.gradient(), tangent=True)
        search.learn(voigt_of(answer.stress))
        if search.is_done():
            break
    if search.settle():
        answer = batch.evaluate(search.gradient(), tangent=True)
    error = np.where(np.isfinite(search.error), search.error, 0.0)
    matrix = np.where((search.error > search.allowed)[:, None, None], answer.tangent, search.matrix)
    return Outcome(answer, search.gradient(), error, State(voigt_of(answer.stress), matrix))
