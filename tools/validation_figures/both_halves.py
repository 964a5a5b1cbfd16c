"""Both halves of a tunnel with random packings: how much of the symmetry is left, and the half tunnel beside them."""

from pathlib import Path

import h5py
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from voussoir.ensembles import INDEX
from voussoir.figures.ensemble import Ensemble
from voussoir.figures.style import CYCLE, save

from .program import ROOT, Program

Array = np.ndarray
SHOWN = {0.01: CYCLE[0], 0.025: CYCLE[2], 0.05: CYCLE[3], 0.1: CYCLE[1]}  # volume losses that are drawn
TOLD = (0.01, 0.025, 0.05, 0.075, 0.1)  # volume losses whose numbers are told
MEMBERS = 16  # of both ensembles
HALF_TO_TEN = ("volume_loss.increments=40", "volume_loss.total=10 %")  # as in cases/full_tunnel
NEAR = 12.0  # distance from the axis within which the mean difference of the halves is told [m]
SAME_MESH = ("ground.mesh_size_opening=1.2 m", "ground.mesh_size_far=6 m")  # as in cases/full_tunnel
SAME_PACKINGS = ("packing.candidates=32", "packing.variety=16")  # and so the same seeds


class Surface:
    """Settlements of the surface of an ensemble of full tunnels."""

    def __init__(self, folder: Path) -> None:
        ensemble = Ensemble(folder)
        table = ensemble.tables["line_surface"]
        with h5py.File(folder / INDEX) as file:
            index = file["table/index"][()]
        self.count = ensemble.count
        losing = ensemble.losing()  # the opening gives way by some tenths of a per cent before, under the weight
        self.loss = ensemble.curve("area_opening").mean[losing]
        first = table["increment"].mean == index[-1]
        self.x = table["x"].mean[first] - np.mean(table["x"].mean[first])
        self.rows = [table["increment"].mean == one for one in index[losing]]
        self.settlement = -table["displacement_y"].members  # (member, row)

    def at(self, loss: float) -> Array:
        """Settlements (member, place) at the volume loss nearest to this one [m]."""
        return self.settlement[:, self.rows[int(np.argmin(np.abs(self.loss - loss)))]]

    def sides(self, loss: float) -> tuple[Array, Array]:
        """Settlements left and right of the axis, from the axis outwards; places lie alike on both sides, and one on
        the axis is left out."""
        values, count = self.at(loss), len(self.x) // 2
        return values[:, :count][:, ::-1], values[:, -count:]

    def asymmetry(self, loss: float) -> Array:
        """Of each member, the rms of right less left over the rms of their mean."""
        left, right = self.sides(loss)
        return np.asarray(np.sqrt(np.mean((right - left) ** 2, axis=1) / np.mean((right + left) ** 2 / 4, axis=1)))


def half_trough(folder: Path, loss: float) -> tuple[Array, Array]:
    """Distances from the axis [m] and settlements (member, node) [m] of an ensemble of half tunnels."""
    ensemble = Ensemble(folder)
    if ensemble.trough is None or ensemble.trough_x is None:
        raise ValueError(f"{folder} has no trough")
    rows = ensemble.losing()
    row = rows[int(np.argmin(np.abs(ensemble.load[rows] - loss)))]
    return ensemble.trough_x, ensemble.trough.members[:, row]


def _band(axis: Axes, x: Array, members: Array, colour: str, width: float = 1.6, label: str = "_") -> None:
    """Mean of the members and their standard deviation around it."""
    mean, deviation = 1e3 * members.mean(axis=0), 1e3 * members.std(axis=0, ddof=1)
    axis.fill_between(x, mean - deviation, mean + deviation, color=colour, alpha=0.3, linewidth=0)
    axis.plot(x, mean, color=colour, linewidth=width, label=label)


def _troughs(axis: Axes, full: Surface, half: Path) -> None:
    for loss, colour in SHOWN.items():
        _band(axis, full.x, full.at(loss), colour, label=f"$V_l$ = {100 * loss:g} %")
        x, members = half_trough(half, loss)
        mean = 1e3 * members.mean(axis=0)
        axis.plot(
            x, mean, "k--", linewidth=1, label=f"half tunnel, mean of {len(members)}" if loss == max(SHOWN) else "_"
        )
        axis.plot(-x, mean, "k--", linewidth=1)
    axis.set_ylim(135, 0)  # room for the legend
    axis.set_xlim(-25, 25)
    axis.set_xlabel("distance from the axis  $x$  [m]")
    axis.set_ylabel("settlement  [mm]")
    axis.set_title(f"mean ± deviation of {full.count}")
    axis.legend(fontsize=8.5, loc="lower center", ncols=2)


