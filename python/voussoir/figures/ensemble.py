"""The figures of an ensemble: means over its members with both bands, and the members as thin lines."""

from collections.abc import Callable
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import ensembles
from ..ensembles import INDEX, Bands
from ..errors import Missing
from . import scene
from .resolution import percent
from .settings import Settings
from .stresses import plain_ticks
from .style import save

MEAN, FURTHER, MEMBER = "C0", "C1", "0.45"


class Ensemble(ensembles.Ensemble):
    """An ensemble with the volume losses that figures show."""

    def __init__(self, folder: Path | str, settings: Settings | None = None) -> None:
        self.settings = settings or Settings()
        super().__init__(folder)

    def losing(self) -> np.ndarray:
        """Rows of the volume loss."""
        rows = np.flatnonzero(self.stage == "volume_loss")
        if len(rows) == 0:
            raise Missing("there is no stage volume_loss")
        return rows

    def title(self) -> str:
        left_out = self.begun - self.count
        further = f", {left_out} left out" if left_out else ""
        return f"{self.count} members{further}"


def draw_bands(axis: Axes, x: np.ndarray, bands: Bands, ensemble: Ensemble, scale: float = 1.0) -> None:
    """Both bands, the members and the mean. Places without a value in each member are left out."""
    there = np.isfinite(bands.mean)
    if not there.any():
        raise Missing("no place has a value in each member")
    x, share = x[there], f"{100 * ensemble.confidence:g} %"
    mean = scale * bands.mean[there]
    for half_width, colour, alpha, label in (
        (bands.prediction_half_width, FURTHER, 0.22, f"{share} band of one further member"),
        (bands.mean_half_width, MEAN, 0.35, f"{share} band of the mean"),
    ):
        half = scale * half_width[there]
        axis.fill_between(x, mean - half, mean + half, color=colour, alpha=alpha, linewidth=0, label=label)
    for k, member in enumerate(bands.members):
        label = f"the {ensemble.count} members" if k == 0 else "_"  # one entry of the legend for all of them
        axis.plot(x, scale * member[there], color=MEMBER, linewidth=0.6, label=label)
    axis.plot(x, mean, color=MEAN, linewidth=2.0, label=f"mean of {ensemble.count}")


def _over_the_loss(ensemble: Ensemble, name: str, label: str, title: str, scale: float = 1.0) -> tuple[Figure, Axes]:
    rows = ensemble.losing()
    figure, axis = plt.subplots(figsize=(7.2, 4.8))
    draw_bands(axis, 100 * ensemble.load[rows], ensemble.curve(name).part(rows), ensemble, scale)
    axis.set_xlabel("volume loss  $V_l$  [%]")
    axis.set_ylabel(label)
    axis.set_xlim(0, 100 * ensemble.load[rows].max())
    axis.set_ylim(bottom=min(0, axis.get_ylim()[0]))
    axis.set_title(f"{title}, {ensemble.title()}")
    return figure, axis


def draw_settlement(ensemble: Ensemble, path: Path) -> None:
    figure, axis = _over_the_loss(
        ensemble, "surface_settlement", "largest settlement of the surface  [mm]", "Surface settlement", 1e3
    )
    axis.legend(loc="upper left")
    save(figure, path)


def draw_reaction(ensemble: Ensemble, path: Path) -> None:
    figure, axis = _over_the_loss(
        ensemble,
        "ground_reaction",
        r"vertical stress above the crown  $\sigma_v / \sigma_{v,0}$  [-]",
        "Ground reaction curve",
    )
    axis.set_ylim(top=max(1.05, axis.get_ylim()[1]))
    axis.legend()
    save(figure, path)


def draw_width(ensemble: Ensemble, path: Path) -> None:
    figure, axis = _over_the_loss(
        ensemble, "trough_width", "width parameter of the surface  $K_s$  [-]", "Width of the surface trough"
    )
    rows = ensemble.losing()
    assert ensemble.good_troughs is not None  # the curve exists only with the troughs
    good = rows[(ensemble.good_troughs[rows] == ensemble.count) & (ensemble.load[rows] > 0)]
    fits = r"$\alpha$ within its bounds, misfit below 3 %"
    axis.plot(
        100 * ensemble.load[good],
        ensemble.curve("trough_width").mean[good],
        "o" if len(good) else " ",
        color=MEAN,
        markersize=4,
        label=f"in all members {fits}" if len(good) else f"at no $V_l$ have all members\n{fits}",
    )
    low, high = ensemble.settings.range_of_k
    axis.axhspan(low, high, color="0.9", zorder=0, label=f"Mair and Taylor, {low:g} to {high:g}")
    axis.legend(fontsize=8.5)
    save(figure, path)


