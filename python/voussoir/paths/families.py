"""Strain paths of the laboratory, and paths that somebody prescribes.

Every function returns displacement gradients F - I (n, increments, 2, 2), each counted from the state before.
Parameters are numbers or arrays with one value a path; n is the length of the longest array. Strains are logarithmic;
extension is positive, so a compression has a negative strain."""

import numpy as np
from numpy.typing import ArrayLike

from .schedule import Paths
from .tensors import gradient_of_strain, increments_between, strain_of_direction

Array = np.ndarray


def prescribed(history: ArrayLike) -> Array:
    """Increments of a history: (n, points, 3) logarithmic strains (xx, yy, gamma_xy), or (n, points, 2, 2) deformation
    gradients F. The first point of a history is where the path begins, so that there is one increment fewer than
    points.

    A history of strains has no rotation: F_k = exp(e_k), and an increment is F_{k+1} F_k^-1 - I."""
    history = np.asarray(history, float)
    if history.ndim == 3 and history.shape[2] == 3 and history.shape[1] > 1:
        return increments_between(gradient_of_strain(history))
    if history.ndim == 4 and history.shape[2:] == (2, 2) and history.shape[1] > 1:
        return increments_between(history - np.eye(2))
    raise ValueError(f"a history has the shape (n, points, 3) or (n, points, 2, 2), and this one has {history.shape}")


def undrained(increments: int, amplitude: ArrayLike = 0.02, direction: ArrayLike = 0.0) -> Array:
    """Shear at constant volume: the strain grows to +`amplitude` along the axis at the angle `direction` from x [rad],
    and to -`amplitude` across it. det F is 1 in every increment, as in saturated ground that cannot drain."""
    return _proportional(increments, *_columns(amplitude, direction))


def biaxial(increments: int, axial: ArrayLike = -0.02, lateral: ArrayLike = 0.0, direction: ArrayLike = 0.0) -> Array:
    """A biaxial test whose two strains are given: yy grows to `axial` and xx to `lateral`, both in proportion.
    lateral = -axial keeps the volume, lateral = 0 is an oedometer.
    `direction` turns the sample counter-clockwise [rad]."""
    axial, lateral, direction = _columns(axial, lateral, direction)
    return _proportional(increments, 0.5 * (lateral - axial), direction, lateral + axial)


def cyclic(
    increments: int,
    amplitude: ArrayLike = 0.005,
    cycles: int = 2,
    direction: ArrayLike = 0.0,
    volumetric: ArrayLike = 0.0,
    one_way: bool = False,
) -> Array:
    """Cycles of shear along a fixed axis, at constant volume by default: the deviatoric strain follows a triangular
    wave between +`amplitude` and -`amplitude` (`one_way`: between 0 and `amplitude`), and the volumetric strain
    follows the same wave with the amplitude `volumetric`. The product of all F of a path is the identity."""
    if cycles < 1 or increments < 4 * cycles:
        raise ValueError(f"{cycles} cycles need at least {4 * max(cycles, 1)} increments, and there are {increments}")
    amplitude, direction, volumetric = _columns(amplitude, direction, volumetric)
    phase = cycles * np.arange(increments + 1) / increments
    wave = triangle(2 * phase) if one_way else triangle(phase)
    wave = np.abs(wave) if one_way else wave
    wave[[0, -1]] = 0.0
    change = np.diff(wave)
    return gradient_of_strain(strain_of_direction(amplitude * change, direction, volumetric * change))


def rotating(
    increments: int,
    amplitude: ArrayLike = 0.005,
    turns: ArrayLike = 0.5,
    direction: ArrayLike = 0.0,
    radial: float = 0.25,
) -> Array:
    """Rotating principal axes of strain: in the first share `radial` of the increments the deviatoric strain grows to
    `amplitude` along the axis at `direction`; then it keeps its size, and its axes turn counter-clockwise by `turns`
    half turns (a half turn brings a principal axis back onto itself). The volume is constant."""
    if not 0 < radial < 1:
        raise ValueError("radial must lie between 0 and 1")
    amplitude, turns, direction = _columns(amplitude, turns, direction)
    place = np.arange(increments + 1) / increments
    size = amplitude * np.minimum(place / radial, 1.0)
    angle = direction + np.pi * turns * np.maximum(place - radial, 0.0) / (1 - radial)
    return prescribed(strain_of_direction(size, angle))


def drained(increments: int, axial: ArrayLike = -0.02, held: str = "xx") -> Paths:
    """Drained biaxial tests: the stress `held` ("xx" or "yy") keeps its value, and the strain of the other axis is
    prescribed: `axial` is its value at the end (a number, or one a path), or its history (n, increments + 1).

    The strain of the held axis follows from the grains in each increment (voussoir.paths.StressControl); the first
    guess is that it does not change."""
    if held not in ("xx", "yy"):
        raise ValueError(f"drained paths hold 'xx' or 'yy', not {held!r}")
    history = np.asarray(axial, float)
    if history.ndim < 2:
        history = np.atleast_1d(history)[:, None] * np.arange(increments + 1) / increments
    if history.shape[1] != increments + 1:
        raise ValueError(f"a history of {increments} increments has {increments + 1} points, not {history.shape[1]}")
    strain = np.zeros((len(history), increments, 3))
    strain[..., 1 if held == "xx" else 0] = np.diff(history, axis=1)
    return Paths(
        gradient_of_strain(strain), np.array([held == "xx", held == "yy", False]), np.full(len(history), "drained")
    )


def triangle(phase: ArrayLike) -> Array:
    """A wave of period 1 that begins at 0 and has the values 1, 0, -1, 0 at its quarters."""
    return 2 / np.pi * np.arcsin(np.sin(2 * np.pi * np.asarray(phase)))


def _columns(*values: ArrayLike) -> list[Array]:
    """Parameters as columns (n, 1) of one length."""
    return [
        np.array(value)[:, None] for value in np.broadcast_arrays(*(np.atleast_1d(v).astype(float) for v in values))
    ]


def _proportional(increments: int, deviatoric: Array, direction: Array, volumetric: Array | None = None) -> Array:
    """Equal increments of logarithmic strain up to the given principal strains; parameters are (n, 1)."""
    if increments < 1:
        raise ValueError("a path needs at least one increment")
    volume = np.zeros_like(deviatoric) if volumetric is None else volumetric
    strain = strain_of_direction(deviatoric / increments, direction, volume / increments)
    return np.repeat(gradient_of_strain(strain), increments, axis=1)
