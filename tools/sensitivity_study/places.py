"""Where a run is read: the stress above the crown at several places, the volume at several heights on the axis."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from voussoir.figures import points, reaction
from voussoir.figures.result import Missing, Result

from .measures import Contraction, contraction

BESIDE_AXIS = 0.12  # points nearer to the axis than this, in D, count as on it
HALF_BAND = 0.12  # and those within this distance in height, in D, count as at a height
HEIGHTS = tuple(0.125 * k for k in range(2, 25))  # above the crown, in D


@dataclass(frozen=True)
class Place:
    """A rectangle above the crown, in D: heights from `low` to `high`, distances from the axis up to `width`."""

    label: str
    low: float
    high: float
    width: float


PLACES = (
    Place("0 to 0.1 D above the crown, over the whole opening (x < 0.5 D)", 0.0, 0.1, 0.5),
    Place("0.1 to 0.2 D, at the axis (x < 0.12 D)", 0.1, 0.2, BESIDE_AXIS),
    Place("0.1 to 0.2 D, over the whole opening", 0.1, 0.2, 0.5),
    Place("0.4 to 0.6 D, at the axis", 0.4, 0.6, BESIDE_AXIS),
    Place("0.4 to 0.6 D, over the whole opening", 0.4, 0.6, 0.5),
    Place("0.9 to 1.1 D, over the whole opening", 0.9, 1.1, 0.5),
    Place("1.9 to 2.1 D, over the whole opening", 1.9, 2.1, 0.5),
)
CROWN_ELEMENT = "the element above the crown, as the study says"


def over_diameter(result: Result) -> tuple[np.ndarray, np.ndarray]:
    """Distance from the axis and height above the crown of all Gauss points, in D."""
    (diameter,) = result.need("diameter")
    where = points.original_points(result)
    return where[:, 0] / diameter, (where[:, 1] - result.crown_height) / diameter


def mean_over(result: Result, field: str, inside: np.ndarray) -> np.ndarray:
    """Mean of a scalar field (or of the vertical stress, compression positive) over points, at each V_l."""
    if not inside.any():
        raise Missing("the mesh has no Gauss point at this place")
    values = result.loss_history(field)
    if field == "gauss/stress":
        values = -values[..., 1]
    return values.reshape(len(values), -1)[:, inside].mean(axis=1)


def reaction_at(result: Result, place: Place) -> np.ndarray:
    """Vertical stress over its value at V_l = 0."""
    x, height = over_diameter(result)
    inside = (height > place.low) & (height < place.high) & (x < place.width)
    stress = mean_over(result, "gauss/stress", inside)
    if not stress[0] > 0:
        raise Missing("the place is not compressed before the volume loss")
    return stress / stress[0]


def reactions(result: Result) -> dict[str, np.ndarray]:
    """The ground reaction curve as the study reads it, and at the other places that the mesh has points at."""
    found = {CROWN_ELEMENT: reaction.curve(result)[1]}
    for place in PLACES:
        try:
            found[place.label] = reaction_at(result, place)
        except Missing:
            continue
    return found


def at_height(result: Result, height: float) -> np.ndarray:
    """Which Gauss points lie at the axis at this height above the crown, in D."""
    x, heights = over_diameter(result)
    return (x < BESIDE_AXIS) & (np.abs(heights - height) < HALF_BAND)


@dataclass(frozen=True)
class Level:
    """Soil on the axis at one height above the crown, means over its points."""

    height: float  # in D
    count: int  # of the Gauss points
    volume: Contraction
    pressure: np.ndarray  # mean stress over the volume loss [Pa]
    ratio: np.ndarray  # q/p [-], means of q over means of p


def levels(result: Result, heights: Sequence[float] = HEIGHTS) -> list[Level]:
    """The heights at which the mesh has points on the axis."""
    found = []
    for height in heights:
        inside = at_height(result, height)
        if not inside.any():
            continue
        p, q = (mean_over(result, f"gauss/{name}_stress", inside) for name in ("mean", "deviatoric"))
        volumetric = mean_over(result, "gauss/volumetric_strain", inside)
        found.append(Level(height, int(inside.sum()), contraction(result.volume_loss, volumetric), p, q / p))
    return found
