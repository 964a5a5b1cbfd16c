"""Plane tensors (xx, yy, xy) along the last axis, tension positive as in the files: their directions and sizes."""

import numpy as np
import numpy.typing as npt


def major_from_vertical(stress: np.ndarray) -> np.ndarray:
    """Angle of the compressive major axis from the vertical [rad], counter-clockwise positive, in (-pi/2, pi/2]."""
    return axis_angle(0.5 * np.arctan2(2 * stress[..., 2], stress[..., 0] - stress[..., 1]))


def axis_angle(angle: npt.ArrayLike) -> np.ndarray:
    """The angle of an axis, which has no arrow, brought into (-pi/2, pi/2]."""
    return np.pi / 2 - np.mod(np.pi / 2 - np.asarray(angle), np.pi)


def deviatoric_strain(strain: np.ndarray) -> np.ndarray:
    """eps_q = sqrt(2 e_ij e_ij) of the deviator e_ij, eq. (11) [-]: the diameter of Mohr's circle."""
    return np.asarray(np.hypot(strain[..., 0] - strain[..., 1], 2 * strain[..., 2]))
