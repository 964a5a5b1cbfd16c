"""The modified Gauss curve of settlement troughs (Vorster et al.), eqs. (20), (21) of the paper."""

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import numpy.typing as npt

# With alpha = 0.5 the curve is the Gauss curve; a larger alpha makes it flatter at the bottom, with steeper flanks.
# Towards alpha = 0 it becomes S_max / (1 + (x/i)^2 / 3), the curve of eq. (20) with the widest foot. For a trough that
# is still more pointed, the fit leaves alpha at its lower end, where its value has no meaning; i is the inflection of
# the best such curve.
ALPHA_RANGE = (0.02, 20.0)

Number = TypeVar("Number", float, np.ndarray)


def shape_number(alpha: Number) -> Number:
    """n of eq. (21), chosen so that x = i is the inflection point."""
    return np.exp(alpha) * (2 * alpha - 1) / (2 * alpha + 1) + 1


def modified_gauss(x: npt.ArrayLike, largest: float, inflection: Number, alpha: Number) -> np.ndarray:
    """Settlement of eq. (20) at distance x from the axis, same unit as `largest`."""
    n = shape_number(alpha)
    exponent = np.minimum(alpha * (np.asarray(x) / inflection) ** 2, 700)
    return largest * n / ((n - 1) + np.exp(exponent))


@dataclass
class TroughFit:
    largest: float  # S_max [m]
    inflection: float  # i [m]
    alpha: float  # [-]
    misfit: float  # rms of the residual relative to S_max [-]

    @property
    def good(self) -> bool:
        """True where the trough has the shape of eq. (20): alpha is within its range and the misfit below 3 % of S_max.
        A plug with a wide foot has another shape: its fit follows either the plug or the foot, and i jumps between
        them."""
        return not self.at_bound and self.misfit < 0.03

    @property
    def at_bound(self) -> bool:
        """True where alpha lies at an end of its range, so that the trough does not have the shape of eq. (20)."""
        return not 1.05 * ALPHA_RANGE[0] < self.alpha < 0.95 * ALPHA_RANGE[1]

    @property
    def n(self) -> float:
        return shape_number(self.alpha)

    def __call__(self, x: npt.ArrayLike) -> np.ndarray:
        return modified_gauss(x, self.largest, self.inflection, self.alpha)


def fit(x: npt.ArrayLike, settlement: npt.ArrayLike) -> TroughFit:
    """Least squares weighted by length, so that a finer mesh at the axis does not count more.

    S_max is linear and solved for; (ln i, ln alpha) are found on a grid that is refined around its best point,
    which needs no first guess and does not end in a local minimum.
    """
    order = np.argsort(x)
    x, settlement = np.asarray(x)[order], np.asarray(settlement)[order]
    weight = np.gradient(x)
    low = np.log([0.02 * x[-1], ALPHA_RANGE[0]])
    high = np.log([2.0 * x[-1], ALPHA_RANGE[1]])
    centre, half = (low + high) / 2, (high - low) / 2
    best = (0.0, 0.0, 0.0, 0.0)
    for _ in range(25):
        axes = [np.clip(np.linspace(c - h, c + h, 15), a, b) for c, h, a, b in zip(centre, half, low, high)]
        inflection, alpha = (np.exp(g).reshape(-1, 1) for g in np.meshgrid(*axes))
        unit = modified_gauss(x, 1.0, inflection, alpha)
        largest = (unit * weight) @ settlement / np.maximum((unit**2) @ weight, 1e-300)
        misfit = ((settlement - largest[:, None] * unit) ** 2) @ weight
        k = int(np.argmin(misfit))
        best = largest[k], inflection[k, 0], alpha[k, 0], misfit[k]
        centre, half = np.log(best[1:3]), half * 0.5
    scale = abs(best[0]) if best[0] else 1.0
    return TroughFit(*best[:3], float(np.sqrt(best[3] / weight.sum())) / scale)
