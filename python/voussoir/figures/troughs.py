"""Settlement troughs at the surface and below it, with their modified Gauss curves."""

import csv
import io
from collections.abc import Iterable
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from . import q8, trough_fit
from .output import write
from .resolution import percent
from .result import Increment, Missing, Result, remembered
from .style import colours, save

COLUMNS = (
    "z_over_C",
    "depth_m",
    "volume_loss",
    "settlement_max_m",
    "settlement_axis_m",
    "inflection_m",
    "alpha",
    "alpha_at_bound",
    "n",
    "K",
    "rms_misfit",
    "trough_area_over_lost_area",
)


class Line:
    """A level line of the ground as it was before the loss. Its places in the elements are searched only once."""

    def __init__(self, result: Result, depth: float) -> None:
        (surface_y,) = result.need("surface_y")
        x, y = result.coordinates.T
        on_surface = np.flatnonzero(np.abs(y - surface_y) < 1e-9 * surface_y) if depth == 0 else np.array([], dtype=int)
        # At the surface the line has the nodes, below it points in the elements.
        below = np.linspace(x.min(), x.max(), 161) if result.is_whole else np.linspace(0, x.max(), 81)
        self.x = np.sort(x[on_surface]) if depth == 0 else below
        line = np.column_stack([self.x, np.full_like(self.x, surface_y - depth)])
        self.nodes, self.weights = q8.locate(result.coordinates, result.connectivity, line)
        inside = np.isfinite(self.weights[:, 0])
        self.x, self.nodes, self.weights = self.x[inside], self.nodes[inside], self.weights[inside]
        if len(self.x) < 4:
            raise Missing(f"the mesh has too few points at the depth {depth:g} m")

    @property
    def on_axis(self) -> int:
        """The place of the line that is nearest to the tunnel's axis x = 0."""
        return int(np.argmin(np.abs(self.x)))

    def settlement(self, increment: Increment) -> np.ndarray:
        """[m], along `x`."""
        return -np.einsum("pn,pn->p", self.weights, increment.field("node/displacement")[self.nodes, 1])


class Trough:
    """The settlements of a line at one V_l, and the curve fitted to them."""

    def __init__(self, result: Result, increment: Increment, ratio: float) -> None:
        axis_depth, diameter = result.need("axis_depth", "diameter")
        line = line_at(result, ratio)
        self.ratio, self.loss = ratio, increment["volume_loss"]
        self.x, self.settlement = line.x, line.settlement(increment)
        self.at_axis = float(self.settlement[line.on_axis])
        self.fit = trough_fit.fit(self.x, self.settlement)
        self.depth = ratio * result.cover
        # NumPy's own function has another name in Debian 12's version.
        area = np.sum(np.diff(self.x) * (self.settlement[1:] + self.settlement[:-1]) / 2)
        halves = 1 if result.is_whole else 2
        self.area_ratio = halves * area / (self.loss * np.pi * diameter**2 / 4)
        self.width = self.fit.inflection / (axis_depth - self.depth)  # K [-]

    def row(self) -> tuple[float, ...]:
        fit = self.fit
        return (
            self.ratio,
            self.depth,
            self.loss,
            self.settlement.max(),
            self.at_axis,
            fit.inflection,
            fit.alpha,
            float(fit.at_bound),
            fit.n,
            self.width,
            fit.misfit,
            self.area_ratio,
        )


def line_at(result: Result, ratio: float) -> Line:
    """The line at z/C = ratio."""
    return remembered(result, f"line at {ratio}", lambda: Line(result, ratio * result.cover))


def all_troughs(result: Result) -> dict[tuple[float, float], Trough]:
    """{(z/C, V_l): trough} at all depths of all increments of the volume loss."""
    return remembered(
        result,
        "troughs",
        lambda: {
            (ratio, i["volume_loss"]): Trough(result, i, ratio)
            for ratio in result.settings.depths
            for i in result.loss_increments
            if i["volume_loss"] > 0
        },
    )


def mirrored(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Both sides of the axis; values that have both sides already stay as they are."""
    if x[0] < -1e-6 * np.ptp(x):
        return x, y
    return np.concatenate([-x[::-1], x]), np.concatenate([y[::-1], y])


def draw(result: Result, path: Path) -> None:
    """Draws one picture for each depth with the chosen volume losses, and writes all numbers to a table."""
    (diameter,) = result.need("diameter")
    troughs, depths = all_troughs(result), result.settings.depths
    columns = min(3, len(depths))
    rows = -(-len(depths) // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(5.0 * columns, 3.9 * rows), squeeze=False, sharex=True)
    for axis, ratio in zip(axes.flat, depths):
        for increment, colour in zip(result.losses, colours("viridis", len(result.losses))):
            _add(axis, troughs[ratio, increment["volume_loss"]], colour)
        axis.set_title(f"$z/C$ = {ratio:g}" + ("  (surface)" if ratio == 0 else "  (crown)" if ratio == 1 else ""))
        axis.invert_yaxis()
        axis.set_ylabel("settlement  $S$  [m]")
        axis.set_xlabel("distance from the tunnel axis  $x$  [m]")
        axis.xaxis.set_tick_params(labelbottom=True)
    spare = axes.flat[len(depths) :]
    for axis in spare:
        axis.set_axis_off()
    handles, labels = axes.flat[0].get_legend_handles_labels()
    place = spare[0] if len(spare) else axes.flat[0]
    place.legend(handles, labels, title="$V_l$", loc="center" if len(spare) else "lower right")
    figure.suptitle(
        f"Settlement troughs, $C/D$ = {result.cover / diameter:.2g}, $D$ = {diameter:g} m   (symbols: computed, lines: "
        r"modified Gauss curve, dashed where its $\alpha$ is at its bound)",
        fontsize=12,
    )
    figure.tight_layout()
    save(figure, path)
    _write_table(path.with_suffix(".csv"), troughs.values())


def _add(axis: Axes, trough: Trough, colour: np.ndarray) -> None:
    fine = np.linspace(-trough.x.max(), trough.x.max(), 400)
    axis.plot(fine, trough.fit(fine), "--" if trough.fit.at_bound else "-", color=colour, label=percent(trough.loss))
    axis.plot(
        *mirrored(trough.x, trough.settlement),
        "o",
        color=colour,
        markersize=3,
        markerfacecolor="none",
        markeredgewidth=0.7,
    )


def _write_table(path: Path, troughs: Iterable[Trough]) -> None:
    table = io.StringIO()
    writer = csv.writer(table)
    writer.writerow(COLUMNS)
    for trough in troughs:
        writer.writerow([f"{value:.6g}" for value in trough.row()])
    write(path, table.getvalue())
