"""Principal stresses along a line above the crown, beside the direction of the RVEs' fabric."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from . import points, tensors
from .resolution import percent
from .result import Increment, Missing, Result
from .style import colours, save


def line(result: Result) -> np.ndarray:
    """Gauss points of the elements that the line crosses, out to 3 D."""
    (diameter,) = result.need("diameter")
    chosen = points.on_level(result, result.crown_height + result.settings.line * diameter, 3 * diameter)
    if len(chosen) == 0:
        raise Missing(f"no element lies at {result.settings.line:g} D above the crown")
    return chosen


def stress_angles(result: Result, increment: Increment) -> tuple[np.ndarray, np.ndarray]:
    """x [m] and the angle of the compressive major axis from the vertical [rad] at the line's points."""
    chosen = line(result)
    stress = increment.field("gauss/stress").reshape(-1, 3)[chosen]
    return points.original_points(result)[chosen, 0], tensors.major_from_vertical(stress)


def fabric_angles(result: Result, increment: Increment) -> np.ndarray:
    """Angle of most contact normals from the vertical [rad]; files have the angle from the horizontal."""
    return tensors.axis_angle(increment.field("gauss/fabric_direction").ravel()[line(result)] - np.pi / 2)


def draw(result: Result, path: Path) -> None:
    (diameter,) = result.need("diameter")
    has_fabric = "gauss/fabric_direction" in result.losses[0].names
    figure, axes = plt.subplots(
        1, 2 if has_fabric else 1, figsize=(12.5 if has_fabric else 7, 4.8), squeeze=False, sharey=True
    )
    for increment, colour in zip(result.losses, colours("viridis", len(result.losses))):
        label = percent(increment["volume_loss"])
        x, angle = stress_angles(result, increment)
        _add(axes[0, 0], x / diameter, angle, "o", colour, label)
        if has_fabric:
            _add(axes[0, 1], x / diameter, fabric_angles(result, increment), "s", colour, label)
    axes[0, 0].set_ylabel("angle from the vertical  [deg]")
    axes[0, 0].set_title(r"major principal stress")
    if has_fabric:
        axes[0, 1].set_title(r"fabric direction  $\theta_a$")
    for axis in axes[0]:
        axis.set_xlabel("distance from the tunnel axis  $x/D$  [-]")
        axis.set_ylim(-95, 95)
        axis.set_yticks(range(-90, 91, 30))
        axis.set_xlim(left=0)
        axis.legend(title="$V_l$")
    figure.suptitle(
        f"Along the line {result.settings.line:g} $D$ above the crown; counter-clockwise positive", fontsize=12
    )
    figure.tight_layout()
    save(figure, path)


def _add(axis: Axes, x: np.ndarray, angle: np.ndarray, marker: str, colour: np.ndarray, label: str) -> None:
    """Draws symbols and joins them, except where the axis passes through +-90 deg, which is one direction."""
    degrees = np.degrees(angle)
    axis.plot(x, degrees, marker, color=colour, markersize=3.5, label=label)
    cuts = np.flatnonzero(np.abs(np.diff(degrees)) > 90) + 1
    axis.plot(np.insert(x, cuts, np.nan), np.insert(degrees, cuts, np.nan), color=colour, linewidth=1)
