"""The paths of the RVEs at Aa, Ab, Ac and B: stress ratio, volume, void ratio, and the contact network where it was
written."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from . import points
from .result import Missing, Result
from .style import save

COLOURS = {"Aa": "C3", "Ab": "C6", "Ac": "C0", "B": "C2"}

# Field, label, factor; those of the contact network are written only where output.microstructure asks for them.
NETWORK = [
    ("gauss/mechanical_coordination", r"mechanical coordination  $Z_m$  [-]"),
    ("gauss/strong_coordination_1", r"strong network, $f_n \geq \langle f_n \rangle$:  $Z_m$  [-]"),
    ("gauss/strong_coordination_2", r"strong network, $f_n \geq 2 \langle f_n \rangle$:  $Z_m$  [-]"),
    ("gauss/strong_coordination_2_5", r"strong network, $f_n \geq 2.5 \langle f_n \rangle$:  $Z_m$  [-]"),
    ("gauss/fabric_anisotropy", "fabric anisotropy  $a$  [-]"),
    ("gauss/coordination", "coordination  $Z$  [-]"),
]


LEAST_PRESSURE = 500.0  # [Pa]; with less pressure an RVE is about to lose its contacts, and q/p is only noise


def stress_ratio(result: Result, point: points.Point) -> np.ndarray:
    """q/p over the volume loss [-]; NaN where the point is hardly compressed."""
    p, q = (points.history(result, f"gauss/{name}_stress", point) for name in ("mean", "deviatoric"))
    return np.divide(q, p, out=np.full_like(p, np.nan), where=p > LEAST_PRESSURE)


def draw(result: Result, path: Path) -> None:
    loss = 100 * result.volume_loss
    figure, axes = plt.subplots(2, 3, figsize=(15.5, 8.4))
    for point in points.all_points(result):
        style = {"color": COLOURS[point.name], "label": points.describe(result, point), "linewidth": 1.4}
        ratio = stress_ratio(result, point)
        p, q, volumetric, sheared, void = (
            points.history(result, f"gauss/{name}", point)
            for name in ("mean_stress", "deviatoric_stress", "volumetric_strain", "deviatoric_strain", "void_ratio")
        )
        axes[0, 0].plot(loss, ratio, **style)
        axes[0, 1].plot(100 * sheared, ratio, **style)
        axes[0, 2].plot(p / 1e3, q / 1e3, **style)
        axes[0, 2].plot(p[0] / 1e3, q[0] / 1e3, "o", color=style["color"], markersize=5)
        axes[1, 0].plot(loss, 100 * volumetric, **style)
        axes[1, 1].plot(100 * sheared, 100 * volumetric, **style)
        axes[1, 2].plot(loss, void, **style)
    for axis in (axes[0, 0], axes[1, 0], axes[1, 2]):
        axis.set_xlabel("volume loss  $V_l$  [%]")
        axis.set_xlim(left=0)
    for axis in (axes[0, 1], axes[1, 1]):
        axis.set_xlabel(r"deviatoric strain  $\varepsilon_q$  [%]")
        axis.set_xlim(left=0)
    for axis in axes[0, :2]:
        axis.set_ylabel("stress ratio  $q/p$  [-]")
        axis.set_ylim(0, 1.05)
    axes[0, 2].set_xlabel("mean stress  $p$  [kPa]")
    axes[0, 2].set_ylabel("deviatoric stress  $q$  [kPa]")
    axes[0, 2].set_title("stress path, from the symbol on", fontsize=11)
    for axis in axes[1, :2]:
        axis.set_ylabel(r"$\varepsilon_v$, contraction positive  [%]")
        axis.axhline(0, color="0.4", linewidth=0.8)
    axes[1, 2].set_ylabel("void ratio  $e$  [-]")
    figure.legend(
        *axes[0, 0].get_legend_handles_labels(),
        title="point  ($x$, height above the crown)",
        loc="upper center",
        bbox_to_anchor=(0.5, 0.0),
        ncol=4,
    )
    figure.suptitle("RVEs above the crown and in the shear band", fontsize=12)
    figure.tight_layout()
    save(figure, path)


def draw_network(result: Result, path: Path) -> None:
    first = result.loss_increments[-1]
    present = [(name, label) for name, label in NETWORK if name in first.names]
    if len(present) < 2:  # the coordination number is always written
        raise Missing("the contact network was not written (output.microstructure)")
    rows = -(-len(present) // 3)
    figure, axes = plt.subplots(rows, 3, figsize=(15.5, 4.2 * rows), squeeze=False)
    for axis in axes.flat[len(present) :]:
        axis.set_axis_off()
    for axis, (name, label) in zip(axes.flat, present):
        for point in points.all_points(result):
            axis.plot(
                100 * result.volume_loss,
                points.history(result, name, point),
                color=COLOURS[point.name],
                linewidth=1.3,
                label=points.describe(result, point),
            )
        axis.set_ylabel(label)
        axis.set_xlabel("volume loss  $V_l$  [%]")
        axis.set_xlim(left=0)
    figure.legend(
        *axes[0, 0].get_legend_handles_labels(),
        title="point  ($x$, height above the crown)",
        loc="upper center",
        bbox_to_anchor=(0.5, 0.0),
        ncol=4,
    )
    figure.suptitle("Contact network of the RVEs above the crown and in the shear band", fontsize=12)
    figure.tight_layout()
    save(figure, path)
