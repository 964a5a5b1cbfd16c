"""The study's soils: its names of them, and how a result's soil is told."""

NAMES = {"dense sand": "CPS_D", "medium dense sand": "CPS_MD", "gravel": "CPG_D"}  # ours: the study's, in its order
GRAVEL_FROM = 10e-3  # diameter [m]: a soil with larger grains is gravel
LOOSE_FROM = 0.22  # 2D void ratio [-]: sand with a larger one is medium dense
LOOSE_FRICTION_FROM = 0.1  # and so is sand that was consolidated with a larger friction [-]
SIZES = {"dense sand": (2e-3, 4.75e-3), "medium dense sand": (2e-3, 4.75e-3), "gravel": (2e-3, 40e-3)}  # diameters [m]
SAME_SIZE = 0.01  # difference over the diameter within which a size is that of the study


def soil_of(largest: float, void_ratio: float, consolidation_friction: float) -> str:
    """One of NAMES, from the diameter of the largest grains [m] and from how a packing was made."""
    if largest > GRAVEL_FROM:
        return "gravel"
    loose = void_ratio > LOOSE_FROM or consolidation_friction > LOOSE_FRICTION_FROM
    return "medium dense sand" if loose else "dense sand"


def named(soil: str, smallest: float, largest: float) -> str:
    """The soil where its smallest and largest grains [m] are those of the study's soil, else "own gravel" and so on: a
    soil of the user must not bear the study's name, and the study's angles are not those of this soil."""
    if soil not in SIZES:
        return soil
    study = SIZES[soil]
    same = all(abs(one - other) <= SAME_SIZE * other for one, other in zip((smallest, largest), study))
    return soil if same else f"own {soil}"
