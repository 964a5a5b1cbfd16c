"""The Gauss points and elements that the study follows: Aa, Ab, Ac above the crown, B in the shear band, lines of
points."""

from dataclasses import dataclass

import numpy as np

from . import q8
from .result import Missing, Result, remembered


@dataclass
class Point:
    name: str
    index: int  # Gauss point, 4 * element + corner
    position: np.ndarray  # original coordinates [m]


def history(result: Result, name: str, point: Point) -> np.ndarray:
    """A Gauss-point field at a point over the volume loss; (increment[, components])."""
    element, corner = divmod(point.index, 4)
    return result.loss_history(name)[:, element, corner]


def original_points(result: Result) -> np.ndarray:
    """(point, 2) [m]."""
    return remembered(
        result,
        "original points",
        lambda: q8.gauss_coordinates(result.coordinates, result.connectivity).reshape(-1, 2),
    )


def nearest(result: Result, name: str, x: float, y: float) -> Point:
    points = original_points(result)
    index = int(np.argmin(np.hypot(points[:, 0] - x, points[:, 1] - y)))
    return Point(name, index, points[index])


def heights_above_crown(result: Result) -> list[float]:
    """Heights of Aa, Ab, Ac above the crown [D], without those above the surface. Unless an option gives them, they are
    0.25 D, 1 D and, where this is higher, 0.75 C."""
    (diameter,) = result.need("diameter")
    cover = result.cover / diameter
    if result.settings.above_crown is None:
        return [k for k in (0.25, 1.0) if k <= cover] + ([0.75 * cover] if 0.75 * cover > 1 else [])
    return [k for k in result.settings.above_crown if k <= cover * (1 + 1e-9)]


def above_crown(result: Result) -> list[Point]:
    """The points Aa, Ab, Ac, without those that would lie above the surface."""
    (diameter,) = result.need("diameter")
    heights = heights_above_crown(result)
    return [
        nearest(result, name, 0.0, result.crown_height + k * diameter) for name, k in zip(("Aa", "Ab", "Ac"), heights)
    ]


def in_the_band(result: Result) -> Point:
    """The point B: the point of the largest deviatoric strain at the end, away from the axis and above the crown.

    The study's words do not exclude the wall of the opening, where the strain is largest. But RVEs there lose their
    contacts, and B has to be in the shear band.
    """
    (diameter,) = result.need("diameter")
    points = original_points(result)
    height = (points[:, 1] - result.crown_height) / diameter
    strain = np.where(
        (points[:, 0] > result.settings.aside * diameter) & (height >= result.settings.aside_above),
        result.loss_increments[-1].field("gauss/deviatoric_strain").ravel(),
        -np.inf,
    )
    index = int(np.argmax(strain))
    if not np.isfinite(strain[index]):
        raise Missing("no point lies beside the axis")
    return Point("B", index, points[index])


def all_points(result: Result) -> list[Point]:
    return [*above_crown(result), in_the_band(result)]


def describe(result: Result, point: Point) -> str:
    """ "Ab  (0.07 m, 1.02 D above the crown)", for legends."""
    (diameter,) = result.need("diameter")
    return f"{point.name}  ({point.position[0]:.2f} m, {(point.position[1] - result.crown_height) / diameter:+.2f} $D$)"


def crown_elements(result: Result) -> np.ndarray:
    """The element just above the crown: of those that hold the crown's node, the one whose centre lies highest. A
    tunnel with both halves has one on either side of its axis, with the same height to a hundredth."""
    holders = np.flatnonzero(np.any(result.connectivity == result.crown(), axis=1))
    heights = result.coordinates[result.connectivity[holders]].mean(axis=1)[:, 1] - result.crown_height
    highest = heights.max()
    return holders[heights >= 0.99 * highest] if result.is_whole else holders[[np.argmax(heights)]]


def on_level(result: Result, y: float, width: float = np.inf) -> np.ndarray:
    """Indices of one row of Gauss points in the elements that a level line crosses, by ascending x."""
    points = original_points(result)
    nodes = result.coordinates[result.connectivity]
    crossed = np.flatnonzero((nodes[..., 1].min(axis=1) <= y) & (nodes[..., 1].max(axis=1) > y))
    chosen = []
    for element in crossed:
        near = sorted(range(4 * element, 4 * element + 4), key=lambda p: abs(points[p, 1] - y))[:2]
        chosen += [p for p in near if points[p, 0] <= width]
    return np.array(sorted(chosen, key=lambda p: points[p, 0]), dtype=int)


class LevelLine:
    """A level line through the elements, one place in each of them; Gauss-point fields are interpolated there."""

    def __init__(self, result: Result, y: float, width: float = np.inf) -> None:
        nodes = result.coordinates[result.connectivity]
        crossed = np.flatnonzero((nodes[..., 1].min(axis=1) < y) & (nodes[..., 1].max(axis=1) > y))
        places, elements, weights = [], [], []
        for element in crossed:
            low, high = nodes[element, :, 0].min(), nodes[element, :, 0].max()
            inside = [
                (x, local)
                for x in np.linspace(low, high, 21)
                if (local := q8.local_coordinates(nodes[element], np.array([x, y]))) is not None
            ]
            if inside and inside[len(inside) // 2][0] <= width:
                x, local = inside[len(inside) // 2]
                places.append(x)
                elements.append(element)
                weights.append(q8.gauss_weights(local[None])[0])
        order = np.argsort(places)
        self.x, self.elements = np.array(places)[order], np.array(elements, dtype=int)[order]
        self.weights = np.array(weights).reshape(-1, 4)[order]

    def of(self, values: np.ndarray) -> np.ndarray:
        """A field (element, 4[, components]) along the line."""
        return np.einsum("eg,eg...->e...", self.weights, values[self.elements])


def on_axis(result: Result) -> np.ndarray:
    """Gauss points next to the axis of symmetry above the crown: indices by ascending height."""
    points = original_points(result)
    on_left = np.abs(result.coordinates[result.connectivity][..., 0]) < 1e-9
    touching = np.flatnonzero(on_left.sum(axis=1) >= 3)  # a whole edge of the element lies there
    chosen = []
    for element in touching:
        if result.coordinates[result.connectivity[element], 1].mean() < result.crown_height:
            continue
        chosen += sorted(range(4 * element, 4 * element + 4), key=lambda p: points[p, 0])[:2]
    return np.array(sorted(chosen, key=lambda p: points[p, 1]), dtype=int)
