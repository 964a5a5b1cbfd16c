"""The ground before the loss (fig. 6): stress fields, stress and K0 on a vertical path, an RVE before and after
gravity."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from ...ensembles import Bands
from .. import chains, points, q8, stresses
from ..result import Missing
from ..style import CYCLE, DIVERGING, SEQUENTIAL
from .bands import of_members
from .data import Study, Tunnel
from .drawing import about_bands, about_members, draw_bands, finish
from .microstructure import NEAR, nearest_snapshot
from .paths import point

PATH = 1.0  # distance of the vertical path from the tunnel's axis, in D
TABLE_ROWS = 60  # stresses of the K0 curve


def draw(study: Study, path: Path) -> None:
    tunnel = study.main()
    figure = plt.figure(figsize=(16.0, 9.6), layout="constrained")
    above, below = figure.subfigures(2, 1)
    names = ((1, r"vertical  $\sigma_{yy}$"), (0, r"horizontal  $\sigma_{xx}$"), (2, r"shear  $\tau_{xy}$"))
    for axis, (component, name) in zip(above.subplots(1, 3), names):
        _add_field(axis, tunnel, component, f"{name}  [kPa]")
    axes = below.subplots(1, 4)
    _add_path(axes[0], tunnel)
    _add_ratio(axes[1], tunnel)
    _add_rves(list(axes[2:]), tunnel)
    figure.suptitle(f"Ground after gravity, {tunnel.label}", fontsize=12)
    shown = f"Fields: means of {tunnel.count} members." if tunnel.count > 1 else ""
    finish(figure, path, shown, about_bands([tunnel]), about_members([tunnel]) if tunnel.count > 1 else "")


def geostatic(tunnel: Tunnel) -> np.ndarray:
    """The stress after gravity at the Gauss points (member, element, 4, 3) [Pa], compression positive."""
    return np.array([-stresses.after_gravity(member).field("gauss/stress") for member in tunnel.members])


def _add_field(axis: Axes, tunnel: Tunnel, component: int, label: str) -> None:
    result = tunnel.members[0]
    values = geostatic(tunnel).mean(axis=0)[..., component].ravel() / 1e3
    patches = q8.gauss_patches(result.coordinates, result.connectivity).reshape(-1, 4, 2)
    shear = component == 2
    drawn = PolyCollection(
        list(patches), array=values, cmap=DIVERGING if shear else SEQUENTIAL, edgecolors="face", linewidths=0.3
    )
    limit = float(np.abs(values).max())
    drawn.set_clim(-limit if shear else 0, limit)
    axis.add_collection(drawn)
    axis.autoscale_view()
    axis.set_aspect("equal")
    axis.grid(False)
    axis.set_xlabel("$x$  [m]")
    axis.set_ylabel("height above the base  $y$  [m]")
    axis.figure.colorbar(drawn, ax=axis, label=label, shrink=0.8)


def _add_path(axis: Axes, tunnel: Tunnel) -> None:
    """Stresses at the points next to a vertical line, with the weight above them."""
    result = tunnel.members[0]
    unit_weight, surcharge, surface_y, diameter = result.need("unit_weight", "surcharge", "surface_y", "diameter")
    where = points.original_points(result)
    heights = np.arange(0.25, surface_y, 0.5)
    chosen = np.unique([points.nearest(result, "", PATH * diameter, float(y)).index for y in heights])
    chosen = chosen[np.argsort(-where[chosen, 1])]
    depth = surface_y - where[chosen, 1]
    stress = geostatic(tunnel).reshape(tunnel.count, -1, 3)[:, chosen] / 1e3
    weight = (unit_weight * depth + surcharge) / 1e3
    axis.plot(weight, depth, color="black", linewidth=1.2, label=r"$\gamma z$ + surcharge")
    for component, colour, name in ((1, CYCLE[0], r"$\sigma_{yy}$"), (0, CYCLE[3], r"$\sigma_{xx}$")):
        bands = of_members(stress[..., component])
        bars = bands.mean_half_width if tunnel.count > 1 else None
        axis.errorbar(bands.mean, depth, xerr=bars, fmt=".", color=colour, markersize=5, linewidth=0.8, label=name)
    axis.invert_yaxis()
    axis.set_xlim(left=0)
    axis.set_xlabel("stress  [kPa]")
    axis.set_ylabel("depth  $z$  [m]")
    axis.set_title(f"at the points next to $x$ = {PATH:g} $D$")
    axis.legend()


def ratio_curve(tunnel: Tunnel) -> tuple[np.ndarray, Bands]:
    """Vertical stresses [Pa], and K0 of the column at them, interpolated between the rows of the members' tables."""
    tables = []
    for member in tunnel.members:
        if "k0" not in member.tables:
            raise Missing(f"{member.folder / 'run.h5'} has no table k0")
        tables.append(member.tables["k0"])
    low = max(float(table["vertical_stress"].min()) for table in tables)
    high = min(float(table["vertical_stress"].max()) for table in tables)
    stress = np.geomspace(low, high, TABLE_ROWS)
    return stress, of_members([np.interp(stress, t["vertical_stress"], t["ratio"]) for t in tables])


def _add_ratio(axis: Axes, tunnel: Tunnel) -> None:
    stress, bands = ratio_curve(tunnel)
    draw_bands(axis, stress / 1e3, bands, CYCLE[0], "column without the tunnel")
    far = stresses.far_from_opening(
        tunnel.members[0], q8.gauss_coordinates(tunnel.members[0].coordinates, tunnel.members[0].connectivity)
    )
    mean = geostatic(tunnel).mean(axis=0)[far]
    axis.plot(mean[:, 1] / 1e3, mean[:, 0] / mean[:, 1], ".", color="0.6", markersize=2, zorder=0, label="Gauss points")
    axis.set_xscale("log")
    stresses.plain_ticks(axis, stress / 1e3)
    axis.tick_params(axis="x", labelsize=9)
    axis.set_ylim(0.2, 1.1)
    axis.set_xlabel(r"vertical stress  $\sigma_{yy}$  [kPa]")
    axis.set_ylabel(r"$K_0 = \sigma_{xx} / \sigma_{yy}$  [-]")
    axis.legend()


def _add_rves(axes: list[Axes], tunnel: Tunnel) -> None:
    """The RVE at Aa at the first state that was written and after gravity."""
    result = tunnel.representative
    (diameter,) = result.need("diameter")
    name = nearest_snapshot(result, point(result, "Aa").position, NEAR * diameter)[1]
    states = [i for i in result.stage("gravity", "column") if name in i.snapshots]
    if name is None or len(states) < 2:
        for axis in axes:
            axis.set_axis_off()
        axes[0].text(0.5, 0.5, "No RVE near Aa was written\ngrain by grain (output.rves).", ha="center", va="center")
        return
    for axis, state, when in zip(axes, (states[0], states[-1]), ("early in gravity", "after gravity")):
        chains.draw_rve(axis, state.snapshot(name))
        axis.set_title(f"RVE at Aa {when},\nload parameter {state['load_parameter']:.2g}", fontsize=10)
        axis.set_xlabel(chains.COLOURS_OF_FORCES, fontsize=8)
