"""What a batch answers: stresses, tangents and reports of its points, and the grains of a point."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from voussoir.notebook import packing_png
from voussoir.packings import Floats, Integers

#: Columns of a report. A column's unit is [-] where none is given.
#:
#: - `status`: index into `status_names`
#: - `steps`: time steps that the grains took, with those of the hold at the end
#: - `contacts`: number of contacts that carry force
#: - `unbalanced`: unbalanced ratio at the end: rms force on a grain over pressure x thickness x mean diameter
#: - `inertial_number`: of the straining, at the final pressure
#: - `largest_overlap`: of a contact, over r_i + r_j
#: - `mean_overlap`: the same, mean over the contacts
#: - `cell_area`: at the end [m^2]
report_dtype = np.dtype(
    {
        "names": ["status", "steps", "contacts", "unbalanced", "inertial_number", "largest_overlap", "mean_overlap",
                  "cell_area"],
        "formats": ["i4", "i4", "i4", "f8", "f8", "f8", "f8", "f8"],
        "offsets": [0, 4, 8, 16, 24, 32, 40, 48],
        "itemsize": 56,
    }
)  # fmt: skip

#: Names of the numbers in a report's column `status` (docs/reference/log_lines.md says what to do about each):
#:
#: - `converged`: the grains are at rest
#: - `step_limit`: the grains still move; the stress is that of the last step
#: - `open`: no contacts are left, and the stress is zero. Where this comes unexpected, look whether the gradients are
#:   F - I and count from the committed state.
#: - `neighbour_overflow`: a failure: the cell is too narrow for its largest grains, or grains have too many neighbours
#: - `overlap_limit`: a failure: grains overlap too much; take smaller increments
#: - `not_finite`: a failure: a number grew beyond all bounds, or the cell was turned inside out
#:
#: A point with a failure answers with NaN.
status_names: tuple[str, ...] = (
    "converged",
    "step_limit",
    "open",
    "neighbour_overflow",
    "overlap_limit",
    "not_finite",
)


class Answer(NamedTuple):
    """What all points answer."""

    stress: Floats  #: (n, 2, 2) Cauchy stress, tension positive [Pa]
    tangent: Floats | None  #: (n, 3, 3) d stress / d strain in (xx, yy, gamma_xy), symmetric [Pa]; None: not asked for
    report: NDArray[Any]  #: (n,) of report_dtype
    usable: bool  #: False where a point has failed; its stress and tangent are NaN, and `commit` refuses
    message: str  #: which point has failed, and why; empty where usable


@dataclass(frozen=True, eq=False)
class Snapshot:
    """The grains of a point and the forces between them, in the committed state."""

    radius: Floats  #: (g,) [m]
    position: Floats  #: (g, 2) centres [m]
    rotation: Floats  #: (g,) since the reference state [rad]
    cell: Floats  #: (2, 2) periodic cell; its columns are the periodic vectors [m]
    thickness: float  #: out of the plane [m]
    contacts: Integers  #: (c, 2) numbers i < j of the grains of each contact
    branch: Floats  #: (c, 2) vector from i to j [m]
    force: Floats  #: (c, 2) force on grain i [N]

    def _repr_png_(self) -> bytes | None:
        return packing_png(self.radius, self.position, self.cell, self.contacts)
