"""All figures of a run, by the name of their file."""

from . import (
    chains,
    convergence,
    fields,
    panels,
    paths,
    profiles,
    reaction,
    rotation,
    settlements,
    stresses,
    troughs,
    widths,
)

FIGURES = {
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
    "convergence.png": convergence.draw,
}
