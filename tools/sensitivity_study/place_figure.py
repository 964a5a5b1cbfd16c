"""The figure of runs of the whole tunnel: how each trend depends on where the run is read. Thin lines are draws."""

from collections.abc import Callable, Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from voussoir.figures.style import colours, save

from . import fits, places
from .figures import BLUE, GREEN, GREY, ORANGE
from .places import Level
from .runs import AC_HEIGHT, HIGHER, LATE, Measured

WHOLE = 5.0  # where the whole line is drawn, on the axis of distances [D]


def _reactions(axis: Axes, runs: Sequence[Measured]) -> None:
    shown = ((places.CROWN_ELEMENT, "element above the crown", BLUE, "-"),
             (places.PLACES[0].label, "over the whole opening, to 0.1 $D$", ORANGE, "--"),
             (places.PLACES[5].label, "over the whole opening, 0.9 to 1.1 $D$", GREEN, "-."))  # fmt: skip
    for label, text, colour, style in shown:
        for k, run in enumerate(r for r in runs if label in r.reactions):
            axis.plot(100 * run.loss, run.reactions[label], style, color=colour, linewidth=1.1, label="" if k else text)
    axis.set(xlabel="volume loss  $V_l$  [%]", ylabel=r"$\sigma_v / \sigma_{v,0}$  [-]", xlim=(0, 20), ylim=(0, 0.5))
    axis.legend(fontsize=8.5)
    axis.set_title("ground reaction, by the place (cut off at 0.5)")


def _by_height(axis: Axes, runs: Sequence[Measured], number: Callable[[Level], float], colour: str) -> None:
    for run in runs:
        axis.plot([number(v) for v in run.levels.values()], list(run.levels), "o-", color=colour, linewidth=1,
                  markersize=3)  # fmt: skip
    for height, text in ((AC_HEIGHT, "Ac at 2 $D$"), (HIGHER, "$z/C$ = 0.25")):
        axis.axhline(height, color="0.2", linewidth=0.9, linestyle=":")
        axis.annotate(text, (1, height), xycoords=("axes fraction", "data"), xytext=(-3, 2),
                      textcoords="offset points", ha="right", fontsize=9)  # fmt: skip
    axis.set_ylabel("height above the crown [$D$]")


def _fits(axis: Axes, runs: Sequence[Measured]) -> None:
    reaches = sorted(fits.RANGES)
    depths = list(runs[0].fits)
    by_reach = [[fits.of_all_depths(run.result, reach) for run in runs] for reach in reaches]
    for ratio, colour, style in zip(depths, colours("viridis", len(depths)), "osv^D"):
        found = [[f[ratio] for f in group if ratio in f] for group in by_reach]
        share = np.array([100 * np.mean([f.at_bound for f in group]) if group else np.nan for group in found])
        axis.plot([min(r, WHOLE) for r in reaches], share, style + "-", color=colour, label=f"$z/C$ = {ratio:g}")
    axis.set_xticks([1, 2, 3, 4, WHOLE], ["1", "2", "3", "4", "whole"])
    axis.set(xlabel="trough fitted within this distance from the axis [$D$]",
             ylabel=r"fits with $\alpha$ at its bound [%]", title="modified Gauss fits, all $V_l$")  # fmt: skip
    axis.legend(fontsize=8.5, loc="center right")


def draw(runs: Sequence[Measured], path: Path) -> None:
    figure, axes = plt.subplots(2, 2, figsize=(12, 9))
    _reactions(axes[0, 0], runs)
    _fits(axes[0, 1], runs)
    _by_height(axes[1, 0], runs, lambda level: 100 * level.volume.at, BLUE)
    axes[1, 0].axvspan(100 * LATE, 20, color=GREY, alpha=0.2, linewidth=0)
    axes[1, 0].set(
        xlabel="the soil on the axis contracts until $V_l$ [%] (grey: counts as the study's 15 %)", xlim=(0, 20)
    )
    _by_height(axes[1, 1], runs, lambda level: 100 * level.volume.most, ORANGE)
    axes[1, 1].set(xlabel="its largest contraction [%]", xlim=(0, None))
    figure.tight_layout()
    save(figure, path)
