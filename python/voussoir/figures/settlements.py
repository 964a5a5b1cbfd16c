"""Settlement above the crown against the volume loss, at the surface and below it."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from . import troughs
from .result import Result
from .style import colours, save


def on_axis(result: Result, ratio: float) -> np.ndarray:
    """Settlement at x = 0 and z/C = ratio over the volume loss [m]."""
    line = troughs.line_at(result, ratio)
    return np.array([line.settlement(i)[line.on_axis] for i in result.loss_increments])


def growth(loss: np.ndarray, settlement: np.ndarray, window: float = 0.01) -> np.ndarray:
    """dS/dV_l at each V_l, the slope of a straight line through the points within `window` [-] on either side [m]."""
    slopes = []
    for v in loss:
        near = np.abs(loss - v) <= window * (1 + 1e-9)
        slopes.append(np.polyfit(loss[near], settlement[near], 1)[0] if near.sum() > 1 else np.nan)
    return np.array(slopes)


def draw(result: Result, path: Path) -> None:
    (diameter,) = result.need("diameter")
    loss = result.volume_loss
    figure, (left, right) = plt.subplots(1, 2, figsize=(11.5, 4.6))
    depths = result.settings.depths
    for ratio, colour in zip(depths, colours("cividis", len(depths))):
        settlement = on_axis(result, ratio)
        label = f"{ratio:g}" + ("  (surface)" if ratio == 0 else "  (crown)" if ratio == 1 else "")
        left.plot(100 * loss, 1e3 * settlement, "o-", markersize=2.5, color=colour, label=label)
        right.plot(100 * loss, growth(loss, settlement) / diameter, color=colour, label=label)
    left.set_ylabel("settlement at $x$ = 0  [mm]")
    left.legend(title="$z/C$")
    right.set_ylabel(r"growth  $\mathrm{d}S/\mathrm{d}V_l$ / $D$  [-]")
    right.set_ylim(bottom=min(0, right.get_ylim()[0]))
    for axis in (left, right):
        axis.set_xlabel("volume loss  $V_l$  [%]")
        axis.set_xlim(left=0)
    right.set_title(r"slope over $V_l$ ± 1 %", fontsize=11)
    figure.suptitle(
        f"Settlement above the crown, $C/D$ = {result.cover / diameter:.2g}, $D$ = {diameter:g} m", fontsize=12
    )
    figure.tight_layout()
    save(figure, path)
