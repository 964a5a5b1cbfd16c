"""K0 of a column against the vertical stress, as it was measured and as it was fitted."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from .result import Missing, Result
from .stresses import plain_ticks
from .style import save


def draw(result: Result, path: Path) -> None:
    rows, fit = result.tables.get("column_rows"), result.tables.get("k0")
    if rows is None and fit is None:
        raise Missing("run.h5 has neither a table column_rows nor k0")
    figure, axis = plt.subplots(figsize=(7.2, 4.8))
    shown = []
    if rows is not None:
        stress = rows["vertical_stress"] / 1e3
        axis.plot(stress, rows["ratio"], "o", color="C0", markersize=4, label="rows of Gauss points at full weight")
        shown.append(stress)
    if fit is not None:
        stress = fit["vertical_stress"] / 1e3
        axis.plot(stress, fit["ratio"], "-", color="black", linewidth=1.2, label="fitted (here straight between knots)")
        shown.append(stress)
    positive = np.concatenate(shown)
    positive = positive[positive > 0]
    if not len(positive):
        raise Missing("no row is compressed vertically")
    axis.set_xscale("log")
    plain_ticks(axis, positive)
    axis.set_xlabel(r"vertical stress  $\sigma_{yy}$  [kPa]")
    axis.set_ylabel(r"$K_0 = \sigma_{xx} / \sigma_{yy}$  [-]")
    axis.set_ylim(0, max(1.05, axis.get_ylim()[1]))
    axis.set_title("Earth pressure at rest")
    axis.legend()
    save(figure, path)
