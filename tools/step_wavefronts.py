"""What one step of the GPU engine takes of a multiprocessor on a real packing: wavefronts of shared memory, and how
often a warp goes through the loop over a grain's pairs.

A wavefront is one cycle of shared memory: 32 banks of 4 bytes. An access of 8 or 16 bytes a thread is served to 16 or 8
threads at a time, and takes as many wavefronts as the most loaded bank has different words. The layout is that of
kernels/device/block_run.hpp, and lists are in the order in which kernels/device/block_lists.hpp makes them: thread k of
a warp has the warp's pair, or grain, number k."""

import csv
import json
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

WARP, BANKS, WORD = 32, 32, 4


@dataclass
class Lists:
    """Grains and listed pairs of a packing."""

    grains: int
    first: np.ndarray  # grain i < j of each pair, in the order of the list
    second: np.ndarray
    row: np.ndarray  # entries of grain i: row[i] .. row[i + 1]
    entries: np.ndarray  # pairs by grain

    @property
    def listed(self):
        """Pairs a grain."""
        return len(self.first) / self.grains


@dataclass
class StepCost:
    """Of a particle-step, or of a warp."""

    pair_wavefronts: float
    grain_wavefronts: float
    pair_warps: float  # warps at work on pairs, a grain
    grain_warps: float
    turns: float  # of the loop over a grain's pairs, by a warp: its longest row


def read_packing(file):
    """Radii, positions and cell [m] of a stored packing (.h5), or of NAME_particles.csv with NAME_meta.json."""
    if file.suffix == ".h5":
        with h5py.File(file) as h:
            return h["radius"][()], np.column_stack([h["x"][()], h["y"][()]]), h["cell"][()]
    with file.open() as f:
        grains = list(csv.DictReader(f))
    meta = json.loads(Path(str(file).replace("_particles.csv", "_meta.json")).read_text())
    radius, x, y = (np.array([float(grain[name]) for grain in grains]) for name in ("r_m", "x_m", "y_m"))
    return radius, np.column_stack([x, y]), np.array(meta["hSize"])[:2, :2]


def lists_of(radius, position, cell, skin):
    """@param skin over the mean diameter"""
    inverse = np.linalg.inv(cell)
    branch = position[None] - position[:, None]
    fraction = branch @ inverse.T
    distance = np.hypot(*np.moveaxis((fraction - np.rint(fraction)) @ cell.T, -1, 0))
    reach = radius[:, None] + radius[None]
    first, second = np.where(np.triu(distance < reach + skin * 2 * radius.mean(), 1))
    ends = np.concatenate([first, second])
    order = np.lexsort((np.tile(np.arange(len(first)), 2), ends))
    row = np.searchsorted(ends[order], np.arange(len(radius) + 1))
    return Lists(len(radius), first, second, row, order % len(first))


def served(items, size):
    """Wavefronts of one access by a warp, in which the threads take these items of `size` bytes."""
    widest = 16  # bytes a thread that one instruction moves
    part = min(size, widest)
    at_once = BANKS * WORD // max(part, WORD)
    total = 0
    for offset in range(0, size, part):
        for k in range(0, len(items), at_once):
            byte = np.unique(items[k : k + at_once]) * size + offset
            words = np.unique(np.concatenate([byte // WORD + w for w in range(max(part // WORD, 1))]))
            total += np.bincount(words % BANKS).max()
    return total


def warps(n):
    return [np.arange(k, min(k + WARP, n)) for k in range(0, n, WARP)]


def count_pairs(lists, real):
    """Wavefronts of all pairs, with numbers of `real` bytes."""
    total = 0
    for p in warps(len(lists.first)):
        total += served(p, 4) + served(p, real)  # key, gap
        for grain in (lists.first, lists.second):
            total += served(grain[p], 4 * real) + served(grain[p], 2 * real)  # u, w; spin, radius
        total += served(p, 4 * real)  # action
    return total


def count_grains(lists, real):
    """Wavefronts of all grains, and turns of all warps through the loop over a grain's pairs."""
    total, turns = 0, 0
    for i in warps(lists.grains):
        begin, end = lists.row[i], lists.row[i + 1]
        longest = int((end - begin).max())
        for k in range(longest):
            q = begin[begin + k < end] + k
            total += served(q, 2) + served(lists.entries[q], 4 * real)
        turns += longest
        total += 2 * served(i, 2)  # row
        # u and w; spin and radius, mobility; rotation
        total += 2 * served(i, 4 * real) + 3 * served(i, 2 * real) + 2 * served(i, real)
    return total, turns


def step_cost(lists, real):
    n = lists.grains
    pairs = count_pairs(lists, real)
    grains, turns = count_grains(lists, real)
    pair_warps, grain_warps = len(warps(len(lists.first))), len(warps(n))
    return StepCost(pairs / n, grains / n, pair_warps / n, grain_warps / n, turns / grain_warps)
