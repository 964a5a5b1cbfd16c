"""Ground reaction curve: vertical stress just above the crown against the volume loss."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from . import points
from .paths import COLOURS
from .points import crown_elements
from .resolution import percent
from .result import Missing, Result
from .style import save


def curve(result: Result) -> tuple[np.ndarray, np.ndarray, float]:
    """V_l [-], vertical stress of the crown's element over its value before the loss [-], and that value [Pa].

    The stress is the mean of the element's four points, compression positive.
    """
    _ = result.start  # raises where the stress before the loss was not written
    stress = -result.loss_history("gauss/stress")[:, crown_elements(result)][..., 1].mean(axis=(1, 2))
    if not stress[0] > 0:
        raise Missing("the crown is not compressed before the volume loss")
    return result.volume_loss, stress / stress[0], stress[0]


def draw(result: Result, path: Path) -> None:
    loss, ratio, start = curve(result)
    least = int(np.argmin(ratio))
    figure, axis = plt.subplots(figsize=(6.6, 4.6))
    axis.plot(100 * loss, ratio, "o-", color="C0", markersize=3)
    axis.plot(
        100 * loss[least],
        ratio[least],
        "v",
        color="C3",
        markersize=8,
        label=f"minimum {ratio[least]:.3f} at $V_l$ = {percent(loss[least])}",
    )
    shown = [ratio]
    for point in points.above_crown(result):
        vertical = -points.history(result, "gauss/stress", point)[:, 1]
        if not vertical[0] > 0:
            continue
        shown.append(vertical / vertical[0])
        axis.plot(
            100 * loss,
            shown[-1],
            "--",
            linewidth=0.9,
            color=COLOURS[point.name],
            label=f"at {points.describe(result, point)}",
        )
    axis.plot([], [], " ", label=f"end {ratio[-1]:.3f} at $V_l$ = {percent(loss[-1])}")
    axis.legend(fontsize=8)
    axis.set_xlabel("volume loss  $V_l$  [%]")
    axis.set_ylabel(r"vertical stress above the crown  $\sigma_v / \sigma_{v,0}$  [-]")
    axis.set_xlim(left=0)
    axis.set_ylim(min(0, 1.05 * np.min(shown)), 1.05 * max(1, np.max(shown)))
    axis.set_title(rf"Ground reaction curve,  $\sigma_{{v,0}}$ = {start / 1e3:.4g} kPa")
    save(figure, path)
