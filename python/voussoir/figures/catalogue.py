"""All figures and tables, by the name of their file, for each sort of source that `source.py` tells apart.

A function that finds no data for its figure raises Missing, and the figure is skipped with a line. A new figure needs
one line here. Names end in .png; `--format` replaces this.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from . import (
    calibration_figure,
    chains,
    convergence,
    earth_pressure,
    ensemble,
    fields,
    grading,
    ground,
    panels,
    paths,
    probe_figures,
    profiles,
    reaction,
    rotation,
    rve_size_figures,
    scene_boundaries,
    scene_ground,
    scene_lines,
    scene_needs,
    scene_records,
    scene_sweep,
    settlements,
    specimen,
    strength_figures,
    stresses,
    sweep_tests,
    table_two,
    trend_table,
    troughs,
    widths,
)
from .study.catalogue import OF_SWEEP

Figures = dict[str, Callable[[Any, Path], None]]

# Of a tunnel; a column and a specimen have some of them.
FIGURES: Figures = {
    "ground.png": ground.draw,
    "settlement_troughs.png": troughs.draw,
    "trough_widths.png": widths.draw,
    "settlement_growth.png": settlements.draw,
    "displacement.png": fields.draw_displacement,
    "deviatoric_strain.png": fields.draw_deviatoric_strain,
    "void_ratio.png": fields.draw_void_ratio,
    "grain_rotation.png": fields.draw_grain_rotation,
    "localisation.png": panels.draw,
    "ground_reaction.png": reaction.draw,
    "stress_profiles.png": profiles.draw,
    "stress_rotation.png": rotation.draw,
    "rve_paths.png": paths.draw,
    "rve_network.png": paths.draw_network,
    "force_chains.png": chains.draw,
    "geostatic_stress.png": stresses.draw,
    "k0.png": earth_pressure.draw,
    "convergence.png": convergence.draw,
}
TRENDS: Figures = {"trends.md": trend_table.write}

_OF_A_MESH: Figures = {
    name: FIGURES[name]
    for name in ("displacement.png", "deviatoric_strain.png", "void_ratio.png", "grain_rotation.png", "convergence.png")
}

# Of any scene; `scene_needs` says which of them a certain scene can have.
SCENE: Figures = {
    "mesh.png": scene_ground.draw_mesh,
    "boundary_curves.png": scene_boundaries.draw,
    "boundary_reactions.png": scene_boundaries.draw_reactions,
    "record_points.png": scene_records.draw_points,
    "record_regions.png": scene_records.draw_regions,
    "section_lines.png": scene_lines.draw,
    "stage_fields.png": scene_ground.draw_fields,
    **_OF_A_MESH,
    **{
        name: FIGURES[name]
        for name in ("k0.png", "settlement_troughs.png", "trough_widths.png", "settlement_growth.png")
    },
    "localisation.png": panels.draw,
    "ground_reaction.png": reaction.draw,
    "rve_paths.png": paths.draw,
    "force_chains.png": chains.draw,
}

BIAXIAL: Figures = {
    "biaxial_curves.png": strength_figures.draw_curves,
    "biaxial_strength.png": strength_figures.draw_plane,
    "biaxial_angles.png": strength_figures.draw_angles,
    "table_2.md": table_two.write,
}

# Of what a sweep holds: a figure for which it has no runs is skipped.
SWEEP: Figures = {
    "biaxial_curves.png": sweep_tests.draw_curves,
    "biaxial_strength.png": sweep_tests.draw_plane,
    "biaxial_angles.png": sweep_tests.draw_angles,
    "table_2.md": sweep_tests.write_table_two,
    "rve_size_variation.png": rve_size_figures.draw_variation,
    "rve_size_curves.png": rve_size_figures.draw_curves,
    "rve_size.md": rve_size_figures.write_table,
    "boundary_curves.png": scene_sweep.draw,
    **OF_SWEEP,
}

OF: dict[str, Figures] = {
    "a tunnel": FIGURES,
    "a column": {"k0.png": earth_pressure.draw, "geostatic_stress.png": stresses.draw, **_OF_A_MESH},
    "a scene": SCENE,
    "a biaxial specimen": {"specimen.png": specimen.draw, **_OF_A_MESH},
    "an ensemble": ensemble.FIGURES,
    "biaxial tests": BIAXIAL,
    "a calibration": {"calibration.png": calibration_figure.draw},
    "a probe": {"probe_responses.png": probe_figures.draw_responses, "probe_path.png": probe_figures.draw_path},
    "packings": {"grading.png": grading.draw, "packings.png": chains.draw_packings},
    "a sweep": SWEEP,
}


def figures_of(what: str) -> Figures:
    """The figures of one sort of source, with the trends where these are judged."""
    return {**OF[what], **TRENDS} if what == "a tunnel" else OF[what]


def figures_for(what: str, data: Any) -> Figures:
    """The figures that this source can have: those of its sort, without those that its case rules out. Figures whose
    data are missing although the case has them are among these."""
    everything = figures_of(what)
    if what == "a scene":
        return {name: draw for name, draw in everything.items() if scene_needs.can_have(data, name)}
    if what == "an ensemble":
        return {name: draw for name, draw in everything.items() if scene_needs.ensemble_can_have(data, name)}
    return everything


def stems() -> set[str]:
    """All names that `--only` may have."""
    return {Path(name).stem for what in OF for name in figures_of(what)}
