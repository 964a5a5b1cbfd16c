"""Stresses after gravity: against the weight of the ground above, and the ratio of horizontal to vertical stress."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from . import q8, tensors
from .result import Increment, Missing, Result
from .style import save


def after_gravity(result: Result) -> Increment:
    return result.stage("gravity", "column")[-1]


def far_from_opening(result: Result, points: np.ndarray) -> np.ndarray:
    """True for points farther than D/2 from the opening, and for all points where there is no opening."""
    if "diameter" not in result.geometry:
        return np.ones(points.shape[:-1], dtype=bool)
    axis_depth, diameter, surface_y = result.need("axis_depth", "diameter", "surface_y")
    return np.hypot(points[..., 0], points[..., 1] - (surface_y - axis_depth)) > diameter


def draw(result: Result, path: Path) -> None:
    unit_weight, surcharge, surface_y = result.need("unit_weight", "surcharge", "surface_y")
    increment = after_gravity(result)
    tensor = increment.field("gauss/stress")
    stress = -tensor / 1e3  # [kPa], compression positive
    points = q8.gauss_coordinates(result.coordinates, result.connectivity)
    depth = surface_y - points[..., 1]
    far = far_from_opening(result, points)
    weight = (unit_weight * depth + surcharge) / 1e3
    figure, axes = plt.subplots(2, 2, figsize=(12.5, 10))
    _draw_vertical(axes[0, 0], depth, stress[..., 1], far, weight)
    _draw_ratio(axes[0, 1], stress, far)
    _draw_fit(axes[0, 1], result)
    _draw_rows(axes[1, 0], result, unit_weight, surcharge)
    _draw_deflection(axes[1, 1], stress[..., 1], tensors.major_from_vertical(tensor), far)
    worst = np.max(np.abs(stress[..., 1] - weight)[far] / (0.05 * weight[far] + 1))
    if not far.all():
        for axis in axes[:, 1]:
            axis.set_title("away from the opening")
    figure.suptitle(
        f"After gravity: $\\gamma$ = {unit_weight / 1e3:g} kN/m³, surcharge {surcharge / 1e3:g} kPa; "
        f"single points depart by up to {worst:.2f} times 5 % + 1 kPa",
        fontsize=12,
    )
    figure.tight_layout()
    save(figure, path)


def _draw_vertical(axis: Axes, depth: np.ndarray, vertical: np.ndarray, far: np.ndarray, weight: np.ndarray) -> None:
    order = np.argsort(depth, axis=None)
    line_depth, line = depth.ravel()[order], weight.ravel()[order]
    axis.fill_betweenx(line_depth, 0.95 * line - 1, 1.05 * line + 1, color="0.85", label="± (5 % + 1 kPa)")
    axis.plot(line, line_depth, color="black", linewidth=1.2, label=r"$\gamma z$ + surcharge")
    axis.plot(vertical[far], depth[far], ".", color="C0", markersize=4, label="Gauss points")
    if not far.all():
        axis.plot(vertical[~far], depth[~far], ".", color="C1", markersize=4, label="within $D/2$ of the opening")
    axis.invert_yaxis()
    axis.set_xlim(left=0)
    axis.set_xlabel(r"vertical stress  $\sigma_{yy}$  [kPa]")
    axis.set_ylabel("depth  $z$  [m]")
    axis.legend()


def _draw_ratio(axis: Axes, stress: np.ndarray, far: np.ndarray) -> None:
    vertical, horizontal = stress[..., 1], stress[..., 0]
    good = far & (vertical > 0)
    if not good.any():
        raise Missing("no point is compressed vertically")
    axis.semilogx(
        vertical[good], horizontal[good] / vertical[good], ".", color="C0", markersize=4, label="Gauss points"
    )
    plain_ticks(axis, vertical[good])
    low, high = axis.get_ylim()
    axis.set_ylim(min(0.2, low), max(1.1, high))
    axis.set_xlabel(r"vertical stress  $\sigma_{yy}$  [kPa]")
    axis.set_ylabel(r"$K_0 = \sigma_{xx} / \sigma_{yy}$  [-]")


def plain_ticks(axis: Axes, values: np.ndarray) -> None:
    """1, 2, 5, ... on a logarithmic axis of stresses [kPa]."""
    ticks = np.array([1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000])
    shown = ticks[(ticks >= 0.45 * values.min()) & (ticks <= 2.2 * values.max())]
    if len(shown) > 1:
        axis.set_xlim(min(shown[0], 0.9 * values.min()), max(shown[-1], 1.1 * values.max()))
    axis.set_xticks(shown, [str(t) for t in shown])
    axis.minorticks_off()


def _draw_fit(axis: Axes, result: Result) -> None:
    """K0 of the column, with which the opening was held."""
    if "k0" not in result.tables:
        return
    k0 = result.tables["k0"]
    # The line is straight between knots; the program itself uses a monotone cubic through them.
    axis.plot(k0["vertical_stress"] / 1e3, k0["ratio"], "-", color="black", linewidth=1, label="fitted to the column")
    axis.legend()


def _draw_rows(axis: Axes, result: Result, unit_weight: float, surcharge: float) -> None:
    """Mean errors of level rows with their standard deviation, as the program found them."""
    if "geostatic_rows" not in result.tables:
        axis.text(0.5, 0.5, "run.h5 has no table geostatic_rows", transform=axis.transAxes, ha="center")
        axis.set_axis_off()
        return
    axis.set_xlabel(r"$\sigma_{yy} - (\gamma z +$ surcharge$)$  [kPa]")
    axis.set_ylabel("depth  $z$  [m]")
    axis.set_title("level rows: mean and standard deviation")
    rows = result.tables["geostatic_rows"]
    allowed = (0.02 * (unit_weight * rows["depth"] + surcharge) + 0.5e3) / 1e3
    axis.fill_betweenx(rows["depth"], -allowed, allowed, color="0.85", label="± (2 % + 0.5 kPa), of the mean")
    axis.errorbar(
        rows["error"] / 1e3,
        rows["depth"],
        xerr=rows["scatter"] / 1e3,
        fmt="o",
        color="C0",
        markersize=4,
        linewidth=1,
        capsize=2,
    )
    axis.axvline(0, color="black", linewidth=1)
    axis.invert_yaxis()
    axis.legend(loc="upper right")


def _draw_deflection(axis: Axes, vertical: np.ndarray, angle: np.ndarray, far: np.ndarray) -> None:
    good = far & (vertical > 0)
    axis.semilogx(vertical[good], np.degrees(angle[good]), ".", color="C0", markersize=4)
    axis.plot([100, 100], [-1, 1], color="0.4", linewidth=1)
    for limit in (-1, 1):
        axis.plot(
            [100, max(200, vertical[good].max())],
            [limit, limit],
            color="0.4",
            linewidth=1,
            label="1° from 100 kPa on" if limit > 0 else None,
        )
    plain_ticks(axis, vertical[good])
    axis.set_xlabel(r"vertical stress  $\sigma_{yy}$  [kPa]")
    axis.set_ylabel("principal axis from the vertical  [deg]")
    axis.legend()
