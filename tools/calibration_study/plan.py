"""Which sets of parameters are tested, with which packings. A set holds for all three soils: its rolling limits are a
multiple of the printed coefficients of Table 1, so that gravel keeps more of it than sand."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from voussoir.figures.soils import NAMES
from voussoir.figures.table_two import STUDY

SOILS = tuple(name.lower() for name in NAMES.values())  # cps_d, cps_md, cpg_d, as in cases/soils
ANGLES = ("peak", "critical", "dilatancy")
TARGETS = {name.lower(): STUDY[soil] for soil, name in NAMES.items()}  # Table 2 of the study [degrees]
# Axial strain at the peak [%]: appendix A puts 2 % before and 5 % after the peaks of the dense soils.
PEAK_STRAIN = {"cps_d": (2.0, 5.0), "cpg_d": (2.0, 5.0)}
# The rolling coefficients that Table 1 prints: one class of sand; sand, fine and coarse gravel.
PRINTED = {"cps_d": (0.6,), "cps_md": (0.6,), "cpg_d": (0.6, 0.7, 0.8)}
PRESSURES = (100, 200, 400)  # [kPa]
# Where the search looks: rolling stiffness factor beta, rolling limit over the printed one, thickness [m].
BOX = {"beta": (0.02, 1.5), "limit": (0.15, 4.0), "thickness": (0.02, 0.4)}
UNLIMITED = 10.0  # a rolling limit that no contact reaches; the largest that the program takes

Values = tuple[float, ...]  # one, or one for each class of the soil's grains


@dataclass(frozen=True)
class Parameters:
    """Rolling stiffness factors and limits of the classes of one soil, and the thickness of the RVE [m]."""

    stiffness: Values
    limit: Values
    thickness: float = 0.1


@dataclass(frozen=True)
class Size:
    """How a group of runs is tested."""

    grains: dict[str, int]
    seeds: int
    inertial_number: dict[str, float]


@dataclass(frozen=True)
class Set:
    """One set of parameters with a name and its values for each soil."""

    name: str
    soils: dict[str, Parameters]


FULL = {"cps_d": 700, "cps_md": 700, "cpg_d": 1500}
SEARCH = Size({"cps_d": 700, "cps_md": 700, "cpg_d": 1000}, 5, {"cps_d": 3e-4, "cps_md": 3e-4, "cpg_d": 2e-4})
CONFIRM = Size(FULL, 10, {"cps_d": 2e-4, "cps_md": 2e-4, "cpg_d": 2e-4})
SLOW = Size(FULL, 10, {"cps_d": 1e-4, "cps_md": 1e-4, "cpg_d": 1e-4})  # as slow as the study's own tests


def joint(name: str, beta: float, limit: float, thickness: float) -> Set:
    """The same rolling stiffness factor for all grains, the printed limits times `limit`."""
    soils = {
        soil: Parameters((beta,), tuple(min(limit * x, UNLIMITED) for x in PRINTED[soil]), thickness) for soil in SOILS
    }
    return Set(name, soils)


def name_of(beta: float, limit: float, thickness: float) -> str:
    return f"b{beta:.4g}_e{limit:.4g}_t{thickness:.4g}"


def at(place: Sequence[float]) -> Set:
    """The set at a place of the box, rounded so that its name says all of it."""
    beta, limit, thickness = (float(f"{x:.3g}") for x in place)
    return joint(name_of(beta, limit, thickness), beta, limit, thickness)


def to_unit(place: Sequence[float]) -> np.ndarray:
    """Place in the box -> (3,), each from 0 to 1, even in the logarithm."""
    low, high = (np.array([side[k] for side in BOX.values()]) for k in (0, 1))
    return np.asarray(np.log(np.array(place) / low) / np.log(high / low))


def from_unit(unit: Sequence[float] | np.ndarray) -> tuple[float, float, float]:
    beta, limit, thickness = (low * (high / low) ** float(u) for u, (low, high) in zip(unit, BOX.values(), strict=True))
    return beta, limit, thickness


def space_filling(count: int, seed: int = 1, tries: int = 2000) -> np.ndarray:
    """(count, 3) places of the unit box: of many Latin hypercubes the one whose closest two places are farthest
    apart."""
    random = np.random.default_rng(seed)
    best: np.ndarray = np.empty((count, len(BOX)))
    widest = -1.0
    for _ in range(tries):
        cube = (np.stack([random.permutation(count) for _ in BOX], axis=1) + 0.5) / count
        apart = np.linalg.norm(cube[:, None] - cube[None], axis=2) + 9 * np.eye(count)
        if apart.min() > widest:
            best, widest = cube, float(apart.min())
    return best


def place_of(soil: str, values: Parameters) -> tuple[float, float, float] | None:
    """Stiffness, limit over the printed one and thickness; None outside the box or where classes have other values."""
    limit = values.limit[0] / PRINTED[soil][0]
    if len(set(values.stiffness)) > 1 or not np.allclose(values.limit, limit * np.array(PRINTED[soil])):
        return None
    place = (values.stiffness[0], limit, values.thickness)
    if any(not 0.999 * low <= x <= 1.001 * high for x, (low, high) in zip(place, BOX.values(), strict=True)):
        return None
    return place


def design(count: int = 24) -> list[Set]:
    """Sets all over the box."""
    return [at(from_unit(unit)) for unit in space_filling(count)]


def _elastic_plastic_spring(soil: str) -> Parameters:
    """Model C of Ai et al. (2011) as LIGGGHTS documents it: k_r = 2.25 k_n mu_r^2 R^2, |M| <= mu_r R F_n with
    1/R = 1/r1 + 1/r2; for equal grains R = r/2."""
    ratio = (0.5,) if soil != "cpg_d" else (0.5, 0.7, 0.8)  # k_t / k_n of the classes, Table 1
    printed = PRINTED[soil]
    return Parameters(tuple(2.25 * x**2 * 0.25 / k for x, k in zip(printed, ratio, strict=True)),
                      tuple(0.5 * x for x in printed))  # fmt: skip


def readings() -> list[Set]:
    """What "rolling resistance coefficient" may mean, at the thickness of 0.1 m, and the shipped sets."""

    def each(name: str, stiffness: float | None, limit: float | None) -> Set:
        """None: as printed."""

        def values(soil: str, given: float | None) -> Values:
            return PRINTED[soil] if given is None else (given,)

        return Set(name, {soil: Parameters(values(soil, stiffness), values(soil, limit)) for soil in SOILS})

    shipped = Set("shipped", {s: Parameters((0.03 if s == "cpg_d" else 0.1,), PRINTED[s]) for s in SOILS})
    spring = Set("spring_of_ai", {soil: _elastic_plastic_spring(soil) for soil in SOILS})
    return [
        shipped,
        joint("literal", 1.0, 1.0, 0.1),
        joint("yade_default_stiffness", 2.0, 1.0, 0.1),
        each("no_rolling_resistance", 0.0, 0.0),
        each("printed_is_stiffness", None, UNLIMITED),
        each("printed_is_both", None, None),
        joint("effective_radius", 0.25, 0.5, 0.1),
        spring,
        joint("soft", 0.1, 1.0, 0.1),
        each("soft_unlimited", 0.1, UNLIMITED),
        Set("stiffer_sand", {**shipped.soils, **{s: Parameters((0.2,), PRINTED[s]) for s in SOILS[:2]}}),
        joint("tenth_of_limit", 1.0, 0.1, 0.1),
        joint("quarter_of_limit", 1.0, 0.25, 0.1),
        # As thick as a grain: six times the steps, so without the gravel, which needs most.
        Set("grains_of_3.4_mm", {soil: Parameters((1.0,), PRINTED[soil], 0.0034) for soil in SOILS[:2]}),
    ]
