"""The figures: what moves each trend, beside the scatter of draws, and how it depends on where the run is read."""

from collections.abc import Callable, Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from voussoir_plots.style import save

from . import fits, places
from .runs import LATE, Measured, Variation

BLUE, ORANGE, GREEN, GREY = "#0072B2", "#D55E00", "#009E73", "0.45"  # of the set of Okabe and Ito


def _dots(axis: Axes, rows: Sequence[Variation], number: Callable[[Measured], float], colour: str) -> None:
    """One dot a draw, a line a variation; the band is the range of the draws of the first one."""
    values = [[number(run) for run in v.runs] for v in rows]
    axis.axvspan(min(values[0]), max(values[0]), color=colour, alpha=0.15, linewidth=0)
    for y, found in enumerate(values):
        axis.plot(found, [y] * len(found), "o", color=colour, markersize=5, markerfacecolor="none")
        axis.plot(np.mean(found), y, "|", color=colour, markersize=12, markeredgewidth=2)
    axis.set_yticks(range(len(rows)), [v.name for v in rows])
    axis.set_ylim(len(rows) - 0.5, -0.5)


def variations(rows: Sequence[Variation], path: Path) -> None:
    figure, axes = plt.subplots(1, 4, figsize=(15, 0.32 * len(rows) + 2.0), sharey=True)
    _dots(axes[0], rows, lambda run: run.crown.factor, BLUE)
    axes[0].axvline(1, color=GREY, linewidth=1)
    axes[0].set_xlabel("ground reaction: end over minimum,\nrunning means [-]")
    _dots(axes[1], rows, lambda run: 100 * run.ac.most, ORANGE)
    axes[1].set_xlabel("Ac, 2 $D$ above the crown:\nlargest contraction [%]")
    _dots(axes[2], rows, lambda run: 100 * run.ac.at, ORANGE)
    axes[2].axvspan(100 * LATE, 15, color=GREY, alpha=0.25, linewidth=0)
    axes[2].set_xlabel("Ac contracts until $V_l$ [%]\n(grey: the study, within 3 %)")
    _dots(axes[3], rows, lambda run: 100 * fits.share_at_bound(run.fits), GREEN)
    axes[3].set_xlabel("fits with $\\alpha$ at its bound,\nall depths [%]")
    figure.suptitle("One setting changed at a time (circles: draws, bars: means, bands: draws of the first line)")
    figure.tight_layout()
    save(figure, path)


def where_it_is_read(runs: Sequence[Measured], path: Path) -> None:
    """Thin lines are draws."""
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(15, 4.8))
    shown = ((places.CROWN_ELEMENT, "element above the crown", BLUE, "-"),
             (places.PLACES[0].label, "over the whole opening, to 0.1 $D$", ORANGE, "--"),
             (places.PLACES[5].label, "over the whole opening, 0.9–1.1 $D$", GREEN, "-."))  # fmt: skip
    for label, text, colour, style in shown:
        for k, run in enumerate(r for r in runs if label in r.reactions):
            left.plot(100 * run.loss, run.reactions[label], style, color=colour, linewidth=1.1, label="" if k else text)
    left.set(xlabel="volume loss  $V_l$  [%]", ylabel=r"$\sigma_v / \sigma_{v,0}$  [-]", xlim=(0, 20), ylim=(0, 0.5))
    left.legend(fontsize=8.5)
    left.set_title("ground reaction (cut off at 0.5)")
    for k, run in enumerate(runs):
        heights = list(run.levels)
        until, most = ([100 * getattr(level.volume, what) for level in run.levels.values()] for what in ("at", "most"))
        middle.plot(until, heights, "o-", color=BLUE, linewidth=1, markersize=3.5, label="" if k else "until $V_l$ [%]")
        middle.plot(100 * np.array(most), heights, "s--", color=ORANGE, linewidth=1, markersize=3,
                    label="" if k else "largest contraction [0.01 %]")  # fmt: skip
    middle.axvspan(100 * LATE, 15, color=GREY, alpha=0.25, linewidth=0, label="the study's Ac, within 3 %")
    middle.axhline(2, color="0.2", linewidth=0.9, linestyle=":")
    middle.annotate("Ac of the tools", (19.5, 2.03), ha="right", fontsize=9)
    middle.set(xlabel="$V_l$ [%]; contraction [0.01 %]", ylabel="height above the crown [$D$]", xlim=(0, 23))
    middle.set_title("how long the soil on the axis contracts")
    middle.legend(fontsize=8.5, loc="lower right")
    for ratio, colour, style in zip(runs[0].fits, plt.get_cmap("viridis")(np.linspace(0, 0.87, 5)), "osv^D"):
        reaches = [r for r in fits.RANGES if r != fits.WHOLE]
        found = [[f for run in runs if (f := fits.of_depth(run.result, ratio, r))] for r in reaches]
        share = [100 * np.mean([f.at_bound for f in group]) if group else np.nan for group in found]
        whole = 100 * np.mean([run.fits[ratio].at_bound for run in runs])
        right.plot([*reaches, 7], [*share, whole], style + "-", color=colour, label=f"$z/C$ = {ratio:g}")
    right.set_xticks([1, 2, 3, 4, 7], ["1", "2", "3", "4", "7 (whole)"])
    right.set(xlabel="trough fitted within this distance from the axis [$D$]",
              ylabel=r"fits with $\alpha$ at its bound [%]")  # fmt: skip
    right.legend(fontsize=8.5)
    right.set_title("modified Gauss fits, all $V_l$")
    figure.tight_layout()
    save(figure, path)
