"""Two pictures: what the search reached around Table 2, and the nine numbers of the sets at full size."""

from collections.abc import Iterable, Mapping
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm
from voussoir.figures.style import CYCLE, save, use_style

from .fit import Measured
from .plan import ANGLES, BOX, SOILS, TARGETS, from_unit
from .report import NAMES, SYMBOLS, ByName

COLOURS = dict(zip(SOILS, CYCLE))
MARKERS = dict(zip(SOILS, "os^"))


def reached(usual: Measured, smooth: Measured, packings: int, path: Path) -> None:
    """The sets of the search: phi_p - phi_cs and psi_max against phi_p, psi_max also as read from smooth curves,
    coloured by thickness. The cross is Table 2, its arms are the scatter of a single packing."""
    use_style()
    figure, axes = plt.subplots(3, 3, figsize=(11.5, 8.6), sharex="col", layout="constrained")
    for column, soil in enumerate(SOILS):
        thickness = [from_unit(unit)[2] for unit in usual.units[soil]]
        peak, critical, dilatancy = (usual.values[soil, kind] for kind in ANGLES)
        wanted = TARGETS[soil]
        scatter = [usual.packing_deviation((soil, kind), packings) for kind in ANGLES]
        smooth_scatter = smooth.packing_deviation((soil, "dilatancy"), packings)
        rows = (
            (peak - critical, wanted[0] - wanted[1], float(np.hypot(scatter[0], scatter[1]))),
            (dilatancy, wanted[2], scatter[2]),
            (smooth.values[soil, "dilatancy"], wanted[2], smooth_scatter),
        )
        for axis, (y, target, arm) in zip(axes[:, column], rows, strict=True):
            points = axis.scatter(peak, y, c=thickness, norm=LogNorm(*BOX["thickness"]), cmap="viridis", s=36,
                                  marker=MARKERS[soil], edgecolors="0.3", linewidths=0.4)  # fmt: skip
            axis.errorbar(wanted[0], target, xerr=scatter[0], yerr=arm, color=CYCLE[3], lw=2, capsize=4, zorder=5)
        axes[0, column].set_title(NAMES[soil])
        axes[2, column].set_xlabel("peak angle φ_p [°]")
    for axis, label in zip(axes[:, 0], ("φ_p less φ_cs [°]", "ψ_max, each test, 2 % [°]", "ψ_max, averages, 4 % [°]")):
        axis.set_ylabel(label)
    bar = figure.colorbar(points, ax=axes, label="thickness t [m]", shrink=0.7)
    bar.set_ticks([0.02, 0.05, 0.1, 0.2, 0.4], labels=["0.02", "0.05", "0.1", "0.2", "0.4"])
    save(figure, path)


def nine_numbers(results: ByName, choice: Mapping[str, str], path: Path) -> None:
    """Each set's numbers with standard errors, beside lines at Table 2."""
    use_style()
    names = list(results)
    figure, axes = plt.subplots(1, 3, figsize=(11.5, 1.6 + 0.5 * len(names)), sharey=True, layout="constrained")
    for k, (axis, kind) in enumerate(zip(axes, ANGLES, strict=True)):
        for shift, soil in zip((-0.2, 0.0, 0.2), SOILS, strict=True):
            axis.axvline(TARGETS[soil][k], color=COLOURS[soil], ls="--", lw=1.2)
            rows = [(y + shift, results[name][soil][kind][choice[kind]]) for y, name in enumerate(names)
                    if soil in results[name]]  # fmt: skip
            axis.errorbar([v.mean for _, v in rows], [y for y, _ in rows], xerr=[v.error for _, v in rows], ls="none",
                          marker=MARKERS[soil], color=COLOURS[soil], capsize=3, label=NAMES[soil])  # fmt: skip
        axis.set_xlabel(f"{SYMBOLS[kind]} [°]")
    axes[0].set_yticks(range(len(names)), labels=_labels(names))
    axes[0].invert_yaxis()
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    save(figure, path)


def _labels(names: Iterable[str]) -> list[str]:
    return [name.replace("_", " ") for name in names]
