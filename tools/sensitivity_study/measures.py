"""The numbers by which the three trends in question are compared. All functions are pure functions of arrays."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from voussoir.figures.resolution import running_means


@dataclass(frozen=True)
class Recovery:
    """A ground reaction curve: stress over its value before the loss [-]."""

    least: float  # of all states
    at: float  # V_l of this state [-]
    end: float
    mean_least: float  # the smallest running mean
    mean_at: float  # V_l at the middle of this mean [-]
    mean_end: float  # mean over the last window

    @property
    def factor(self) -> float:
        """End over minimum, of the running means. It is 1 where the curve falls to its end."""
        return self.mean_end / self.mean_least


def recovery(loss: np.ndarray, ratio: np.ndarray) -> Recovery:
    """The minimum alone of a noisy curve lies below its level by chance, so that a flat curve would seem to recover:
    running means are compared with one another."""
    least = int(np.argmin(ratio))
    middles, means = running_means(loss, ratio)
    k = int(np.argmin(means))
    return Recovery(
        float(ratio[least]), float(loss[least]), float(ratio[-1]), float(means[k]), float(middles[k]), float(means[-1])
    )


@dataclass(frozen=True)
class Contraction:
    """The volumetric strain of a place since V_l = 0, contraction positive [-]."""

    most: float
    at: float  # V_l at which it contracts no further [-]
    net_until: float  # V_l at which it has its first volume again [-]; the end where it never has
    end: float


def contraction(loss: np.ndarray, volumetric: np.ndarray) -> Contraction:
    most = int(np.argmax(volumetric))
    below = np.flatnonzero(volumetric[most:] <= 0)
    until = float(loss[-1])
    if len(below) and volumetric[most] > 0:
        k = most + int(below[0])
        high, low = volumetric[k - 1], volumetric[k]
        until = float(loss[k - 1] + (loss[k] - loss[k - 1]) * high / (high - low))
    elif volumetric[most] <= 0:
        until = 0.0
    return Contraction(float(volumetric[most]), float(loss[most]), until, float(volumetric[-1]))


def heights_that_contract(
    heights: Iterable[float], contractions: Iterable[Contraction], until: float
) -> tuple[float, float] | None:
    """The lowest and the highest of the places that contract until V_l = `until` or longer; None where none does."""
    found = [h for h, c in zip(heights, contractions) if c.most > 0 and c.at >= until - 1e-9]
    return (min(found), max(found)) if found else None


def spread(values: Iterable[float]) -> tuple[float, float, float]:
    """Mean, smallest and largest; with two or three draws the range says more than a standard deviation."""
    known = np.array([v for v in values if np.isfinite(v)])
    if not len(known):
        return (float("nan"),) * 3
    return float(known.mean()), float(known.min()), float(known.max())
