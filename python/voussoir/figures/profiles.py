"""Horizontal and vertical stress above the crown and beside the tunnel."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from . import points
from .resolution import percent
from .result import Increment, Missing, Result, remembered
from .style import colours, save


def above(result: Result, increment: Increment) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Height over the crown [m], sigma_xx and sigma_yy [Pa], compression positive, at the points next to the axis."""
    chosen = points.on_axis(result)
    if len(chosen) == 0:
        raise Missing("no element lies on the axis above the crown")
    stress = -increment.field("gauss/stress").reshape(-1, 3)[chosen]
    return points.original_points(result)[chosen, 1] - result.crown_height, stress[:, 0], stress[:, 1]


def beside(result: Result, increment: Increment) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Distance from the axis [m], sigma_xx and sigma_yy at the height of the tunnel's axis, out to 4 D."""
    (diameter,) = result.need("diameter")
    line = remembered(
        result,
        "line at the height of the axis",
        lambda: points.LevelLine(result, result.crown_height - diameter / 2, 4 * diameter),
    )
    if len(line.x) == 0:
        raise Missing("no element lies at the height of the tunnel's axis")
    stress = -line.of(increment.field("gauss/stress"))
    return line.x, stress[:, 0], stress[:, 1]


def draw(result: Result, path: Path) -> None:
    (diameter,) = result.need("diameter")
    shown = [result.loss_increments[0], *result.losses]
    figure, axes = plt.subplots(2, 2, figsize=(12.5, 9.6))
    for increment, colour in zip(shown, ["0.35", *colours("viridis", len(result.losses))]):
        label = percent(increment["volume_loss"])
        style = {"color": colour, "markersize": 2.5, "linewidth": 1, "label": label}
        height, *stresses = above(result, increment)
        for axis, stress in zip(axes[0], stresses):
            axis.plot(stress / 1e3, height / diameter, "o-", **style)
        x, *stresses = beside(result, increment)
        for axis, stress in zip(axes[1], stresses):
            axis.plot(x / diameter, stress / 1e3, "o-", **style)
    for axis, name in zip(axes[0], ("horizontal stress  $\\sigma_{xx}$", "vertical stress  $\\sigma_{yy}$")):
        axis.set_xlabel(f"{name}  [kPa]")
        axis.set_ylabel("height above the crown over $D$  [-]")
        axis.set_title("on the axis above the crown")
        axis.set_xlim(left=min(0, axis.get_xlim()[0]))
    for axis, name in zip(axes[1], ("horizontal stress  $\\sigma_{xx}$", "vertical stress  $\\sigma_{yy}$")):
        axis.set_ylabel(f"{name}  [kPa]")
        axis.set_xlabel("distance from the tunnel axis  $x/D$  [-]")
        axis.set_title("at the height of the tunnel's axis")
        axis.axvline(0.5, color="0.4", linewidth=0.8, linestyle="--")
        axis.set_xlim(left=0)
        axis.set_ylim(bottom=min(0, axis.get_ylim()[0]))
    axes[0, 0].legend(title="$V_l$")
    figure.suptitle("Stresses above and beside the tunnel", fontsize=12)
    figure.tight_layout()
    save(figure, path)
