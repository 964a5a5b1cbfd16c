"""The tunnel in linear elastic ground against closed forms: stresses after gravity, K0, the loss of the opening."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from voussoir.figures import q8, stresses
from voussoir.figures.result import Result
from voussoir.figures.style import CYCLE, save

from .log_axes import log_axis
from .program import ROOT, Program

FIRST = 1e3  # isotropic pressure with which the ground begins [Pa]


def k0_form(vertical: np.ndarray, poisson: float) -> np.ndarray:
    """K0 of elastic ground that is compressed without lateral strain from an isotropic pressure."""
    return (FIRST + poisson / (1 - poisson) * (vertical - FIRST)) / vertical


def _stresses(axis: Axes, result: Result, poisson: float) -> list[str]:
    unit_weight, surcharge, surface_y = result.need("unit_weight", "surcharge", "surface_y")
    found = -stresses.after_gravity(result).field("gauss/stress")
    depth = surface_y - q8.gauss_coordinates(result.coordinates, result.connectivity)[..., 1]
    vertical = unit_weight * depth + surcharge
    horizontal = k0_form(vertical, poisson) * vertical
    line = np.argsort(depth, axis=None)
    for values, form, colour, mark, name in (
        (found[..., 1], vertical, CYCLE[0], ".", "vertical"),
        (found[..., 0], horizontal, CYCLE[3], "x", "horizontal"),
    ):
        axis.plot(values / 1e3, depth, mark, color=colour, markersize=3)
        axis.plot([], [], mark, color=colour, label=f"{name} stress")
        axis.plot(form.ravel()[line] / 1e3, depth.ravel()[line], color="black", linewidth=1)
    axis.plot([], [], color="black", linewidth=1, label="closed form")
    axis.invert_yaxis()
    axis.set_xlabel("stress [kPa], compression positive")
    axis.set_ylabel("depth [m]")
    axis.set_title("after gravity, all Gauss points")
    axis.legend()
    base = vertical.max()
    away = [np.max(np.abs(found[..., k] - form)) / base for k, form in ((1, vertical), (0, horizontal))]
    share = f"of the largest vertical stress, {base / 1e3:.0f} kPa"
    return [f"after gravity: vertical stress within {away[0]:.2e}, horizontal within {away[1]:.2e} {share}"]


def _k0(axis: Axes, folder: Path, poisson: float) -> list[str]:
    vertical, k0 = np.loadtxt(folder / "column/k0.csv", delimiter=",", skiprows=1, unpack=True)
    axis.plot(vertical / 1e3, k0, "o", color=CYCLE[2], markersize=4, label="column stage")
    line = np.geomspace(vertical.min(), vertical.max())
    axis.plot(line / 1e3, k0_form(line, poisson), color="black", linewidth=1, label="closed form")
    log_axis(axis, "x")
    axis.set_xlabel("vertical stress [kPa]")
    axis.set_ylabel("$K_0$ [-]")
    axis.set_title("earth pressure at rest")
    axis.legend()
    return [f"K0 of the column within {np.max(np.abs(k0 - k0_form(vertical, poisson))):.1e} of the closed form"]


def _opening(axis: Axes, result: Result) -> list[str]:
    (diameter,) = result.need("diameter")
    loss = result.volume_loss
    crown = np.array([i["crown_settlement"] for i in result.loss_increments])
    area = np.array([i["area_loss"] for i in result.loss_increments])
    line = np.linspace(0, loss[-1])
    axis.plot(100 * loss, 1e3 * crown, "o", color=CYCLE[4], markersize=5, label="settlement of the crown")
    form = diameter * (1 - np.sqrt(1 - line))
    axis.plot(100 * line, 1e3 * form, color="black", linewidth=1, label="$D\\,(1-\\sqrt{1-V_l})$")
    axis.set_xlabel("volume loss $V_l$ [%]")
    axis.set_ylabel("[mm]")
    axis.set_title("kinematics of the opening")
    axis.legend()
    away = np.max(np.abs(crown - diameter * (1 - np.sqrt(1 - loss))))
    return [f"crown within {away:.1e} m of its form, area lost within {np.max(np.abs(area - loss)):.1e} of V_l"]


def draw(program: Program, path: Path) -> list[str]:
    case = ROOT / "cases/tunnel_elastic/case.toml"
    folder = program.run("elastic_ground", case, "volume_loss.total=20 %", "volume_loss.increments=20")
    result = Result(folder)
    poisson = result.case["elastic"]["poisson"]
    figure, axes = plt.subplots(1, 3, figsize=(12.5, 4.3))
    lines = _stresses(axes[0], result, poisson) + _k0(axes[1], folder, poisson) + _opening(axes[2], result)
    figure.suptitle("cases/tunnel_elastic against closed forms")
    figure.tight_layout()
    save(figure, path)
    return lines
