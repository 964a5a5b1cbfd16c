"""Whether a run has states near enough to one another for what is said of it. Each function says why not, or None."""

import numpy as np

# Largest distance in V_l of two states of a path whose minima and peaks are looked for [-]; in a coarser run these fall
# between the states.
RESOLVED = 0.025


def percent(fraction: float) -> str:
    """0.125 -> '12.5 %'"""
    return f"{100 * fraction:.3g} %"


def few_states(loss: np.ndarray, low: float, high: float, least: int) -> str | None:
    """None where the run has at least `least` states with low <= V_l <= high."""
    count = int(np.sum((loss >= low - 1e-9) & (loss <= high + 1e-9)))
    if count >= least:
        return None
    wanted = f"{least} states" if least > 1 else "a state"
    return f"needs {wanted} from V_l = {percent(low)} to {percent(high)}, the run has {count or 'none'} there"


def coarse_path(loss: np.ndarray) -> str | None:
    """None where the states are near enough to one another to show a minimum or a peak of a path."""
    gap = float(np.max(np.diff(loss))) if len(loss) > 1 else float(loss[0])
    if gap <= RESOLVED * (1 + 1e-6):
        return None
    return f"needs a state every {percent(RESOLVED)} of V_l, the run has states {percent(gap)} apart"


def no_states_near(loss: np.ndarray, where: float) -> str | None:
    """None where a value at this V_l can be interpolated: the states beside it are not farther apart than half of the
    V_l, or than 1 % where that is more."""
    after = int(np.searchsorted(loss, where - 1e-9))
    reached = after < len(loss) and (after > 0 or loss[0] <= where + 1e-9)
    if reached and abs(loss[after] - where) < 1e-9:
        return None
    if reached and loss[after] - loss[after - 1] <= max(0.01, 0.5 * where) + 1e-9:
        return None
    return f"the run has no states near V_l = {percent(where)} to interpolate between"
