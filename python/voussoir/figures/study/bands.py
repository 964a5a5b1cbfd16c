"""Means over the members of an ensemble with their bands, as `ensemble.h5` defines them (docs/reference/files.md)."""

import functools
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ...ensembles import Bands

CONFIDENCE = 0.95  # of all bands


@functools.cache
def student_t(freedom: int) -> float:
    """The limit t that Student's variable exceeds in size with the probability 1 - CONFIDENCE.

    With x = sqrt(f) tan(phi) the density becomes proportional to cos(phi)^(f - 1), which a sum integrates: the error is
    below 1e-6 of t from one degree of freedom on.
    """
    angle = np.linspace(0, np.pi / 2, 200_001)
    density = np.cos(angle) ** (freedom - 1)
    inside = np.concatenate([[0.0], np.cumsum((density[1:] + density[:-1]) / 2)])
    return float(np.sqrt(freedom) * np.tan(np.interp(CONFIDENCE * inside[-1], inside, angle)))


def of_members(values: npt.ArrayLike) -> Bands:
    """Bands of values (member, ...). One member has no bands: its half widths are NaN."""
    members = np.asarray(values, dtype=float)
    count = len(members)
    mean = members.mean(axis=0)
    if count < 2:
        unknown = np.full_like(mean, np.nan)
        return Bands(mean, unknown, unknown, unknown, members)
    deviation = members.std(axis=0, ddof=1)
    t = student_t(count - 1)
    return Bands(mean, deviation, t * deviation / np.sqrt(count), t * deviation * np.sqrt(1 + 1 / count), members)


@dataclass
class Number:
    """One number over the members: mean ± half width of the band of the mean; NaN without a band."""

    mean: float
    half_width: float
    count: int

    def text(self, form: str = ".2f", factor: float = 1.0, unit: str = "") -> str:
        """ "0.32 ± 0.04 m"; without a band the mean alone."""
        unit = f" {unit}" if unit else ""
        value = f"{factor * self.mean:{form}}"
        if not np.isfinite(self.half_width):
            return value + unit
        return f"{value} ± {abs(factor) * self.half_width:{form}}{unit}"

    def __str__(self) -> str:
        return self.text()


def number(values: npt.ArrayLike) -> Number:
    """Members without a value (NaN) are left out."""
    known = np.asarray(values, dtype=float)
    known = known[np.isfinite(known)]
    if len(known) == 0:
        return Number(np.nan, np.nan, 0)
    bands = of_members(known)
    return Number(float(bands.mean), float(bands.mean_half_width), len(known))


def exceeds(one: Number, other: Number) -> bool | None:
    """Whether one mean lies above another; None where their difference is within its own band, whose half width is
    the root of the sum of both squares. Without bands the means alone decide."""
    difference = one.mean - other.mean
    half = np.hypot(one.half_width, other.half_width)
    if not np.isfinite(difference) or (np.isfinite(half) and abs(difference) <= half):
        return None
    return bool(difference > 0)


def all_hold(answers: Iterable[bool | None]) -> bool | None:
    """True where all are True, False where any is False, else None."""
    known = list(answers)
    if False in known:
        return False
    return None if None in known else True
