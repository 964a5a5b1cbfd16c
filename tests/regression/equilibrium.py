"""Equilibrium of a scene: the reactions of all that is held, the weights and the loads add up to nothing.

Everything is computed from the files of a run with quadrature of its own, so that a load that the program forgets, puts
on the wrong edge or counts twice is found. Sums of forces do not see moments, nor forces within the ground.
"""

import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
from numpy.typing import NDArray
from program import check, table

Array = NDArray[np.float64]
CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], float)
GAUSS = 1 / np.sqrt(3)
# Load of an outer edge: from its first coordinates (3 x 2), the stage's name and the load parameter to a pressure [Pa].
Pressure = Callable[[Array, str, float], float]


@dataclass
class Balance:
    """What is left of the sum of all forces after one increment, beside the forces that were summed [N/m]."""

    stage: str
    load_parameter: float
    left: Array  # x, y
    size: float  # sum of the reactions' magnitudes


def _derivatives(r: float, s: float) -> Array:
    """Derivatives of the eight shape functions to r and s, 8 x 2."""
    found = np.zeros((8, 2))
    for k, (a, b) in enumerate(CORNERS):
        found[k] = 0.25 * a * (1 + b * s) * (2 * a * r + b * s), 0.25 * b * (1 + a * r) * (a * r + 2 * b * s)
    for k, (a, b) in enumerate(((0, -1), (1, 0), (0, 1), (-1, 0)), start=4):
        if a == 0:
            found[k] = -r * (1 + b * s), 0.5 * b * (1 - r * r)
        else:
            found[k] = 0.5 * a * (1 - s * s), -s * (1 + a * r)
    return found


def _area(x: Array) -> float:
    """Area of an element with the nodes x, 8 x 2 [m2]."""
    places = [(a * GAUSS, b * GAUSS) for a, b in CORNERS]
    return float(sum(np.linalg.det(x.T @ _derivatives(r, s)) for r, s in places))


def outer_edges(connectivity: NDArray[np.int64]) -> list[tuple[int, int, int]]:
    """Corner, middle and corner of the edges that belong to one element, counter-clockwise about it."""
    edges: dict[tuple[int, int], tuple[int, int, int] | None] = {}
    for nodes in connectivity:
        for k in range(4):
            a, middle, b = int(nodes[k]), int(nodes[4 + k]), int(nodes[(k + 1) % 4])
            pair = (min(a, b), max(a, b))
            edges[pair] = None if pair in edges else (a, middle, b)
    return [edge for edge in edges.values() if edge is not None]


def _weights(case: dict, x: Array, connectivity: NDArray[np.int64], heavier: Callable[[Array], float] | None) -> float:
    """Weight of the whole ground [N/m]. `heavier`: unit weight at an element's centre, where regions differ."""
    units = [region["unit_weight"] for region in case["region"]]
    check(heavier is not None or len(set(units)) == 1, "regions of several unit weights need a function of the place")
    total = 0.0
    for nodes in connectivity:
        corners = x[nodes]
        unit = 1e3 * float(units[0].split()[0]) if heavier is None else heavier(corners.mean(axis=0))
        total += unit * _area(corners)
    return total


def balances(
    folder: Path,
    pressure: Pressure | None = None,
    heavier: Callable[[Array], float] | None = None,
    stages: tuple[str, ...] = (),
) -> list[Balance]:
    """The balance after every increment of the stages (all, where none is named).

    `pressure`: of edges along the axes on which they are not held; left out, packing.pressure.
    """
    with h5py.File(folder / "run.h5") as run:
        case = tomllib.loads(run["input"][()].decode())
        x, connectivity = run["mesh/coordinates"][()], run["mesh/connectivity"][()]
    p0 = 1e3 * float(case["packing"]["pressure"].split()[0])
    weight, edges = _weights(case, x, connectivity, heavier), outer_edges(connectivity)
    stages_of_case = {stage["name"]: stage for stage in case["stage"]}
    factor, tilt, found, moved = 0.0, 0.0, [], x
    for row in table(folder):
        stage, at = row["stage"], row["load_parameter"]
        file = folder / "increments" / f"{row['index']:04d}.h5"
        with h5py.File(file) as increment:
            reaction = increment["node/reaction"][()]
            now = increment["mesh/coordinates"][()] if "mesh/coordinates" in increment else x
        if stages_of_case[stage].get("gravity"):
            factor = at
        if "tilt" in stages_of_case[stage]:  # of the first stage that has one; before it gravity is vertical
            tilt = np.radians(at * float(stages_of_case[stage]["tilt"].split()[0]))
        left = reaction.sum(axis=0) + factor * weight * np.array([np.sin(tilt), -np.cos(tilt)])
        for a, middle, b in edges:
            along = moved[b] - moved[a]
            outward = np.array([along[1], -along[0]])  # integral of the normal along the edge, exact for curved ones
            load = p0 if pressure is None else pressure(x[[a, middle, b]], stage, at)
            for axis in range(2):
                if not all(reaction[[a, middle, b], axis] != 0):
                    left[axis] -= load * outward[axis]
        # The first state of a stage is not solved for: a packing's own stress is isotropic to some percent only.
        if row["stage_index"] > 0 and (not stages or stage in stages):
            found.append(Balance(stage, at, left, float(np.abs(reaction).sum())))
        moved = now
    return found


def check_balance(found: list[Balance], tolerance: float, axes: str = "xy") -> float:
    """Checks every balance and returns the largest remainder over the sum of the reactions' magnitudes."""
    check(found, "no increment to balance")
    worst = 0.0
    for one in found:
        for axis in (index for index, name in enumerate("xy") if name in axes):
            share = abs(one.left[axis]) / one.size
            worst = max(worst, share)
            check(
                share <= tolerance,
                f"{one.stage} at {one.load_parameter:g}: {one.left[axis]:.4g} N/m are left along {'xy'[axis]}, "
                f"{share:.2e} of the reactions",
            )
    return worst
