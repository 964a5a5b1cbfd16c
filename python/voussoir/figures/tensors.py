"""Directions of plane tensors (xx, yy, xy) along the last axis, tension positive as in the files; and of axes."""

import numpy as np
import numpy.typing as npt


def major_from_vertical(stress: np.ndarray) -> np.ndarray:
    """Angle of the compressive major axis from the vertical [rad], counter-clockwise positive, in (-pi/2, pi/2]."""
    return axis_angle(0.5 * np.arctan2(2 * stress[..., 2], stress[..., 0] - stress[..., 1]))


def axis_angle(angle: npt.ArrayLike) -> np.ndarray:
    """The angle of an axis, which has no arrow, brought into (-pi/2, pi/2]."""
    return np.pi / 2 - np.mod(np.pi / 2 - np.asarray(angle), np.pi)
