"""Settlements beside one another: against V_l by depth (figs. 10, 13), troughs (fig. 11) and their widths (fig. 12)."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...ensembles import Bands
from .. import settlements, trough_fit, troughs
from ..resolution import percent
from ..result import Missing, Result
from ..style import MARKERS, colours
from .bands import of_members
from .data import Study, Tunnel
from .drawing import about_bands, about_singles, colour_of_cover, draw_bands, finish, line_of_cover, over_the_loss

SUBSURFACE = 0.5  # z/C of the second row of troughs


def largest(result: Result, ratio: float) -> np.ndarray:
    """The largest settlement at z/C = ratio over the volume loss [m]."""
    line = troughs.line_at(result, ratio)
    return np.array([line.settlement(i).max() for i in result.loss_increments])


def of_crown(result: Result) -> np.ndarray:
    """The settlement of the crown over the volume loss [m]; it is prescribed, eqs. (17) to (19)."""
    return settlements.on_axis(result, 1.0)


def draw_by_cover(study: Study, path: Path) -> None:
    """Figure 10: the largest settlement at several depths by cover, and the surface of all covers."""
    tunnels = study.covers()
    figure, axes = _row(len(tunnels) + 1)
    _by_depth(list(axes[:-1]), tunnels)
    for tunnel in tunnels:
        share = tunnel.over_loss(
            lambda member: np.divide(
                largest(member, 0.0),
                of_crown(member),
                out=np.full(len(member.volume_loss), np.nan),
                where=member.volume_loss > 0,
            )
        )
        draw_bands(
            axes[-1], 100 * tunnel.loss, share, colour_of_cover(tunnel), tunnel.label, line=line_of_cover(tunnel)
        )
    over_the_loss(axes[-1], "largest settlement of the\nsurface over the crown's  [-]", zero=True)
    axes[-1].set_title("surface, by cover")
    axes[-1].legend()
    figure.suptitle("Largest settlement at the depth $z$ below the surface", fontsize=12)
    finish(figure, path, about_bands(tunnels))


def draw_by_soil(study: Study, path: Path) -> None:
    """Figure 13: the same for several soils at one cover."""
    tunnels = study.soils()
    figure, axes = _row(len(tunnels))
    _by_depth(list(axes), tunnels)
    figure.suptitle("Largest settlement at the depth $z$ below the surface, by soil", fontsize=12)
    finish(figure, path, about_bands(tunnels))


def _row(count: int) -> tuple[Figure, np.ndarray]:
    figure, axes = plt.subplots(1, count, figsize=(5.0 * count, 4.8), squeeze=False, layout="constrained")
    return figure, axes[0]


def _by_depth(axes: Sequence[Axes], tunnels: Sequence[Tunnel]) -> None:
    highest = 0.0
    for axis, tunnel in zip(axes, tunnels):
        depths = tunnel.members[0].settings.depths
        for ratio, colour in zip(depths, colours("cividis", len(depths))):
            bands = tunnel.over_loss(partial(largest, ratio=ratio))
            label = f"{ratio:g}" + ("  (surface)" if ratio == 0 else "  (crown)" if ratio == 1 else "")
            draw_bands(axis, 100 * tunnel.loss, bands, colour, label, 1e3)
            highest = max(highest, float(1e3 * bands.members.max()))
        over_the_loss(axis, "largest settlement  $S$  [mm]")
        axis.set_title(tunnel.label)
    for axis in axes:
        axis.set_ylim(0, 1.04 * highest)
    axes[0].legend(title="$z/C$")


def draw_troughs(study: Study, path: Path) -> None:
    """Figure 11: troughs over the crown's settlement, at the shallowest and the deepest cover."""
    covers = study.covers()
    tunnels = [covers[0], covers[-1]] if len(covers) > 1 else covers
    figure, axes = plt.subplots(
        2,
        len(tunnels),
        figsize=(6.6 * len(tunnels), 8.6),
        squeeze=False,
        sharey="row",
        sharex=True,
        layout="constrained",
    )
    for column, tunnel in zip(axes.T, tunnels):
        for axis, ratio in zip(column, (0.0, SUBSURFACE)):
            _add_troughs(axis, tunnel, ratio)
            axis.set_title(f"{tunnel.label}, $z/C$ = {ratio:g}" + (" (surface)" if ratio == 0 else ""))
    for axis in axes[:, 0]:
        axis.set_ylabel("settlement over the crown's  [-]")
        axis.invert_yaxis()
    for axis in axes[-1]:
        axis.set_xlabel("distance from the tunnel axis  $x$  [m]")
    axes[0, 0].legend(title="$V_l$", loc="lower right")
    finish(
        figure,
        path,
        "Symbols: mean of the members, with the 95 % band of the mean as bars where there are members; lines: modified "
        "Gauss curve, eqs. (20), (21), fitted to the mean, dashed where its alpha lies at its bound (another shape).",
        about_singles(tunnels),
    )


