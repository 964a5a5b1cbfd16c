"""The rows of a dataset: which path runs on which packing, and to which part of the split both belong."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

Array = np.ndarray
PARTS = ("train", "validation", "test")
Split = Sequence[float] | Mapping[str, Sequence[int]]


@dataclass(frozen=True)
class Rows:
    """One entry a row; `packing_part` and `path_part` have one entry a packing and a path: an index of PARTS."""

    path: Array
    packing: Array
    mirrored: Array
    packing_part: Array
    path_part: Array

    def __len__(self) -> int:
        return len(self.path)


def deal(paths: int, packings: int, packing_of: str | ArrayLike) -> tuple[Array, Array]:
    """Path and packing of each row. "turn": path i runs on packing i modulo the number of packings; "all": every path
    runs on every packing, path by path; an array names the packing of each path.

    ValueError: the word is not known, or the array has another length or names a packing that there is not."""
    if isinstance(packing_of, str):
        if packing_of == "turn":
            return np.arange(paths), np.arange(paths) % packings
        if packing_of == "all":
            return np.repeat(np.arange(paths), packings), np.tile(np.arange(packings), paths)
        raise ValueError(f"packing_of is 'turn', 'all' or an array, not {packing_of!r}")
    packing = np.asarray(packing_of)
    if packing.shape != (paths,) or not np.issubdtype(packing.dtype, np.integer):
        raise ValueError(f"packing_of needs one integer for each of {paths} paths")
    if packing.min() < 0 or packing.max() >= packings:
        raise ValueError(f"packing_of names packings beyond the {packings} that there are")
    return np.arange(paths), packing


def parts(count: int, split: Split, seed: int) -> Array:
    """The part (train 0, validation 1, test 2) of each of `count` things. Shares (train, validation, test) are drawn;
    the test gets at least one of two things, the validation one of three, where their shares are not zero. A dictionary
    {"validation": indices, "test": indices} names them; the others train.

    ValueError: shares or names make no sense."""
    part = np.zeros(count, np.int8)
    if isinstance(split, Mapping):
        if not set(split) <= set(PARTS):
            raise ValueError(f"a split has the parts {', '.join(PARTS)}, not {', '.join(split)}")
        for name, members in split.items():
            part[np.asarray(members, int)] = PARTS.index(name)
        return part
    shares = np.asarray(split, float)
    if shares.shape != (3,) or (shares < 0).any() or not np.isclose(shares.sum(), 1):
        raise ValueError("a split has three shares (train, validation, test) whose sum is 1")
    test = _members(count, shares[2], 2)
    validation = _members(count, shares[1], 3)
    order = np.random.default_rng(seed).permutation(count)
    part[order[:test]] = 2
    part[order[test : test + validation]] = 1
    return part


def make_rows(
    paths: int, packings: int, packing_of: str | ArrayLike, mirrored: Any, splits: tuple[Split, Split]
) -> Rows:
    """The rows of a dataset; `splits` are those of the packings and of the paths."""
    path, packing = deal(paths, packings, packing_of)
    try:
        mirror = np.broadcast_to(np.asarray(mirrored, bool), path.shape).copy()
    except ValueError:
        raise ValueError(f"mirrored is a bool, or one for each of {len(path)} rows") from None
    return Rows(path, packing, mirror, parts(packings, splits[0], 0), parts(paths, splits[1], 1))


def _members(count: int, share: float, least: int) -> int:
    return max(1, round(share * count)) if share > 0 and count >= least else 0
