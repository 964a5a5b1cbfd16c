"""The study's soils: its names of them, and how a result's soil is told."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from math import nan
from typing import Any

from .units import quantity

NAMES = {"dense sand": "CPS_D", "medium dense sand": "CPS_MD", "gravel": "CPG_D"}  # ours: the study's, in its order
GRAVEL_FROM = 10e-3  # diameter [m]: a soil with larger grains is gravel
LOOSE_FROM = 0.22  # 2D void ratio [-]: sand with a larger one is nearer to the study's medium dense sand
LOOSE_FRICTION_FROM = 0.1  # and so is sand that was consolidated with a larger friction [-]
SAME_SIZE = 0.01  # difference over the diameter within which a size is that of the study
SAME_SHARE = 0.005  # difference within which a share of the grading curve is that of the study
SAME_VOID_RATIO = 0.01  # and a void ratio; our packings of one recipe scatter by 0.003

Curve = Sequence[tuple[float, float]]  # diameters [m], ascending, and the share of smaller grains [-]
SAND = ((2e-3, 0.0), (4.75e-3, 1.0))
GRAVEL = ((2e-3, 0.0), (4.75e-3, 0.1558), (10e-3, 0.3567), (19e-3, 0.6001), (28e-3, 0.7897), (40e-3, 1.0))


@dataclass(frozen=True)
class State:
    """How dense a soil is: what its case or its packing tells."""

    void_ratio: float = 0  # 2D void ratio, that was wanted or reached [-]; 0 where it is not known
    friction: float | None = 0  # of the contacts while packings are consolidated [-]; None where it is not known
    rolls: bool = True  # grains roll freely meanwhile


@dataclass(frozen=True)
class StudySoil:
    curve: Curve
    state: State  # the study's void ratio at 1 kPa, and the friction with which it is reached


STUDY_SOILS = {
    "dense sand": StudySoil(SAND, State(0.184, 0.0)),
    "medium dense sand": StudySoil(SAND, State(0.252, 0.45)),
    "gravel": StudySoil(GRAVEL, State(0.116, 0.0)),
}


def curve_of(soil: Mapping[str, Any]) -> Curve:
    """The grading of a [soil] as a case file writes it; without a curve its least and its largest diameter."""
    sizes, shares = (list(_quantities(soil.get(key, []))) for key in ("sizes", "passing"))
    if not sizes:
        ends = [soil.get("size_minimum", "2 mm"), soil.get("size_maximum", "4.75 mm")]
        sizes, shares = sorted(_quantities(ends)) or [0.0], []
        shares = [0.0, 1.0] if len(sizes) == 2 else []
    return list(zip(sizes, shares if len(shares) == len(sizes) else [nan] * len(sizes)))


def state_of(packing: Mapping[str, Any]) -> State:
    """How dense the packings of a case are, as its [packing] tells: by a void ratio, by a friction, or not at all where
    other programs made them."""
    wanted, friction = (sum(_quantities([packing.get(key, 0)])) for key in ("void_ratio", "consolidation_friction"))
    is_recipe = not wanted and not packing.get("file")
    return State(wanted, friction if is_recipe else None, not packing.get("consolidation_rolling", False))


def _quantities(written: Iterable[Any]) -> Iterator[float]:
    """The quantities among what a case file lists, in SI units."""
    for one in written:
        with suppress(ValueError):
            yield quantity(one)


def nearest_soil(curve: Curve, state: State) -> str:
    """The one of NAMES that a soil is nearest to, which decides what its figures and its trends are compared with. It
    is no name of the soil."""
    if _is_gravel(curve):
        return "gravel"
    loose = state.void_ratio > LOOSE_FROM or (state.friction or 0) > LOOSE_FRICTION_FROM
    return "medium dense sand" if loose else "dense sand"


def name_of(curve: Curve, state: State) -> str:
    """One of NAMES where grading and density are those of the study's soil, else "own sand" or "own gravel": a soil of
    the user must not bear the study's name, whose angles and trends are not those of this soil, and nobody but the user
    knows which density is dense for it."""
    nearest = nearest_soil(curve, state)
    study = STUDY_SOILS[nearest]
    if _is_same_curve(curve, study.curve) and _is_same_state(state, study.state):
        return nearest
    return "own gravel" if _is_gravel(curve) else "own sand"


def _is_gravel(curve: Curve) -> bool:
    return curve[-1][0] > GRAVEL_FROM


def _is_same_curve(curve: Curve, study: Curve) -> bool:
    return len(curve) == len(study) and all(
        abs(size - wanted) <= SAME_SIZE * wanted and abs(share - part) <= SAME_SHARE
        for (size, share), (wanted, part) in zip(curve, study)
    )


def _is_same_state(state: State, study: State) -> bool:
    """A recipe is one soil under each pressure, although its void ratio falls with pressure."""
    by_recipe = state.friction == study.friction and (state.rolls or not state.friction)
    return by_recipe or abs(state.void_ratio - study.void_ratio) <= SAME_VOID_RATIO
