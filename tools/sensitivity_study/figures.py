"""Figures of the variations: what moves each trend, beside the scatter of draws."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from voussoir.figures.resolution import running_means
from voussoir.figures.style import CYCLE, save

from . import fits, places
from .runs import LATE, Measured, Variation
from .strength import Strength

BLUE, ORANGE, GREEN, GREY = CYCLE[0], CYCLE[3], CYCLE[2], "0.45"
# The variations whose curves are drawn, with their labels.
SHOWN = {
    "beta_1": ("$\\beta$ = 1 (Table 1 read literally)", CYCLE[3], "-"),
    "thickness_0_05": ("t = 0.05 m", CYCLE[1], "--"),
    "base": ("base: $\\beta$ = 0.1, t = 0.1 m", CYCLE[6], "-"),
    "thickness_0_2": ("t = 0.2 m", CYCLE[5], "--"),
    "friction_20": ("friction 20°", CYCLE[0], "-."),
    "consolidation_0_45": ("medium dense packing", CYCLE[4], ":"),
}


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
    axes[2].axvspan(100 * LATE, 20, color=GREY, alpha=0.2, linewidth=0)
    axes[2].set_xlabel("Ac contracts until $V_l$ [%]\n(grey: counts as the study's 15 %)")
    _dots(axes[3], rows, lambda run: 100 * fits.share_at_bound(run.fits), GREEN)
    axes[3].set_xlabel("fits with $\\alpha$ at its bound,\nall depths [%]")
    figure.suptitle("One setting changed at a time (circles: draws, bars: means, bands: draws of the first line)")
    figure.tight_layout()
    save(figure, path)


def _curves(axis: Axes, rows: Sequence[Variation], label: str) -> None:
    """Running means of the ground reaction at one place, one line a draw."""
    for v in rows:
        if v.name not in SHOWN:
            continue
        text, colour, style = SHOWN[v.name]
        drawn = [run for run in v.runs if label in run.reactions]
        for k, run in enumerate(drawn):
            means = running_means(run.loss, run.reactions[label])
            axis.plot(100 * means[0], means[1], style, color=colour, linewidth=1.5, label="" if k else text)
    axis.set(xlabel="volume loss  $V_l$  [%]", ylabel=r"$\sigma_v / \sigma_{v,0}$  [-]", xlim=(0, 20))


def reaction(rows: Sequence[Variation], strengths: Mapping[str, Strength], path: Path) -> None:
    """Ground reaction curves of some variations, and the recovery against the strength of each soil."""
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(15, 4.8))
    _curves(left, rows, places.CROWN_ELEMENT)
    left.set(ylim=(0, 0.25), title="element above the crown")
    left.legend(fontsize=8.5)
    _curves(middle, rows, places.PLACES[0].label)
    middle.set(ylim=(0, 0.4), title="over the whole opening, to 0.1 $D$ above")
    for v in rows:
        if v.name not in strengths:
            continue
        soil, found = strengths[v.name], [run.opening.factor for run in v.runs if run.opening]
        if not found:
            continue
        y, x = float(np.mean(found)), np.degrees(soil.peak)
        right.errorbar(x, y, yerr=[[y - min(found)], [max(found) - y]], xerr=np.degrees(soil.peak_error), fmt="o",
                       color=BLUE, capsize=2, linewidth=1)  # fmt: skip
        right.annotate(v.name, (x, y), xytext=(5, 5), textcoords="offset points", fontsize=8)
    right.axhline(1, color=GREY, linewidth=1)
    right.margins(x=0.2)  # room for the names
    right.set(xlabel=r"peak friction angle at 20 kPa [°]", ylabel="end over minimum over the whole opening [-]",
              title="recovery against strength (bars: draws, errors)")  # fmt: skip
    figure.tight_layout()
    save(figure, path)
