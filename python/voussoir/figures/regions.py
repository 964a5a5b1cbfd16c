"""The regions of a mesh, and the elements that a scene has dug out."""

from typing import Any

import numpy as np

from .result import Increment, Result, remembered

# Fields that are not a number in an element that has been dug out, and only there.
_EVERYWHERE = (
    "gauss/stress",
    "gauss/strain",
    "gauss/mean_stress",
    "gauss/deviatoric_strain",
    "gauss/deviatoric_stress",
)
SIDES = ((0, 4, 1), (1, 5, 2), (2, 6, 3), (3, 7, 0))  # corner, midside, corner of an element's sides


def alive(result: Result, increment: Increment) -> np.ndarray:
    """True for the elements that are still there (element)."""
    name = next((name for name in _EVERYWHERE if name in increment.names), None)
    if name is None:
        return np.ones(len(result.connectivity), dtype=bool)
    values = increment.field(name).reshape(len(result.connectivity), -1)
    return np.isfinite(values).any(axis=1)


def names_of(region: dict[str, Any]) -> list[str]:
    """The regions of the mesh that a table of the case names: one or several."""
    written = region.get("name", "ground")
    return [str(name) for name in written] if isinstance(written, list) else [str(written)]


def ground(result: Result) -> np.ndarray:
    """True for the elements outside of regions with an elastic material of their own, such as walls (element); for all
    where each region has one."""
    elastic = {name for entry in result.case.get("region", []) if "elastic" in entry for name in names_of(entry)}
    if result.regions is None or not result.region_names:
        return np.ones(len(result.connectivity), dtype=bool)
    inside = ~np.isin(result.regions, [k for k, name in enumerate(result.region_names) if name in elastic])
    return inside if inside.any() else ~inside


def _sides(connectivity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """All sides of the elements as their three nodes (side, 3), and the element of each (side)."""
    nodes = connectivity[:, np.array(SIDES)].reshape(-1, 3)
    return nodes, np.repeat(np.arange(len(connectivity)), len(SIDES))


def interfaces(result: Result, there: np.ndarray | None = None) -> np.ndarray:
    """Sides between two regions of the elements that are there, as their three nodes (side, 3)."""
    sides = interfaces_with_elements(result)
    if there is not None:
        sides = sides[there[sides[:, 3]] & there[sides[:, 4]]]
    return sides[:, :3]


def interfaces_with_elements(result: Result) -> np.ndarray:
    """Sides between two regions: three nodes and the two elements (side, 5)."""
    if result.regions is None:
        return np.zeros((0, 5), dtype=int)
    nodes, element = remembered(result, "sides", lambda: _sides(result.connectivity))
    # A midside node belongs to one side of one or two elements.
    order = np.argsort(nodes[:, 1], kind="stable")
    nodes, element = nodes[order], element[order]
    region = result.regions[element]
    between = np.flatnonzero((nodes[1:, 1] == nodes[:-1, 1]) & (region[1:] != region[:-1]))
    return np.column_stack([nodes[between], element[between], element[between + 1]])


def all_sides(result: Result) -> np.ndarray:
    """The three nodes of each side of each element (side, 3); a side between two elements is there twice."""
    return remembered(result, "sides", lambda: _sides(result.connectivity))[0]