def _differences(axis: Axes, full: Surface) -> None:
    for loss, colour in list(SHOWN.items())[1:]:
        left, right = full.sides(loss)
        x = full.x[-left.shape[1] :]
        for k, one in enumerate(1e3 * (right - left)):
            axis.plot(x, one, color=colour, linewidth=0.6, label=f"$V_l$ = {100 * loss:g} %" if k == 0 else "_")
        _band(axis, x, right - left, colour, 2.2)
    axis.axhline(0, color="0.4", linewidth=0.8)
    axis.set_xlim(0, 25)
    axis.set_xlabel("distance from the axis  $|x|$  [m]")
    axis.set_ylabel("settlement right less left  [mm]")
    axis.set_title("difference of the halves")
    axis.legend(fontsize=8.5, loc="upper right")


def _growth(axis: Axes, full: Surface) -> None:
    losses = full.loss[1:]
    share = 100 * np.array([full.asymmetry(loss) for loss in losses])  # (increment, member)
    for k in range(full.count):
        axis.plot(100 * losses, share[:, k], color="0.45", linewidth=0.8, label="the members" if k == 0 else "_")
    axis.plot(100 * losses, share.mean(axis=1), color=CYCLE[0], linewidth=2.2, label=f"mean of {full.count}")
    axis.set_xlim(0, 100 * losses.max())
    axis.set_ylim(bottom=0)
    axis.set_xlabel("volume loss  $V_l$  [%]")
    axis.set_ylabel("rms of the difference, of the mean  [%]")
    axis.set_title("asymmetry")
    axis.legend(fontsize=8.5, loc="upper left")


def _error(values: Array) -> str:
    """Mean and its standard error."""
    return f"{values.mean():.2f} +- {values.std(ddof=1) / np.sqrt(len(values)):.2f}"


def _range(values: Array) -> str:
    return f"{values.mean():.2g} ({values.min():.2g} to {values.max():.2g})"


def _told(full: Surface, half: Path) -> list[str]:
    lines = []
    for loss in TOLD:
        middle = 1e3 * full.at(loss)[:, len(full.x) // 2]
        left, right = full.sides(loss)
        differences, places = 1e3 * (right - left), full.x[full.at(loss).argmax(axis=1)]
        side = differences[:, full.x[-left.shape[1] :] < NEAR].mean(axis=1)
        x, members = half_trough(half, loss)
        of_half = 1e3 * members[:, np.argmin(np.abs(x))]
        lines.append(
            f"V_l {100 * loss:g} %: {middle.mean():.1f} +- {middle.std(ddof=1):.1f} mm (half {of_half.mean():.1f} +- "
            f"{of_half.std(ddof=1):.1f}; pairs {_error(middle - of_half)}); "
            f"largest difference {_range(np.abs(differences).max(axis=1))} mm; "
            f"rms {_range(100 * full.asymmetry(loss))} %; largest at {places.min():.1f} to {places.max():.1f} m; "
            f"right less left within {NEAR:g} m: {_error(side)} mm"
        )
    area = full.at(max(SHOWN))
    lines.append(f"centre of the trough: {_range(area @ full.x / area.sum(axis=1))} m")
    return lines


def draw(program: Program, path: Path) -> list[str]:
    full = Surface(program.ensemble("full", ROOT / "cases/full_tunnel/case.toml", MEMBERS))
    half = program.ensemble(
        "half", ROOT / "cases/tunnel_quick/case.toml", MEMBERS, *SAME_MESH, *SAME_PACKINGS, *HALF_TO_TEN
    )
    figure, axes = plt.subplots(1, 3, figsize=(12, 4), layout="constrained")
    _troughs(axes[0], full, half)
    _differences(axes[1], full)
    _growth(axes[2], full)
    figure.suptitle("Both halves of a tunnel in dense coarse sand, 16 packings over all points", fontsize=12)
    save(figure, path)
    return _told(full, half)
