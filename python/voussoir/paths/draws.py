"""Strain paths that are drawn: smooth random walks, and proportional legs that fill the space of their parameters
evenly.

Both return displacement gradients F - I (n, increments, 2, 2), each counted from the state before. The same arguments
give the same paths."""

import numpy as np

from .tensors import gradient_of_strain, strain_of_direction

Array = np.ndarray
Bounds = tuple[float, float]


def random(
    n: int,
    increments: int,
    *,
    step: float = 1e-3,
    modes: int = 4,
    deviatoric_limit: float = 0.03,
    volumetric: Bounds = (-0.004, 0.002),
    seed: int = 0,
) -> Array:
    """Smooth random walks in the space of logarithmic strains.

    Each of the three parts (half the difference of the normal strains, half the engineering shear, volume) is a sum of
    `modes` half sines with random phases, whose amplitudes fall as 1/mode. The deviatoric increments of a path have the
    root mean square `step`, unless the path would leave the circle of radius `deviatoric_limit` around its beginning,
    into which it is shrunk. The volumetric strain stays in the bounds `volumetric` = (least, greatest) around
    zero: it is scaled by a share, drawn evenly between 0 and 1, of the
    factor with which it would touch one of them. All this is said of the summed increments; where axes turn, the
    logarithm of the product of all F differs from this sum in second order."""
    low, high = volumetric
    if n < 1 or increments < 1 or modes < 1 or not step > 0 or not low <= 0 <= high:
        raise ValueError("random paths need n, increments, modes >= 1, step > 0 and volumetric bounds around zero")
    rng = np.random.default_rng(seed)
    mode = np.arange(1, modes + 1)
    amplitude = rng.normal(size=(n, 3, modes)) / mode
    phase = rng.uniform(0, 2 * np.pi, (n, 3, modes))
    time = np.arange(increments + 1) / increments
    wave = np.sin(np.pi * mode[:, None] * time + phase[..., None]) - np.sin(phase[..., None])
    walk = (amplitude[..., None] * wave).sum(axis=2)  # (n, 3, points)
    shear, volume = walk[:, :2], walk[:, 2]
    size = np.sqrt((np.diff(shear, axis=2) ** 2).sum(axis=1).mean(axis=1))
    reach = np.hypot(shear[:, 0], shear[:, 1]).max(axis=1)
    shear = shear * np.minimum(step / size, deviatoric_limit / reach)[:, None, None]
    volume = volume * (_into(volume, low, high) * rng.uniform(size=n))[:, None]
    strain = np.stack([0.5 * volume + shear[:, 0], 0.5 * volume - shear[:, 0], 2 * shear[:, 1]], axis=-1)
    return gradient_of_strain(np.diff(strain, axis=1))


def stratified(
    n: int,
    increments: int,
    *,
    amplitude: Bounds = (0.002, 0.03),
    dilatancy: Bounds = (-0.3, 0.15),
    legs: int = 2,
    method: str = "sobol",
    seed: int = 0,
) -> Array:
    """Paths of `legs` straight legs, whose parameters fill their ranges evenly: the direction of the shear of each leg
    (all angles), the volumetric strain of each leg over its deviatoric strain (in `dilatancy`), the summed deviatoric
    strain of all legs (its logarithm in `amplitude`), and the lengths of the legs.

    `method` is "sobol" (scrambled; best for n = 2^k) or "latin" (Latin hypercube) of scipy.stats.qmc. Equal increments
    of deviatoric strain; a corner lies between two of them."""
    if not (0 < amplitude[0] <= amplitude[1]) or not dilatancy[0] <= dilatancy[1] or not 1 <= legs <= increments:
        raise ValueError("stratified paths need 0 < amplitude, ranges in order and 1 <= legs <= increments")
    unit = _even_points(n, 1 + 2 * legs + (legs - 1), method, seed)
    total = amplitude[0] * (amplitude[1] / amplitude[0]) ** unit[:, 0]
    direction = np.pi * unit[:, 1 : 1 + legs]
    ratio = dilatancy[0] + (dilatancy[1] - dilatancy[0]) * unit[:, 1 + legs : 1 + 2 * legs]
    corners = np.sort(unit[:, 1 + 2 * legs :], axis=1)
    middle = (np.arange(increments) + 0.5) / increments
    leg = (middle[None, :, None] >= corners[:, None, :]).sum(axis=2)  # (n, increments)
    size = np.repeat(total[:, None] / increments, increments, axis=1)
    angle, volume = np.take_along_axis(direction, leg, axis=1), np.take_along_axis(ratio, leg, axis=1) * size
    return gradient_of_strain(strain_of_direction(size, angle, volume))


def _into(walk: Array, low: float, high: float) -> Array:
    """The factor (n,) that brings walks (n, points) into their bounds, until one touches."""
    up, down = walk.max(axis=1), -walk.min(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        factor = np.fmin(np.where(up > 0, high / up, np.inf), np.where(down > 0, -low / down, np.inf))
    return np.where(np.isfinite(factor), factor, 0.0)


def _even_points(n: int, dimensions: int, method: str, seed: int) -> Array:
    """n points of the unit cube."""
    try:
        from scipy.stats import qmc
    except ImportError as error:
        raise ImportError("stratified paths need SciPy: pip install scipy") from error
    if method == "latin":
        return qmc.LatinHypercube(dimensions, rng=seed).random(n)
    if method == "sobol":
        points = qmc.Sobol(dimensions, rng=seed).random_base2(int(np.ceil(np.log2(max(n, 1)))))
        return points[:n]
    raise ValueError(f"method is 'sobol' or 'latin', not {method!r}")
