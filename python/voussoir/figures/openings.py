"""The pressure of a scene's opening, from the nodal reactions of its boundary.

A support that changes the area A of an opening about a centre c moves its nodes by dx = (x - c) dA / (2 A). The work of
its forces f is the sum of f · dx = p dA, and so the pressure p = sum of f · (x - c) / (2 A): the pressure that is
conjugate to the area. A is the area between the boundary and c, so that half of an opening that is cut by a line of
symmetry through c has the pressure of the whole one: forces at nodes of this line that hold the symmetry do no work.
"""

from collections.abc import Sequence

import numpy as np

from . import scene
from .result import Increment, Missing, Result
from .scene import Motion


def enclosed(points: np.ndarray, centre: np.ndarray) -> float:
    """The area between a chain of sides and a centre [m2]; `points` (node, 2) are corners and midsides in turn, and the
    first node once more at the end of a closed chain. The sides are parabolas, for which Simpson's rule is exact."""
    a, m, b = (points[k : len(points) - 2 + k : 2] - centre for k in range(3))
    tangents = (4 * m - 3 * a - b, b - a, a - 4 * m + 3 * b)
    twice = sum(w * (x[:, 0] * t[:, 1] - x[:, 1] * t[:, 0]) for w, x, t in zip((1, 4, 1), (a, m, b), tangents)) / 6
    return float(abs(np.sum(twice)) / 2)


def pressure(result: Result, motion: Motion, increments: Sequence[Increment]) -> np.ndarray:
    """The pressure of the support on the ground at each increment [Pa]."""
    if motion.name not in result.boundaries:
        raise Missing(f"run.h5 has no boundary {motion.name}")
    nodes = result.boundaries[motion.name]
    centre = scene.place_of(result, motion.about)
    chain = np.append(nodes, nodes[0]) if len(nodes) % 2 == 0 else nodes
    if centre is None:
        raise Missing(f"the centre {motion.about} of {motion.name} is a point of the mesh, which run.h5 does not have")
    found = []
    for increment in increments:
        x = result.coordinates + increment.field("node/displacement")
        work = np.sum(increment.field("node/reaction")[nodes] * (x[nodes] - centre))
        found.append(work / (2 * enclosed(x[chain], centre)))
    return np.array(found)
