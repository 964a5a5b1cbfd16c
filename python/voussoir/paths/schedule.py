"""What a dataset is made of: strain paths, the stresses that some of them hold, and the name of the family of each."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

Array = np.ndarray


@dataclass(frozen=True)
class Paths:
    """Strain paths, one a row.

    `gradient` (n, increments, 2, 2) is F - I of each increment, counted from the state that was committed before it.
    `held` (n, 3) tells which stresses (xx, yy, xy) keep the value that they had at the beginning of the path; the
    strain of a held component is found while the path runs, and what `gradient` says of it is the first guess.
    `family` (n,) names the kind of each path.

    ValueError: a shape is wrong, a value is not finite, an increment turns the plane inside out, or a path that holds a
    stress has increments with a rotation."""

    gradient: Array
    held: Array = field(default_factory=lambda: np.zeros(0, bool))
    family: Array = field(default_factory=lambda: np.zeros(0, "U1"))

    def __post_init__(self) -> None:
        gradient = np.ascontiguousarray(self.gradient, float)
        if gradient.ndim != 4 or gradient.shape[2:] != (2, 2) or 0 in gradient.shape:
            raise ValueError(f"paths need the shape (n, increments, 2, 2), and this array has {gradient.shape}")
        n = len(gradient)
        held = np.asarray(self.held, bool) if np.size(self.held) else np.zeros((n, 3), bool)
        family = np.asarray(self.family, str) if np.size(self.family) else np.full(n, "prescribed")
        held, family = np.broadcast_to(held, (n, 3)).copy(), np.broadcast_to(family, (n,)).copy()
        if not np.isfinite(gradient).all():
            raise ValueError(
                f"path {np.argmin(np.isfinite(gradient).all((1, 2, 3)))} has increments that are not finite"
            )
        if not (np.linalg.det(np.eye(2) + gradient) > 0).all():
            raise ValueError("an increment has det F <= 0")
        turned = np.abs(gradient[..., 0, 1] - gradient[..., 1, 0]).max(axis=1) > 1e-12
        if (turned & held.any(axis=1)).any():
            raise ValueError("paths that hold a stress need symmetric increments, without rotation")
        for name, value in (("gradient", gradient), ("held", held), ("family", family)):
            object.__setattr__(self, name, value)

    def __len__(self) -> int:
        return len(self.gradient)

    @property
    def increments(self) -> int:
        return int(self.gradient.shape[1])

    def __getitem__(self, rows: slice | Array) -> "Paths":
        """Some of the paths, by a slice or an array of indices."""
        return Paths(self.gradient[rows], self.held[rows], self.family[rows])

    def __repr__(self) -> str:
        kinds = ", ".join(f"{name} {count}" for name, count in self.families())
        return f"Paths({len(self)} paths of {self.increments} increments: {kinds})"

    def families(self) -> Iterator[tuple[str, int]]:
        """The names of the families with the number of paths of each, in the order of their first paths."""
        names, first, counts = np.unique(self.family, return_index=True, return_counts=True)
        return ((str(names[k]), int(counts[k])) for k in np.argsort(first))


def as_paths(paths: "Paths | Array | Mapping[str, Paths | Array]") -> Paths:
    """Paths from an array of gradients, or from a dictionary {family: paths}, whose members are joined in order.

    ValueError: the members have different numbers of increments."""
    if isinstance(paths, Paths):
        return paths
    if not isinstance(paths, Mapping):
        return Paths(np.asarray(paths))
    members = {name: as_paths(member) for name, member in paths.items()}
    lengths = {name: member.increments for name, member in members.items()}
    if len(set(lengths.values())) != 1:
        raise ValueError(f"paths of one dataset need the same number of increments, and these have {lengths}")
    return Paths(
        np.concatenate([member.gradient for member in members.values()]),
        np.concatenate([member.held for member in members.values()]),
        np.concatenate([np.full(len(member), name) for name, member in members.items()]),
    )
