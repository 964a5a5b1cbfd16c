"""Small ground views of a sweep's points: few states and few fields of one member, so that many fit into one page."""

from typing import Any

import numpy as np

from voussoir.figures.result import Missing, Result
from voussoir.figures.study.data import Tunnel

from . import ground
from .fields import FIELDS
from .run_page import first_point

KEPT = (  # besides the displacements
    "deviatoric_strain",
    "volumetric_strain",
    "void_ratio",
    "grain_rotation",
    "mean_stress",
    "deviatoric_stress",
    "rve_status",
)
BITS = 10
MOST_FRAMES = 11
ALL_VALUES = 1_200_000  # frames × points of all views together: about 5 MB


def frames_for(points: list[int]) -> int:
    """How many states each view may have, where the views have so many points; 0: not even two."""
    total = sum(points)
    frames = min(MOST_FRAMES, ALL_VALUES // total) if total else 0
    return frames if frames >= 2 else 0


def small(members: list[Result], frames: int) -> dict[str, Any]:
    """The ground of the member that represents a point: of a tunnel the one with the median settlement."""
    result = members[0]
    if len(members) > 1 and result.kind != "scene" and members[0].loss_increments:
        result = Tunnel("", members).representative
    stage, increments = ground.stage_of(result)
    # Even steps of the load, among them the last state.
    have = ground.loads_of(stage, result, increments)
    wanted = np.linspace(have[0], have[-1], frames)
    shown = [increments[k] for k in sorted({int(np.argmin(np.abs(have - load))) for load in wanted})]
    states = ground.states_of_run(shown, result.folder.name, result)
    names = {f.name for f in FIELDS if f.name in KEPT}
    states.points = {name: values for name, values in states.points.items() if name in names}
    states.bits = BITS
    packed = ground.shown(result, stage, ground.loads_of(stage, result, shown), [states])
    packed["tunnel"] = stage == "volume_loss"
    if stage == "scene":
        packed |= ground.parts_of_scene(result, shown)
    packed["first"] = first_point(result, "a tunnel" if packed["tunnel"] else "a scene" if stage == "scene" else "")
    return packed


def all_of(members: dict[str, list[Result]]) -> tuple[dict[str, dict[str, Any]], list[str]]:
    """The views by the names of the points, and why others are left out."""
    with_mesh = {name: found for name, found in members.items() if found}
    frames = frames_for([4 * len(found[0].connectivity) for found in with_mesh.values()])
    if not frames:
        reason = "the sweep has too many points for small views of the ground: make a report of a single point"
        return {}, [reason] if with_mesh else []
    views, left_out = {}, []
    for name, found in with_mesh.items():
        try:
            views[name] = small(found, frames)
        except Missing as reason:
            left_out.append(f"{name}: {reason}")
    return views, left_out
