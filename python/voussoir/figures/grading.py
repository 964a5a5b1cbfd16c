"""Grading curves of packings: percent finer against the size of the grains, as in the study's fig. 2."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from .packings import Packing, Packings
from .style import CYCLE, save

BY_AREA, BY_VOLUME = 2, 3  # powers of the diameter: discs, as the grains of a packing are; spheres, as soils are sieved


def percent_finer(diameter: np.ndarray, power: int) -> tuple[np.ndarray, np.ndarray]:
    """Sizes in ascending order, and what share of the soil is not larger than each of them [%]."""
    size = np.sort(diameter)
    passing = np.cumsum(size**power)
    return size, 100 * passing / passing[-1]


def size_at(diameter: np.ndarray, power: int, percent: float) -> float:
    """d_10, d_30, d_60: the size than which this share of the soil is finer, interpolated in its logarithm."""
    size, passing = percent_finer(diameter, power)
    return float(np.exp(np.interp(percent, passing, np.log(size))))


def coefficients(diameter: np.ndarray, power: int) -> tuple[float, float]:
    """Uniformity C_u = d_60/d_10 and curvature C_c = d_30^2/(d_60 d_10)."""
    d10, d30, d60 = (size_at(diameter, power, percent) for percent in (10, 30, 60))
    return d60 / d10, d30**2 / (d60 * d10)


def draw(packings: Packings, path: Path) -> None:
    groups = packings.groups()
    figure, axis = plt.subplots(figsize=(8.2, 5.2))
    for k, group in enumerate(groups):
        diameter = 2 * np.concatenate([packing.radius for packing in group])
        colour = CYCLE[k % len(CYCLE)]
        wide = max(1.2, 3.4 - 0.9 * k)  # so that equal gradings are seen below one another
        for power, line, width in ((BY_AREA, "-", wide), (BY_VOLUME, "--", 0.55 * wide)):
            size, passing = percent_finer(1e3 * diameter, power)
            label = _label(group, diameter) if power == BY_AREA else None
            axis.step(np.r_[size[0], size], np.r_[0, passing], line, where="post", color=colour, lw=width, label=label)
    axis.plot([], [], "-", color="0.4", label="by area (discs, as in the packing)")
    axis.plot([], [], "--", color="0.4", linewidth=1, label="by mass, were the grains spheres")
    _scale(axis, 2e3 * np.array([[p.radius.min(), p.radius.max()] for p in packings.all]))
    axis.set_xlabel("grain size  $d$  [mm]")
    axis.set_ylabel("finer  [%]")
    axis.set_ylim(0, 100)
    axis.set_title("Grading of the packings, all seeds of a recipe together")
    axis.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), fontsize=9)
    save(figure, path)


def _label(group: list[Packing], diameter: np.ndarray) -> str:
    uniformity, curvature = coefficients(diameter, BY_AREA)
    one = group[0]
    void = np.mean([packing.void_ratio for packing in group])
    count = f"{len(group)} packings" if len(group) > 1 else "1 packing"
    friction = _common(group, "consolidation_friction", 1, ", $\\mu_t$ = {:.3g}")
    pressure = _common(group, "pressure", 1e-3, ", {:.3g} kPa")
    return (
        f"{one.soil}, {count} of {len(one.radius)} grains{friction}{pressure}, $e$ = {void:.3f}: "
        f"$C_u$ = {uniformity:.2f}, $C_c$ = {curvature:.2f} by area"
    )


def _common(group: list[Packing], name: str, factor: float, text: str) -> str:
    """A number of the recipe in words; empty where the packings differ in it or do not tell it, as where the program
    searched the friction of each packing."""
    if not all(name in packing.numbers for packing in group):
        return ""
    texts = {text.format(packing.numbers[name] * factor) for packing in group}
    return texts.pop() if len(texts) == 1 else ""


def _scale(axis: Axes, sizes: np.ndarray) -> None:
    """A logarithmic axis of sizes [mm] from one round number to another."""
    low, high = sizes.min(), sizes.max()
    decade = np.array([1, 2, 5] if high > 5 * low else [1, 1.5, 2, 2.5, 3, 4, 5, 6, 8])
    ticks = np.concatenate([factor * decade for factor in (0.1, 1, 10, 100)])
    axis.set_xscale("log")
    shown = ticks[(ticks >= 0.45 * low) & (ticks <= 2.2 * high)]
    axis.set_xticks(shown, [f"{tick:g}" for tick in shown])
    axis.minorticks_off()
    axis.set_xlim(0.8 * low, 1.25 * high)
