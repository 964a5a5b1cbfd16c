"""Closed forms for the plane deformations of a path: exponentials, logarithms and products of 2 x 2 tensors.

Strains are in Voigt order (xx, yy, gamma_xy) with the engineering shear gamma_xy = 2 e_xy; extension is positive. A
displacement gradient F - I is kept instead of F, because it does not lose digits where F is near the identity."""

import numpy as np

Array = np.ndarray


def gradient_of_strain(strain: Array) -> Array:
    """F - I of the stretch F = exp(e), (..., 2, 2), for logarithmic strains e (..., 3).

    With e = s I + d, where d is deviatoric and has the principal values +q and -q, exp(e) = exp(s) (cosh(q) I +
    sinh(q) / q d), which is the formula of Cayley and Hamilton."""
    strain = np.asarray(strain, float)
    s, a, c = _parts(strain[..., 0], strain[..., 1], 0.5 * strain[..., 2])
    q = np.hypot(a, c)
    safe = np.where(q > 0, q, 1.0)
    share = np.exp(s) * np.where(q > 0, np.sinh(safe) / safe, 1.0)
    mean = np.expm1(s) + np.exp(s) * 2 * np.sinh(0.5 * q) ** 2
    return _matrix(mean + share * a, share * c, mean - share * a)


def strain_of_gradient(gradient: Array) -> Array:
    """Logarithmic (Hencky) strain ln V (..., 3) of displacement gradients F - I (..., 2, 2), F = V R with the rotation
    R.

    ln V is half the logarithm of F F^T = I + X; the principal values of X are s + q and s - q."""
    h = np.asarray(gradient, float)
    x = h + np.swapaxes(h, -1, -2) + h @ np.swapaxes(h, -1, -2)
    s, a, c = _parts(x[..., 0, 0], x[..., 1, 1], x[..., 0, 1])
    q = np.hypot(a, c)
    mean = 0.5 * np.log1p(2 * s + (s - q) * (s + q))
    share = np.where(q > 0, np.arctanh(q / (1 + s)) / np.where(q > 0, q, 1.0), 1 / (1 + s))
    return 0.5 * np.stack([mean + share * a, mean - share * a, 2 * share * c], axis=-1)


def compose(later: Array, earlier: Array) -> Array:
    """F - I of `later` after `earlier`: (I + A)(I + B) - I = A + B + A B."""
    return later + earlier + later @ earlier


def totals(gradient: Array) -> Array:
    """F - I since the beginning of a path (n, increments + 1, 2, 2), for increments (n, increments, 2, 2) that count
    from the state before each of them. The first row is zero."""
    n, increments = gradient.shape[:2]
    total = np.zeros((n, increments + 1, 2, 2))
    for k in range(increments):
        total[:, k + 1] = compose(gradient[:, k], total[:, k])
    return total


def increments_between(total: Array) -> Array:
    """The inverse of `totals`: F_{k+1} F_k^-1 - I (n, increments, 2, 2) of a history F - I (n, increments + 1, 2,
    2)."""
    total = np.asarray(total, float)
    return (total[:, 1:] - total[:, :-1]) @ np.linalg.inv(np.eye(2) + total[:, :-1])


def strain_of_direction(deviatoric: Array, direction: Array, volumetric: Array | float = 0.0) -> Array:
    """Strains (..., 3) with the principal values v/2 + d and v/2 - d. `direction` is the angle from x,
    counter-clockwise, of the principal axis of v/2 + d [rad]."""
    deviatoric, direction, volumetric = np.broadcast_arrays(deviatoric, direction, volumetric)
    a = deviatoric * np.cos(2 * direction)
    return np.stack([0.5 * volumetric + a, 0.5 * volumetric - a, 2 * deviatoric * np.sin(2 * direction)], axis=-1)


def mirror(voigt: Array) -> Array:
    """Stresses or strains (..., 3) in the mirror image x -> -x."""
    return np.asarray(voigt) * np.array([1.0, 1.0, -1.0])


def voigt_of(tensor: Array) -> Array:
    """(xx, yy, xy) of symmetric tensors (..., 2, 2); of stresses, not of strains, because xy is not doubled."""
    return np.stack([tensor[..., 0, 0], tensor[..., 1, 1], tensor[..., 0, 1]], axis=-1)


def pressure_of(stress: Array) -> Array:
    """The mean stress p = -(xx + yy)/2, compression positive [Pa], of stresses (..., 3), tension positive."""
    return -0.5 * (stress[..., 0] + stress[..., 1])


def _parts(xx: Array, yy: Array, xy: Array) -> tuple[Array, Array, Array]:
    """Mean, half difference and shear of a symmetric tensor."""
    return 0.5 * (xx + yy), 0.5 * (xx - yy), np.asarray(xy)


def _matrix(xx: Array, xy: Array, yy: Array) -> Array:
    return np.stack([np.stack([xx, xy], axis=-1), np.stack([xy, yy], axis=-1)], axis=-2)
