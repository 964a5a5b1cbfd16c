"""The ground for the page: mesh, displacements and fields over the increments of the last stage."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from voussoir.figures import q8, regions, scene
from voussoir.figures.fields import since_start
from voussoir.figures.paths import LEAST_PRESSURE
from voussoir.figures.result import Increment, Missing, Result

from .fields import COMPUTED, FIELDS, Field, described
from .pack import Blob, pack, pack_numbers

STAGES = ("volume_loss", "biaxial_bvp", "gravity", "column")  # the first that the run has is shown
LOADS = {  # label, unit and factor of the slider
    "volume_loss": ("volume loss V_l", "%", 100.0),
    "biaxial_bvp": ("displacement of the top over the height", "%", 100.0),
    "gravity": ("load factor of gravity", "-", 1.0),
    "column": ("load factor of gravity", "-", 1.0),
    "scene": ("stage and load parameter", "-", 1.0),
}
MOST_VALUES = 400_000  # frames × points of a field; a longer run is thinned so that the page keeps its size


@dataclass
class States:
    """One set of fields over the frames, in SI: `nodes` are the displacements (frame, node, 2)."""

    title: str
    nodes: np.ndarray
    points: dict[str, np.ndarray] = field(default_factory=dict)  # of the fields with data: (frame, point)
    bits: int = 16
    note: str = ""
    band: bool = False  # half widths, which have no sign; those of |u| and q/p do not follow from the fields


def stage_of(result: Result) -> tuple[str, list[Increment]]:
    """The stage that the page shows, and its increments; of a scene all stages, as the stage "scene"."""
    if result.kind == "scene":
        return "scene", result.increments
    for name in STAGES:
        found = [i for i in result.increments if i["stage"] == name]
        if found and (name != "volume_loss" or found[-1]["volume_loss"] > 0):
            return name, found
    raise Missing("the run has no increment of a stage that can be shown")


def thinned(count: int, points: int) -> np.ndarray:
    """Which of the increments become frames; the first and the last always do."""
    most = max(2, MOST_VALUES // max(points, 1))
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))


def loads_of(stage: str, result: Result, increments: Sequence[Increment]) -> np.ndarray:
    """The load parameters; of a scene with the number of the stages before."""
    if stage != "scene":
        return np.array([i["load_parameter"] for i in increments])
    every = np.concatenate([scene.progress(part) for part in scene.stages(result)])
    of = {i["index"]: load for i, load in zip(result.increments, every)}
    return np.array([of[i["index"]] for i in increments])


def parts_of_scene(result: Result, increments: Sequence[Increment]) -> dict[str, Any]:
    """What the view of a scene has besides: names of its states, sides between regions with their two elements, and
    which elements are there (only where some are dug out)."""
    names = [f"{i['stage'].replace('_', ' ')}, load parameter {i['load_parameter']:.4g}" for i in increments]
    parts: dict[str, Any] = {"names": names, "scene": True}
    between = regions.interfaces_with_elements(result)
    if len(between):
        parts["interfaces"] = between.tolist()
    there = np.array([regions.alive(result, i) for i in increments])
    if not there.all():
        parts["there"] = pack(there.astype(float), 8)
    return parts


def states_of_run(increments: Sequence[Increment], title: str, result: Result | None = None) -> States:
    """Fields that one of the increments lacks are left out. A scene must be given as `result`."""
    nodes = np.array([i.field("node/displacement") for i in increments])
    present = set.intersection(*(i.names for i in increments))
    states = States(title, nodes)
    for wanted in FIELDS:
        if wanted.data in present:
            values = np.array([component(i.field(wanted.data), wanted) for i in increments])
            if wanted.name == "grain_rotation" and result is not None and result.kind == "scene":
                values = np.array([component(since_start(result, wanted.data, i), wanted) for i in increments])
            elif wanted.name == "grain_rotation" and increments[0]["stage"] == "volume_loss":
                values -= values[:1]  # as in all figures, rotations are counted from V_l = 0
            states.points[wanted.name] = values
    return states


def component(values: np.ndarray, wanted: Field) -> np.ndarray:
    """One component of a field (element, 4[, components]) as one number a point."""
    return values.reshape(values.shape[0] * values.shape[1], -1)[:, wanted.component]


def missing_fields(states: States) -> list[str]:
    """Fields of every run of grains that these states lack, by their labels."""
    usual = [f for f in FIELDS if f.data and f.bits == 16] + [f for f in FIELDS if f.name == "coordination"]
    return [f.label for f in usual if f.name not in states.points]


def shown(result: Result, stage: str, loads: np.ndarray, sets: Sequence[States]) -> dict[str, Any]:
    """All that the ground view needs, for JSON."""
    label, unit, factor = LOADS[stage]
    offered = [f for f in FIELDS if _has(sets[0], f)]
    return {
        "x": pack(result.coordinates[None, :, 0]),
        "y": pack(result.coordinates[None, :, 1]),
        "connectivity": pack_numbers(result.connectivity),
        "weights": np.round(q8.shape(q8.GAUSS[:, 0], q8.GAUSS[:, 1]), 9).tolist(),
        "loads": [float(f"{factor * load:.6g}") for load in loads],
        "load": {"label": label, "unit": unit},
        "fields": [described(f) for f in offered],
        "sets": [_packed(result, states, offered) for states in sets],
        "least_pressure": LEAST_PRESSURE,
    }


def _has(states: States, wanted: Field) -> bool:
    if states.band and wanted.name in ("displacement", "stress_ratio"):
        return False
    if wanted.name == "stress_ratio":
        return {"mean_stress", "deviatoric_stress"} <= states.points.keys()
    return wanted.name in COMPUTED or wanted.name in states.points


def _packed(result: Result, states: States, offered: Sequence[Field]) -> dict[str, Any]:
    bits = states.bits
    blobs: dict[str, Blob] = {
        "ux": pack(states.nodes[..., 0], bits),
        "uy": pack(states.nodes[..., 1], bits),
    }
    limits = {}
    for wanted in offered:
        if wanted.name in states.points:
            blobs[wanted.name] = pack(states.points[wanted.name], min(bits, wanted.bits), wanted.scale)
        if _has(states, wanted):
            symmetric = wanted.symmetric and not states.band
            limits[wanted.name] = colour_limits(_values(result, states, wanted), symmetric)
    return {"title": states.title, "note": states.note, "band": states.band, "blobs": blobs, "limits": limits}


def _values(result: Result, states: States, wanted: Field) -> np.ndarray:
    """The values that the colours show, in the unit of the field."""
    if wanted.name in states.points:
        factor = abs(wanted.factor) if states.band else wanted.factor
        return factor * states.points[wanted.name]
    if wanted.name == "stress_ratio":
        p, q = states.points["mean_stress"], states.points["deviatoric_stress"]
        return np.divide(q, p, out=np.full_like(p, np.nan), where=p > LEAST_PRESSURE)
    u = np.einsum("gn,fenk->fegk", q8.shape(q8.GAUSS[:, 0], q8.GAUSS[:, 1]), states.nodes[:, result.connectivity])
    of: dict[str, Callable[[], np.ndarray]] = {
        "displacement": lambda: np.hypot(u[..., 0], u[..., 1]),
        "settlement": lambda: u[..., 1] if states.band else -u[..., 1],
        "sideways": lambda: u[..., 0],
    }
    return of[wanted.name]()


def colour_limits(values: np.ndarray, symmetric: bool) -> list[float]:
    """Limits of the colours over all frames, without the most extreme 0.1 %: one RVE must not dim the others."""
    finite = values[np.isfinite(values)]
    if finite.size == 0:
        return [0.0, 1.0]
    if symmetric:
        high = float(np.quantile(np.abs(finite), 0.999)) or 1e-12
        return [-high, high]
    low, high = (float(q) for q in np.quantile(finite, [0.001, 0.999]))
    return [low, high if high > low else low + max(1e-12, 1e-6 * abs(low))]
