"""Fields over the deformed mesh at the end of the run."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation

from . import q8, regions, scene
from .resolution import percent
from .result import Increment, Missing, Result
from .style import DIVERGING, STRAIN, save


def last_increment(result: Result) -> Increment:
    if not result.has_mesh:
        raise Missing("the run has no mesh")
    return result.increments[-1]


def state(increment: Increment) -> str:
    """The state that a picture shows, as text for its title."""
    if increment["volume_loss"] > 0:
        return f"$V_l$ = {percent(increment['volume_loss'])}"
    return f"stage {increment['stage']}, load parameter {increment['load_parameter']:.3g}"


def since_start(result: Result, name: str, increment: Increment) -> np.ndarray:
    """A field at an increment. Grain rotations are counted from V_l = 0 within the volume loss, and in a scene from the
    last state whose displacements are zero."""
    values = increment.field(name)
    if name != "gauss/grain_rotation":
        return values
    if result.kind == "scene":
        start = scene.start_of_displacements(result, increment)
        return values if start is None else values - start.field(name)
    return values - result.start.field(name) if increment["volume_loss"] > 0 else values


def magnification(result: Result, displacement: np.ndarray) -> float:
    """1 where the deformation is visible, else a round factor that enlarges it to about 2 % of the width."""
    largest, width = np.max(np.linalg.norm(displacement, axis=1)), np.ptp(result.coordinates[:, 0])
    if not np.isfinite(largest):
        raise Missing("the displacement is not finite")
    if largest == 0 or largest > 0.005 * width:
        return 1
    factor = 0.02 * width / largest
    power = 10.0 ** np.floor(np.log10(factor))
    return float(max(m * power for m in (1, 2, 5) if m * power <= factor))


def canvas(result: Result, increment: Increment) -> tuple[Figure, Axes, np.ndarray, str]:
    """Figure with deformed edges of the elements that are not dug out, and of regions; returns (figure, axis, deformed
    coordinates, line on magnification).

    The line, which may be empty, goes below the first line of the title, beside the key of the arrows.
    """
    displacement = increment.field("node/displacement")
    factor = magnification(result, displacement)
    deformed = result.coordinates + factor * displacement
    wide, high = np.ptp(result.coordinates, axis=0)
    size = (8.2, float(np.clip(6.2 * high / wide, 1.8, 9.0)) + 1.2) if result.kind == "scene" else (7.4, 6.6)
    figure, axis = plt.subplots(figsize=size)
    there = regions.alive(result, increment)
    edges = LineCollection(
        list(q8.outlines(deformed, result.connectivity[there])), colors="0.5", linewidths=0.35, alpha=0.6, zorder=2
    )
    axis.add_collection(edges)
    draw_interfaces(axis, result, deformed, there)
    axis.set_aspect("equal")
    axis.grid(False)
    standing = deformed[np.unique(result.connectivity[there])]
    low, high = standing.min(axis=0), standing.max(axis=0)
    margin = 0.03 * np.max(high - low)
    axis.set_xlim(low[0] - margin, high[0] + margin)
    axis.set_ylim(low[1] - margin, high[1] + margin)
    tunnel = "diameter" in result.geometry
    axis.set_xlabel("distance from the tunnel axis  $x$  [m]" if tunnel else "$x$  [m]")
    axis.set_ylabel("height above the base  $y$  [m]")
    note = "" if factor == 1 else f"deformation × {factor:g}"
    return figure, axis, deformed, note


def draw_interfaces(axis: Axes, result: Result, deformed: np.ndarray, there: np.ndarray) -> None:
    """Lines between the regions of the ground, where there are several."""
    between = regions.interfaces(result, there)
    if len(between):
        axis.add_collection(LineCollection(list(deformed[between]), colors="black", linewidths=1.3, zorder=2.5))


def draw_displacement(result: Result, path: Path) -> None:
    increment = last_increment(result)
    figure, axis, deformed, note = canvas(result, increment)
    displacement = increment.field("node/displacement")
    size = np.linalg.norm(displacement, axis=1)
    there = regions.alive(result, increment)
    triangles = Triangulation(deformed[:, 0], deformed[:, 1], q8.triangles(result.connectivity[there]))
    standing = np.zeros(len(size), dtype=bool)
    standing[np.unique(result.connectivity[there])] = True
    size = np.where(standing, size, 0.0)
    # Where the displacement is the same everywhere (none, at a stage's start), it has no contours.
    filled = (
        axis.tricontourf(triangles, size, levels=21, cmap="viridis", zorder=1)
        if np.ptp(size) > 1e-9 * size.max()
        else axis.tripcolor(triangles, size, cmap="viridis", zorder=1)
    )
    figure.colorbar(filled, ax=axis, label="displacement  $|u|$  [m]", shrink=0.85)
    _add_arrows(axis, result, deformed, np.where(standing[:, None], displacement, 0.0))
    axis.set_title(f"Displacement, {state(increment)}\n{note}", loc="left")
    save(figure, path)


def _add_arrows(axis: Axes, result: Result, deformed: np.ndarray, displacement: np.ndarray) -> None:
    """Draws arrows at about one node per square of a coarse grid, so that fine parts of the mesh stay readable."""
    spacing = np.ptp(result.coordinates[:, 0]) / 22
    cells = np.floor(result.coordinates / spacing).astype(int)
    _, chosen = np.unique(cells, axis=0, return_index=True)
    size = np.linalg.norm(displacement, axis=1)
    chosen = chosen[size[chosen] > 0.01 * size.max()]
    if len(chosen) == 0:
        return
    arrows = axis.quiver(
        *deformed[chosen].T,
        *displacement[chosen].T,
        angles="xy",
        scale_units="xy",
        scale=size.max() / (2.2 * spacing),
        width=0.0028,
        color="white",
        edgecolor="black",
        linewidth=0.35,
        zorder=3,
    )
    axis.quiverkey(arrows, 0.86, 1.03, size.max(), f"{size.max():.2g} m", labelpos="E", color="black")


def _draw_points(
    result: Result,
    path: Path,
    name: str,
    label: str,
    title: str,
    colour_map: str,
    symmetric: bool = False,
    factor: float = 1.0,
) -> None:
    """Draws a Gauss-point field with one patch per point."""
    increment = last_increment(result)
    values = factor * since_start(result, name, increment)
    figure, axis, deformed, note = canvas(result, increment)
    patches = q8.gauss_patches(deformed, result.connectivity)
    there = regions.alive(result, increment)
    finite = values[np.isfinite(values)]
    limit = np.max(np.abs(finite)) if finite.size else 1.0
    limits = (-limit, limit) if symmetric else (finite.min(), finite.max()) if finite.size else (0, 1)
    collection = PolyCollection(
        list(patches[there].reshape(-1, 4, 2)),
        array=values[there].ravel(),
        cmap=colour_map,
        edgecolors="face",
        linewidths=0.6,
        zorder=1,
    )
    collection.set_clim(*limits)
    axis.add_collection(collection)
    figure.colorbar(collection, ax=axis, label=label, shrink=0.85)
    axis.set_title(f"{title}, {state(increment)}\n{note}".rstrip(), loc="left")
    save(figure, path)


def draw_deviatoric_strain(result: Result, path: Path) -> None:
    _draw_points(
        result,
        path,
        "gauss/deviatoric_strain",
        r"deviatoric strain  $\varepsilon_q$  [%]",
        "Deviatoric strain",
        STRAIN,
        factor=100,
    )


def draw_void_ratio(result: Result, path: Path) -> None:
    _draw_points(result, path, "gauss/void_ratio", "void ratio  $e$  [-]", "Void ratio", "viridis")


def draw_grain_rotation(result: Result, path: Path) -> None:
    _draw_points(
        result,
        path,
        "gauss/grain_rotation",
        "mean grain rotation, counter-clockwise positive  [deg]",
        "Grain rotation",
        DIVERGING,
        symmetric=True,
        factor=180 / np.pi,
    )
