"""The quantities of a dataset: name, unit, shape, how they are stored, and where they come from."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Field:
    """One quantity of every row and point of time. `components` are the names of the last axis; empty: none."""

    name: str
    unit: str
    meaning: str
    kind: str = "f4"
    components: tuple[str, ...] = ()
    source: str = "fields"  # "fields" or "report" of a batch; "block": block.py says how
    microstructure: str = ""  # what the batch must be asked for

    def empty(self, *shape: int) -> np.ndarray:
        """Values of a shape before they are known: NaN, or -1 in fields of integers."""
        missing = np.nan if self.kind.startswith("f") else -1
        return np.full((*shape, *((len(self.components),) if self.components else ())), missing, self.kind)


TANGENT = ("xxxx", "xxyy", "xxxy", "yyyy", "yyxy", "xyxy")
TANGENT_PLACES = ((0, 0, 0, 1, 1, 2), (0, 1, 2, 1, 2, 2))  # rows and columns of the 3 x 3 tangent
MOST_MEAN_OVERLAP = 0.06  # beyond it the contact law is out of its range (docs/explanation/range.md)
MASKED = -1  # the status of the increments behind one that failed

ALL = (
    Field("stress", "Pa", "Cauchy stress, tension positive", components=("xx", "yy", "xy"), source="block"),
    Field("strain", "-", "logarithmic strain ln V since point 0", components=("xx", "yy", "gamma_xy"), source="block"),
    Field("tangent", "Pa", "d stress/d strain, Voigt (xx, yy, gamma_xy)", components=TANGENT, source="block"),
    Field("status", "-", "how the evaluation ended (see the card)", "i1", source="report"),
    Field("steps", "-", "time steps of the grains", "i4", source="report"),
    Field("unbalanced", "-", "rms force on a grain over p t d", source="report"),
    Field("control_error", "Pa", "by how much held stresses miss their values", source="block"),
    Field("contacts", "-", "number of contacts", "i4", source="report"),
    Field("inertial_number", "-", "inertial number of the straining", source="report"),
    Field("mean_overlap", "-", "overlap over the sum of the radii, mean over contacts", source="report"),
    Field("largest_overlap", "-", "overlap over the sum of the radii, largest", source="report"),
    Field("void_ratio", "-", "area of voids over area of grains", source="block"),
    Field("coordination", "-", "contacts of a grain, mean", source="block"),
    Field("grain_rotation", "rad", "mean rotation of the grains, counter-clockwise"),
    Field("fabric_anisotropy", "-", "anisotropy of the contact normals", microstructure="fabric"),
    Field("fabric_direction", "rad", "most contact normals point there; an axis", microstructure="fabric"),
    Field("mechanical_coordination", "-", "contacts of grains that carry force", microstructure="coordination"),
    Field("strong_coordination_1", "-", "in the network of forces above the mean", microstructure="strong_networks"),
)
#: The fields that a dataset may have, by name: each has its shape, unit and meaning.
BY_NAME = {one.name: one for one in ALL}
DEFAULT = [
    "stress",
    "strain",
    "tangent",
    "status",
    "steps",
    "unbalanced",
    "void_ratio",
    "coordination",
    "fabric_anisotropy",
    "fabric_direction",
]
NEEDED = ("stress", "strain", "status", "mean_overlap")


def chosen(names: Sequence[str] | None, held: bool) -> list[Field]:
    """The fields of a dataset: those that are asked for, and those without which it cannot be understood.

    ValueError: a name is not known."""
    wanted = list(DEFAULT if names is None else names)
    unknown = [name for name in wanted if name not in BY_NAME]
    if unknown:
        raise ValueError(f"there are no fields {', '.join(unknown)}; there are {', '.join(BY_NAME)}")
    needed = {*NEEDED, *(("control_error",) if held else ())}
    return [one for one in ALL if one.name in wanted or one.name in needed]


def microstructure(fields: Sequence[Field]) -> tuple[str, ...]:
    """What a batch must be asked for."""
    return tuple(sorted({one.microstructure for one in fields if one.microstructure}))
