"""Whether a run has states near enough to one another for what is said of it. Each function says why not, or None."""

import numpy as np

# Largest distance in V_l of two states of a path whose minima and peaks are looked for [-]; in a coarser run these fall
# between the states.
RESOLVED = 0.025

WINDOW = 0.02  # width in V_l of running means [-]; single states of few points scatter by 10 % from one to the next


def running_means(loss: np.ndarray, values: np.ndarray, window: float = WINDOW) -> tuple[np.ndarray, np.ndarray]:
    """Means over all states of a window of V_l, and the middles of the windows; only windows that lie within the
    path."""
    first = [v for v in loss if v + window <= loss[-1] + 1e-9]
    inside = [(loss >= v - 1e-9) & (loss <= v + window + 1e-9) for v in first]
    return np.array(first) + window / 2, np.array([values[i].mean() for i in inside])


def recovery_factor(loss: np.ndarray, ratio: np.ndarray) -> float:
    """The end of a ground reaction curve over its minimum, of running means, because the least single state of a curve
    that scatters lies below its level by chance [-]. It is 1 where the curve falls to its end, or is shorter than the
    window."""
    _, means = running_means(loss, ratio)
    return float(means[-1] / means.min()) if len(means) and means.min() > 0 else 1.0


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
