"""A drained biaxial test as a boundary-value problem (kind `biaxial_bvp`): load and displacement of the top platen,
stress ratio and volume change, beside the spread of the Gauss points."""

from collections.abc import Mapping
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from .result import Missing, Result
from .style import save

OF_POINTS = (5, 95)  # percentiles between which the Gauss points are shown


def draw(result: Result, path: Path) -> None:
    increments = [i for i in result.increments if i["stage"] == "biaxial_bvp"]
    if len(increments) < 2:
        raise Missing("the specimen has fewer than two increments")
    (height,) = result.need("height")
    column = {
        name: np.array([float(i[name]) for i in increments])
        for name in ("load_parameter", "axial_strain", "volumetric_strain", "axial_force", "q_over_p")
    }
    good = np.array([float(i["converged"]) for i in increments]) > 0
    figure, (load, ratio, volume) = plt.subplots(1, 3, figsize=(16, 4.9))
    moved, force = 1e3 * height * column["load_parameter"], column["axial_force"] / 1e3
    load.plot(moved, force, color="C0")
    if not good.all():
        load.plot(moved[~good], force[~good], "x", color="C3", label="not converged")
    most = int(np.argmax(force))
    said = f"largest {force[most]:.4g} kN/m at {moved[most]:.3g} mm"
    load.plot(moved[most], force[most], "^", color="C3", label=said)
    load.set_xlabel("settlement of the top platen  [mm]")
    load.set_ylabel("axial force  [kN per m of thickness]")
    load.set_ylim(bottom=0)
    strain = 100 * column["axial_strain"]
    _draw_points(ratio, result, strain, column["load_parameter"], "q_over_p", 1.0)
    ratio.plot(strain, column["q_over_p"], color="C0", label="of the mean stress")
    ratio.set_ylim(bottom=0)
    ratio.set_ylabel("stress ratio  $q/p$  [-]")
    _draw_points(volume, result, strain, column["load_parameter"], "volumetric_strain", 100.0)
    volume.plot(strain, 100 * column["volumetric_strain"], color="C0", label="of the specimen")
    volume.axhline(0, color="0.4", linewidth=0.8)
    volume.set_ylabel(r"$\varepsilon_v$, contraction positive  [%]")
    for axis in (ratio, volume):
        axis.set_xlabel(r"axial strain  $\varepsilon_a$  [%]")
    for axis in (load, ratio, volume):
        axis.set_xlim(left=0)
        axis.legend()
    pressure = result.case.get("biaxial_bvp", {}).get("pressure", "")
    figure.suptitle(f"Biaxial specimen of {len(result.connectivity)} elements, lateral stress {pressure}", fontsize=12)
    figure.tight_layout()
    save(figure, path)


def _draw_points(axis: Axes, result: Result, strain: np.ndarray, load: np.ndarray, name: str, factor: float) -> None:
    """The range of the Gauss points, where the run wrote their histories."""
    table: Mapping[str, np.ndarray] = result.tables.get("gauss_histories", {})
    wanted = ("p", "q") if name == "q_over_p" else (name,)
    if "load_parameter" not in table or any(column not in table for column in wanted):
        return
    p = table.get("p", np.ones(1))
    with np.errstate(divide="ignore", invalid="ignore"):
        values = np.where(p > 0, table["q"] / p, np.nan) if name == "q_over_p" else table[name]
    low, high, shown = [], [], []
    for at, here in zip(strain, load):
        there = values[np.abs(table["load_parameter"] - here) < 1e-9]
        there = factor * there[np.isfinite(there)]
        if len(there):
            shown.append(at)
            low.append(np.percentile(there, OF_POINTS[0]))
            high.append(np.percentile(there, OF_POINTS[1]))
    if len(shown) > 1:
        label = f"{OF_POINTS[0]} to {OF_POINTS[1]} % of the Gauss points"
        axis.fill_between(shown, low, high, color="C5", alpha=0.35, linewidth=0, label=label)
