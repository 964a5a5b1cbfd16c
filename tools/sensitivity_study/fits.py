"""How the share of modified Gauss fits whose alpha lies at its bound depends on the depth and on how far from the axis
the trough is fitted."""

from dataclasses import dataclass
from functools import partial

import numpy as np
from voussoir.figures import trough_fit, troughs
from voussoir.figures.result import Result, remembered

WHOLE = float("inf")
RANGES = (WHOLE, 4.0, 3.0, 2.0, 1.0)  # of the distance from the axis, in D
LEAST_POINTS = 6  # of a trough that is fitted


@dataclass(frozen=True)
class Fits:
    """Fits of one depth at all volume losses, each within some distance from the axis."""

    at_bound: float  # share [-]
    misfit: float  # the largest rms misfit over S_max [-]
    mean_misfit: float
    alpha: float  # median


def of_depth(result: Result, ratio: float, reach: float = WHOLE) -> Fits | None:
    """Fits of the troughs at z/C = ratio, within `reach` times D of the axis; None where too few points lie there."""
    (diameter,) = result.need("diameter")
    line = troughs.line_at(result, ratio)
    inside = line.x <= reach * diameter * (1 + 1e-9)
    if inside.sum() < LEAST_POINTS:
        return None
    if reach == WHOLE:
        fits = [t.fit for (z, _), t in troughs.all_troughs(result).items() if z == ratio]
    else:
        states = [i for i in result.loss_increments if i["volume_loss"] > 0]
        fits = [trough_fit.fit(line.x[inside], line.settlement(i)[inside]) for i in states]
    misfits = np.array([fit.misfit for fit in fits])
    return Fits(
        float(np.mean([fit.at_bound for fit in fits])),
        float(misfits.max()),
        float(misfits.mean()),
        float(np.median([fit.alpha for fit in fits])),
    )


def of_all_depths(result: Result, reach: float = WHOLE) -> dict[float, Fits]:
    """{z/C: fits}"""
    found = {
        ratio: remembered(result, f"fits at {ratio} within {reach}", partial(of_depth, result, ratio, reach))
        for ratio in result.settings.depths
    }
    return {ratio: fits for ratio, fits in found.items() if fits is not None}


def share_at_bound(fits: dict[float, Fits]) -> float:
    """Of all depths and losses, as the table of trends counts."""
    return float(np.mean([f.at_bound for f in fits.values()]))