def normalised_trough(tunnel: Tunnel, ratio: float, loss: float) -> tuple[np.ndarray, Bands]:
    """x [m] and the bands of the settlement over the crown's at z/C = ratio, at the state next to V_l = `loss`."""
    found = []
    for member in tunnel.members:
        away = np.where(member.volume_loss > 0, np.abs(member.volume_loss - loss), np.inf)  # none at V_l = 0
        k = int(np.argmin(away))
        line = troughs.line_at(member, ratio)
        found.append(line.settlement(member.loss_increments[k]) / of_crown(member)[k])
    x = troughs.line_at(tunnel.members[0], ratio).x
    if any(len(values) != len(x) for values in found):
        raise Missing(f"the members of {tunnel.name} have different meshes")
    return x, of_members(found)


def wanted_losses(tunnel: Tunnel, losses: Sequence[float]) -> list[float]:
    """The states next to these V_l, each of them once, without V_l = 0."""
    near = {tunnel.nearest(loss) for loss in losses if loss <= tunnel.loss[-1] + 1e-9}
    return sorted(loss for loss in near if loss > 0) or [float(tunnel.loss[-1])]


def _add_troughs(axis: Axes, tunnel: Tunnel, ratio: float) -> None:
    losses = wanted_losses(tunnel, tunnel.members[0].settings.field_losses)
    for loss, colour, marker in zip(losses, colours("viridis", len(losses)), MARKERS):
        x, bands = normalised_trough(tunnel, ratio, loss)
        curve = trough_fit.fit(x, bands.mean)
        fine = np.linspace(0, x.max(), 300)
        axis.plot(fine, curve(fine), "--" if curve.at_bound else "-", color=colour, linewidth=1.3)
        bars = bands.mean_half_width if tunnel.count > 1 else None
        axis.errorbar(
            x,
            bands.mean,
            yerr=bars,
            fmt=marker,
            color=colour,
            markersize=4,
            markerfacecolor="none",
            linewidth=0.8,
            capsize=1.5,
            label=percent(loss),
        )
    axis.set_xlim(0, 4 * tunnel.members[0].need("diameter")[0])


def widths(result: Result, ratio: float) -> np.ndarray:
    """K at z/C = ratio over the volume loss [-]; NaN at V_l = 0, which has no trough."""
    found = {loss: t.width for (z, loss), t in troughs.all_troughs(result).items() if z == ratio}
    return np.array([found.get(loss, np.nan) for loss in result.volume_loss])


def draw_widths(study: Study, path: Path) -> None:
    """Figure 12: K_s against V_l, and K against depth, with Mair and Taylor's range."""
    tunnels = study.covers()
    figure, axes = plt.subplots(1, 3, figsize=(16.5, 5.0), layout="constrained", width_ratios=[1.2, 1, 1])
    low, high = study.settings.range_of_k
    for tunnel in tunnels:
        bands = tunnel.over_loss(lambda member: widths(member, 0.0))
        draw_bands(axes[0], 100 * tunnel.loss, bands, colour_of_cover(tunnel), tunnel.label, line=line_of_cover(tunnel))
    axes[0].axhspan(low, high, color="0.88", zorder=0, label=f"Mair and Taylor, {low:g} to {high:g}")
    over_the_loss(axes[0], "width of the surface trough  $K_s$  [-]", zero=True)
    axes[0].legend()
    last = min(tunnel.loss[-1] for tunnel in tunnels)
    for axis, wanted in zip(axes[1:], (0.25 * last, last)):
        axis.axvspan(low, high, color="0.88", zorder=0)
        for tunnel, marker in zip(tunnels, MARKERS):
            _add_depths(axis, tunnel, tunnel.nearest(wanted), marker)
        axis.set_title(f"$V_l$ = {percent(tunnels[0].nearest(wanted))}")
        axis.invert_yaxis()
        axis.set_xlabel("width  $K = i / (z_t - z)$  [-]")
        axis.set_ylabel("depth over cover  $z/C$  [-]")
    right = max(axis.get_xlim()[1] for axis in axes[1:])
    for axis in axes[1:]:
        axis.set_xlim(0, right)
    figure.suptitle(
        "Widths of the settlement troughs; grey: Mair and Taylor's range for cohesionless soils", fontsize=12
    )
    finish(figure, path, about_bands(tunnels))


def _add_depths(axis: Axes, tunnel: Tunnel, loss: float, marker: str) -> None:
    depths = np.array(tunnel.members[0].settings.depths)
    row = int(np.argmin(np.abs(tunnel.loss - loss)))
    bands = of_members([[widths(member, z)[tunnel.rows(member)[row]] for z in depths] for member in tunnel.members])
    colour = colour_of_cover(tunnel)
    if tunnel.count > 1:
        axis.fill_betweenx(
            depths,
            bands.mean - bands.mean_half_width,
            bands.mean + bands.mean_half_width,
            color=colour,
            alpha=0.2,
            linewidth=0,
        )
        for member in bands.members:
            axis.plot(member, depths, color=colour, linewidth=0.4)
    axis.plot(bands.mean, depths, line_of_cover(tunnel), marker=marker, color=colour, label=tunnel.label, markersize=5)
