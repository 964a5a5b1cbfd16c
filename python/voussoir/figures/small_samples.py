"""Statistics of a few samples, without further packages: standard errors, the coefficient of variation and its
interval."""

import math
from collections.abc import Callable, Sequence

import numpy as np


def standard_error(values: np.ndarray) -> float:
    """Of the mean; not a number for a single value."""
    return float(np.std(values, ddof=1) / math.sqrt(len(values))) if len(values) > 1 else math.nan


def jackknife(groups: Sequence[np.ndarray], estimate: Callable[[np.ndarray], float]) -> tuple[float, float]:
    """An estimate over all rows of all groups and its standard error, by leaving out one group at a time. For a mean of
    groups of one value this is the standard error of the mean."""
    whole = estimate(np.concatenate(groups))
    n = len(groups)
    if n < 2:
        return whole, math.nan
    return whole, jackknife_error([estimate(np.concatenate([*groups[:k], *groups[k + 1 :]])) for k in range(n)])


def jackknife_error(without: Sequence[float]) -> float:
    """The standard error of an estimate from its values without one group each."""
    n = len(without)
    return float(math.sqrt((n - 1) / n * np.sum((np.array(without) - np.mean(without)) ** 2)))


def variation(values: np.ndarray) -> float:
    """Coefficient of variation s / mean, with n - 1 (the study's eqs. A1 to A3)."""
    return float(np.std(values, ddof=1) / np.mean(values))


def variation_interval(cov: float, n: int, confidence: float = 0.95) -> tuple[float, float]:
    """Interval of the coefficient of variation of a normal population from that of n samples (Vangel 1996, the modified
    method of McKay). It is exact to about 1 % of the confidence for coefficients below 1/3."""
    nu = n - 1
    limits = []
    for share in ((1 + confidence) / 2, (1 - confidence) / 2):
        u = chi_square_quantile(share, nu)
        below = ((u + 2) / n - 1) * cov**2 + u / nu
        limits.append(cov / math.sqrt(below) if below > 0 else math.inf)
    return limits[0], limits[1]


def chi_square(x: float, nu: int) -> float:
    """Probability that chi-square of nu degrees of freedom is at most x."""
    if x <= 0:
        return 0.0
    half = x / 2
    if nu % 2 == 0:
        term = total = 1.0
        for k in range(1, nu // 2):
            term *= half / k
            total += term
        return 1 - math.exp(-half) * total
    below = math.erf(math.sqrt(half))
    term = math.exp(-half) * math.sqrt(half) / math.gamma(1.5)
    for k in range(1, (nu + 1) // 2):
        below -= term
        term *= half / (k + 0.5)
    return below


def chi_square_quantile(probability: float, nu: int) -> float:
    """The x that chi-square of nu degrees of freedom does not exceed with this probability, by bisection."""
    low, high = 0.0, 1.0
    while chi_square(high, nu) < probability:
        high *= 2
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if chi_square(middle, nu) < probability else (low, middle)
    return (low + high) / 2
