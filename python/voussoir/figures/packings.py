"""Packing files (docs/reference/files.md, "Packings"): grains, contacts, and the normal forces that the linear law
makes of the overlaps (kernels/contact/linear_law.hpp)."""

from collections.abc import Sequence
from functools import cached_property
from pathlib import Path

import numpy as np

from ..errors import Missing, Unreadable
from ..increments import Snapshot
from ..packing_files import PackingFile
from .soils import Curve, State, curve_of, name_of
from .units import quantity


def branches(positions: np.ndarray, cell: np.ndarray, i: np.ndarray, j: np.ndarray) -> np.ndarray:
    """Vectors from grain i to the nearest image of grain j (contact, 2) [m]. A cell holds two of the largest diameters,
    so that the image which touches is the nearest one."""
    apart = np.linalg.solve(cell, (positions[j] - positions[i]).T)
    return (cell @ (apart - np.round(apart))).T


class Packing(PackingFile):
    """One packing with its soil by the study's names and the normal forces of its overlaps."""

    @property
    def soil(self) -> str:
        """One of the study's names, "own sand" or "own gravel", as for a run."""
        state = State(
            self.void_ratio,
            self.numbers.get("consolidation_friction"),
            not self.numbers.get("consolidation_rolling", 0),
        )
        return name_of(self._curve(), state)

    def _curve(self) -> Curve:
        """The grading that the packing was drawn from; of packings that do not tell it, the ends of its own."""
        told = {
            name.removeprefix("soil."): text.strip("[]").split(", ") if text.startswith("[") else text
            for name, text in self.labels.items()
        }
        if "sizes" in told or "size_maximum" in told:
            return curve_of(told)
        return [(2 * self.radius.min(), 0.0), (2 * self.radius.max(), 1.0)]

    @cached_property
    def moduli(self) -> np.ndarray:
        """Contact modulus of each grain [Pa], by its class where the soil has classes."""
        sizes: list[float] = []
        moduli: list[float] = []
        while f"soil.class[{len(sizes)}].size_to" in self.labels:
            table = f"soil.class[{len(sizes)}]"
            moduli.append(self._label(f"{table}.modulus"))
            sizes.append(self._label(f"{table}.size_to"))
        if not sizes:
            return np.full(len(self.radius), self._label("soil.modulus"))
        # A grain belongs to the first class whose upper size it does not exceed, as in host/packing/packed_rve.cpp.
        return np.array(moduli)[np.minimum(np.searchsorted(sizes, 2 * self.radius), len(sizes) - 1)]

    def _label(self, name: str) -> float:
        if name not in self.labels:
            raise Missing(f"{self.path} does not tell its soil: it has no label {name}")
        try:
            return quantity(self.labels[name])
        except ValueError as error:
            raise Missing(f"{self.path}: label {name}: {error}") from None

    def normal_forces(self) -> tuple[np.ndarray, np.ndarray]:
        """Branch (contact, 2) [m] and normal force (contact) [N] of each contact: f_n = k_n times the overlap, where
        k_n is the harmonic mean of both grains' E r."""
        branch = branches(np.column_stack([self.x, self.y]), self.cell, self.contact_i, self.contact_j)
        overlap = self.radius[self.contact_i] + self.radius[self.contact_j] - np.linalg.norm(branch, axis=1)
        spring = self.moduli * self.radius
        first, second = spring[self.contact_i], spring[self.contact_j]
        return branch, 2 * first * second / (first + second) * np.maximum(overlap, 0)

    def pressure(self) -> float:
        """Mean stress of the normal forces [Pa]: half the trace of eq. (3), to which tangential forces add nothing."""
        branch, force = self.normal_forces()
        area = np.linalg.det(self.cell)
        return float(np.sum(force * np.linalg.norm(branch, axis=1)) / (2 * area * self.thickness))

    def snapshot(self) -> Snapshot:
        """The packing as a snapshot of an RVE, with its normal forces alone."""
        branch, force = self.normal_forces()
        touching = force > 0
        unit = branch / np.linalg.norm(branch, axis=1, keepdims=True)
        return {
            "cell": self.cell,
            "x": self.x,
            "y": self.y,
            "radius": self.radius,
            "contact_i": self.contact_i[touching],
            "contact_j": self.contact_j[touching],
            "branch": branch[touching],
            "force": (-force[:, None] * unit)[touching],
        }


class Packings:
    """Several packings, in groups of those that differ by their seed alone."""

    def __init__(self, files: Sequence[Path]) -> None:
        self.left_out: list[Missing] = []
        self.all: list[Packing] = []
        for path in files:
            try:
                self.all.append(Packing(path))
            except Missing as reason:
                self.left_out.append(reason)
        if not self.all:
            raise self.left_out[0] if self.left_out else Unreadable("there is no packing to draw")

    def groups(self) -> list[list[Packing]]:
        """Packings of one recipe together, by their seeds; a packing without a recipe is a group of its own."""
        found: dict[str, list[Packing]] = {}
        for packing in self.all:
            found.setdefault(packing.recipe or str(packing.path), []).append(packing)
        return [sorted(group, key=lambda packing: packing.seed) for group in found.values()]