def draw_trough(ensemble: Ensemble, path: Path) -> None:
    if ensemble.trough is None or ensemble.trough_x is None:
        raise Missing(f"{ensemble.folder / INDEX} has no surface trough")
    rows = ensemble.losing()
    rows = rows[ensemble.load[rows] > 0]
    if len(rows) == 0:
        raise Missing("no increment has a volume loss")
    load = ensemble.load[rows]
    wanted = ensemble.settings.losses or tuple(load[-1] * np.array([0.25, 0.5, 0.75, 1]))
    chosen = sorted({int(np.argmin(np.abs(load - v))) for v in wanted})
    columns = min(2, len(chosen))
    height = -(-len(chosen) // columns)
    figure, axes = plt.subplots(height, columns, figsize=(6.2 * columns, 4.0 * height + 0.4), squeeze=False)
    for axis, k in zip(axes.flat, chosen):
        draw_bands(axis, ensemble.trough_x, ensemble.trough.part(int(rows[k])), ensemble, 1e3)
        axis.invert_yaxis()
        axis.set_xlim(0, ensemble.trough_x.max())
        axis.set_title(f"$V_l$ = {percent(load[k])}")
        axis.set_xlabel("distance from the tunnel axis  $x$  [m]")
        axis.set_ylabel("settlement  $S$  [mm]")
    for axis in axes.flat[len(chosen) :]:
        axis.set_axis_off()
    axes.flat[0].legend(loc="lower right", fontsize=8.5)
    figure.suptitle(f"Settlement trough of the surface, {ensemble.title()}", fontsize=12)
    figure.tight_layout()
    save(figure, path)


def draw_k0(ensemble: Ensemble, path: Path) -> None:
    if "k0" not in ensemble.tables:
        raise Missing(f"{ensemble.folder / INDEX} has no table k0")
    k0 = ensemble.tables["k0"]
    figure, axis = plt.subplots(figsize=(7.2, 4.8))
    draw_bands(axis, k0["vertical_stress"].mean / 1e3, k0["ratio"], ensemble)
    axis.set_xscale("log")
    plain_ticks(axis, k0["vertical_stress"].mean / 1e3)
    axis.set_xlabel(r"vertical stress  $\sigma_{yy}$  [kPa]")
    axis.set_ylabel(r"$K_0 = \sigma_{xx} / \sigma_{yy}$  [-]")
    axis.set_ylim(0, max(1.05, axis.get_ylim()[1]))
    axis.set_title(f"$K_0$ of the column, {ensemble.title()}")
    axis.legend()
    save(figure, path)


def draw_specimen(ensemble: Ensemble, path: Path) -> None:
    ratio = ensemble.curve("q_over_p")
    figure, axis = plt.subplots(figsize=(7.2, 4.8))
    draw_bands(axis, 100 * ensemble.load, ratio, ensemble)
    axis.set_xlabel("displacement of the top over the height  [%]")
    axis.set_ylabel("$q / p$  [-]")
    axis.set_xlim(left=0)
    axis.set_title(f"Biaxial specimen, {ensemble.title()}")
    axis.legend()
    save(figure, path)


def motions(ensemble: Ensemble) -> list[scene.Motion]:
    """The moved boundaries of an ensemble of scenes; Missing is raised where there are none."""
    return scene.motions_of(ensemble.case, lambda name: ensemble.curves[name].mean if name in ensemble.curves else None)


def _reach(values: np.ndarray) -> float:
    return float(np.ptp(values)) if len(values) else 0.0


def boundary_bands(ensemble: Ensemble, motion: scene.Motion) -> tuple[np.ndarray, Bands, float]:
    """Mean displacement [mm] and reaction [N/m] of a moved boundary in the stage that moves it most while it is held,
    and the sign of the reaction with which the support first pushes the ground."""
    x = ensemble.curve(f"displacement_{motion.name}_{motion.axis}").mean
    bands = ensemble.curve(f"reaction_{motion.name}_{motion.axis}")
    far = {
        name: _reach(x[(ensemble.stage == name) & (bands.mean != 0)])
        for name in dict.fromkeys(ensemble.stage)
        if np.any(bands.mean[ensemble.stage == name] != 0)
    }
    if not any(far.values()):
        raise Missing(f"no stage moves {motion.name} while it is held")
    rows = np.flatnonzero(ensemble.stage == max(far, key=lambda name: far[name]))
    return (1e3 if motion.forward else -1e3) * x[rows], bands.part(rows), scene.first_sign(bands.mean)


def draw_boundaries(ensemble: Ensemble, path: Path) -> None:
    """What the moved boundaries of a scene bear, over the mean of their displacement."""
    moved = motions(ensemble)
    figure, axes = plt.subplots(1, len(moved), figsize=(7.2 * len(moved), 4.8), squeeze=False, layout="constrained")
    for axis, motion in zip(axes.flat, moved):
        x, bands, sign = boundary_bands(ensemble, motion)
        draw_bands(axis, x, bands, ensemble, 1e-3 * sign)
        axis.set_xlabel(f"displacement {motion.movement}  [mm]")
        axis.set_ylabel(f"reaction on the ground, {scene.TOWARDS[motion.axis, sign > 0]}  [kN/m]")
        axis.set_title(f"{motion.name}, {ensemble.title()}")
        axis.legend(fontsize=8.5)
    save(figure, path)


FIGURES: dict[str, Callable[[Ensemble, Path], None]] = {
    "ensemble_settlement.png": draw_settlement,
    "ensemble_ground_reaction.png": draw_reaction,
    "ensemble_trough.png": draw_trough,
    "ensemble_trough_width.png": draw_width,
    "ensemble_k0.png": draw_k0,
    "ensemble_specimen.png": draw_specimen,
    "ensemble_boundaries.png": draw_boundaries,
}
