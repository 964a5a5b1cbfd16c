"""Stresses after gravity: against the weight of the ground above, and the ratio of horizontal to vertical stress."""

import matplotlib.pyplot as plt
import numpy as np

from . import q8
from .result import Missing
from .style import save


def after_gravity(result):
    return result.stage("gravity", "column")[-1]


def far_from_opening(result, points):
    """True farther than D/2 from the opening; everywhere where there is none."""
    if "diameter" not in result.geometry:
        return np.ones(points.shape[:-1], dtype=bool)
    axis_depth, diameter, surface_y = result.need("axis_depth", "diameter", "surface_y")
    return np.hypot(points[..., 0], points[..., 1] - (surface_y - axis_depth)) > diameter


def draw(result, path):
    unit_weight, surcharge, surface_y = result.need("unit_weight", "surcharge", "surface_y")
    increment = after_gravity(result)
    stress = -increment.field("gauss/stress") / 1e3  # [kPa], compression positive
    points = q8.gauss_coordinates(result.coordinates, result.connectivity)
    depth = surface_y - points[..., 1]
    far = far_from_opening(result, points)
    weight = (unit_weight * depth + surcharge) / 1e3
    figure, (left, right) = plt.subplots(1, 2, figsize=(11.5, 5.2))
    _draw_vertical(left, depth, stress[..., 1], far, weight)
    _draw_ratio(right, stress, far)
    _draw_fit(right, result)
    worst = np.max(np.abs(stress[..., 1] - weight)[far] / (0.05 * weight[far] + 1))
    figure.suptitle(f"After gravity: $\\gamma$ = {unit_weight / 1e3:g} kN/m³, surcharge {surcharge / 1e3:g} kPa; "
                    f"largest departure {worst:.2f} of the allowed 5 % + 1 kPa", fontsize=12)
    figure.tight_layout()
    save(figure, path)


def _draw_vertical(axis, depth, vertical, far, weight):
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


def _draw_ratio(axis, stress, far):
    vertical, horizontal = stress[..., 1], stress[..., 0]
    good = far & (vertical > 0)
    if not good.any():
        raise Missing("no point is compressed vertically")
    axis.semilogx(vertical[good], horizontal[good] / vertical[good], ".", color="C0", markersize=4, label="Gauss points")
    ticks = np.array([1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000])
    shown = ticks[(ticks >= 0.45 * vertical[good].min()) & (ticks <= 2.2 * vertical[good].max())]
    if len(shown) > 1:
        axis.set_xlim(min(shown[0], 0.9 * vertical[good].min()), max(shown[-1], 1.1 * vertical[good].max()))
    axis.set_xticks(shown, [str(t) for t in shown])
    axis.minorticks_off()
    low, high = axis.get_ylim()
    axis.set_ylim(min(0.2, low), max(1.1, high))
    axis.set_xlabel(r"vertical stress  $\sigma_{yy}$  [kPa]")
    axis.set_ylabel(r"$K_0 = \sigma_{xx} / \sigma_{yy}$  [-]")
    axis.set_title("away from the opening")


def _draw_fit(axis, result):
    """K0 of the column, with which the opening was held."""
    if "k0" not in result.tables:
        return
    k0 = result.tables["k0"]
    # Straight between knots; the program's own curve is a monotone cubic through them.
    axis.plot(k0["vertical_stress"] / 1e3, k0["ratio"], "-", color="black", linewidth=1, label="fitted to the column")
    axis.legend()
