"""Which figures a scene can have at all, as its case says it. A figure that the scene can have may still lack data: its
own function tells that."""

from collections.abc import Callable, Iterator
from typing import Any

from ..ensembles import Ensemble
from . import scene
from .result import Result
from .units import quantity


def _changes(result: Result | Ensemble, *names: str) -> Iterator[dict[str, Any]]:
    """The tables of these names in all stages of the case."""
    for stage in result.case.get("stage", []):
        for name in names:
            yield from stage.get(name, [])


def has_tunnel(result: Result) -> bool:
    """The mesh has a tunnel, and a stage takes area from it."""
    areas = [move["area"] for move in _changes(result, "move") if scene.is_written(move, "area")]
    return "diameter" in result.geometry and any(quantity(area) < 0 for area in areas)


def has_grains(result: Result) -> bool:
    regions = result.case.get("region", [])
    return result.case.get("material", "grains") == "grains" and any("elastic" not in region for region in regions)


def moves_a_boundary(result: Result | Ensemble) -> bool:
    return any(scene.names_in(change) for change in _changes(result, "move", "release"))


def has_k0(result: Result | Ensemble) -> bool:
    return any(press.get("at_rest") is True for press in _changes(result, "press"))


def _records(key: str) -> Callable[[Result], bool]:
    return lambda result: bool(scene.records(result, key))


def _tunnel_of_grains(result: Result) -> bool:
    return has_tunnel(result) and has_grains(result)


NEEDS: dict[str, Callable[[Result], bool]] = {
    "boundary_curves.png": moves_a_boundary,
    "record_points.png": _records("point"),
    "record_regions.png": _records("region"),
    "section_lines.png": _records("line"),
    "void_ratio.png": has_grains,
    "grain_rotation.png": has_grains,
    "k0.png": has_k0,
    "settlement_troughs.png": has_tunnel,
    "trough_widths.png": has_tunnel,
    "settlement_growth.png": has_tunnel,
    "localisation.png": has_tunnel,
    "ground_reaction.png": has_tunnel,
    "rve_paths.png": _tunnel_of_grains,
    "force_chains.png": _tunnel_of_grains,
}


def _is_a_tunnel_by_name(ensemble: Ensemble) -> bool:
    return any(stage.get("name") == "volume_loss" for stage in ensemble.case.get("stage", []))


OF_ENSEMBLE: dict[str, Callable[[Ensemble], bool]] = {
    "ensemble_settlement.png": _is_a_tunnel_by_name,
    "ensemble_ground_reaction.png": _is_a_tunnel_by_name,
    "ensemble_trough.png": _is_a_tunnel_by_name,
    "ensemble_trough_width.png": _is_a_tunnel_by_name,
    "ensemble_k0.png": has_k0,
    "ensemble_specimen.png": lambda _: False,
    "ensemble_boundaries.png": moves_a_boundary,
}


def can_have(result: Result, figure: str) -> bool:
    """Whether the figure with this file's name exists for the scene. A run without its case has all, as far as one can
    tell."""
    return not result.case or figure not in NEEDS or NEEDS[figure](result)


def ensemble_can_have(ensemble: Ensemble, figure: str) -> bool:
    """The same of an ensemble of scenes; ensembles of other kinds have all."""
    return ensemble.case.get("kind") != "scene" or figure not in OF_ENSEMBLE or OF_ENSEMBLE[figure](ensemble)
