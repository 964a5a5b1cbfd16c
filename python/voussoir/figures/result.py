"""The results of a run as figures need them: voussoir.results with the places and volume losses that figures show."""

from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from pathlib import Path
from typing import TypeVar

import numpy as np

from ..errors import Missing, Unreadable
from ..files import check_format, plain, reading
from ..increments import Increment, Snapshot
from ..results import Result as AnyResult
from .settings import Settings
from .soils import Curve, State, curve_of, name_of, nearest_soil, state_of

__all__ = ["Increment", "Missing", "Result", "RunIndex", "Snapshot", "Unreadable", "check_format", "plain", "reading"]

LENGTHS = ("surface_y", "diameter", "axis_depth", "width", "height")  # of the geometry, which must be positive

T = TypeVar("T")


class RunIndex(AnyResult):
    """A run of any kind, its soil by the study's names, and the note below its figures."""

    def draw_note(self) -> str:
        """What a single run leaves open, for the foot of its figures; empty where nothing was measured."""
        return ""

    @property
    def soil(self) -> str:
        """The name of the soil: one of the study's where it is the study's soil ("dense sand"), else "own sand" or "own
        gravel"; "no grains" for an elastic solid."""
        return self._told_by(name_of)

    @property
    def nearest_soil(self) -> str:
        """The study's soil that is nearest to this one, as the case describes it: the study's trends differ among its
        soils. "no grains" for an elastic solid."""
        return self._told_by(nearest_soil)

    def _told_by(self, tell: Callable[[Curve, State], str]) -> str:
        """What is told of the grading and the density of the case's soil."""
        if self.case.get("material", "grains") != "grains":
            return "no grains"
        return tell(curve_of(self.case.get("soil", {})), state_of(self.case.get("packing", {})))


class Result(RunIndex):
    """Mesh and increments of a run; `settings` hold the places and volume losses that figures show."""

    def __init__(self, folder: Path | str, settings: Settings | None = None) -> None:
        self.settings = settings or Settings()
        super().__init__(folder)
        if not self.has_mesh:
            raise Missing(f"{self.folder}: the run has no mesh")
        if not self.increments:
            column = self.folder / "column"
            further = f"; its column is a run of its own, {column}" if (column / "run.h5").exists() else ""
            first = f" ({self.left_out[0]})" if self.left_out else ""
            raise Missing(f"{self.folder}: the run has no increments that can be drawn{first}{further}")
        self._histories: dict[str, np.ndarray] = {}

    def draw_note(self) -> str:
        """What a single run leaves open, for the foot of its figures; empty where nothing was measured."""
        scatter: Mapping[str, np.ndarray] = self.tables.get("draw_scatter", {})
        names = {"settlement": "the settlement", "reaction": "the ground reaction", "k0": "K0"}
        if not all(len(scatter.get(name, ())) == 1 for name in names):
            return ""
        parts = [f"{said} by {100 * scatter[name][0]:.0f} %" for name, said in names.items()]
        of_other_soil = "" if self.soil == "dense sand" else " in dense sand, not in this soil"
        return (
            f"One draw of the packings: another one moves {', '.join(parts)} (standard deviations{of_other_soil}, "
            "docs/validation/trust.md); `voussoir ensemble` gives bands."
        )

    def need(self, *names: str) -> list[float]:
        """Numbers of the mesh's geometry."""
        if not self.has_mesh:
            raise Missing("the run has no mesh")
        for name in names:
            if name not in self.geometry:
                raise Missing(f"the run's ground has no {name} (run.h5:/mesh/geometry)")
            if not np.isfinite(self.geometry[name]) or (name in LENGTHS and self.geometry[name] <= 0):
                raise Missing(f"the ground has an impossible {name}: {self.geometry[name]} (run.h5:/mesh/geometry)")
        return [self.geometry[name] for name in names]

    @cached_property
    def loss_increments(self) -> list[Increment]:
        """Increments of the volume loss, with the one at V_l = 0 where it was written; at least one has V_l > 0. A
        scene may give this stage any name."""
        losing = [i["stage"] for i in self.increments if i["volume_loss"] > 0] if self.kind == "scene" else []
        found = self.stage(losing[0] if losing else "volume_loss")
        if found[-1]["volume_loss"] <= 0:
            raise Missing("no increment has a volume loss")
        return found

    @property
    def start(self) -> Increment:
        """The state at V_l = 0, with which figures compare."""
        first = self.loss_increments[0]
        if first["volume_loss"] != 0:
            raise Missing("the state at V_l = 0 was not written")
        return first

    @cached_property
    def volume_loss(self) -> np.ndarray:
        """V_l of `loss_increments` [-]."""
        return np.array([i["volume_loss"] for i in self.loss_increments])

    @property
    def is_whole(self) -> bool:
        """True where the mesh lies on both sides of a tunnel's axis x = 0, as a scene's full tunnel does."""
        x = self.coordinates[:, 0]
        return bool(x.min() < -1e-6 * np.ptp(x))

    def loss_history(self, name: str) -> np.ndarray:
        """A field over `loss_increments`, e.g. "gauss/stress": (increment, element, 4, components)."""
        if name not in self._histories:
            self._histories[name] = np.array([i.field(name) for i in self.loss_increments])
        return self._histories[name]

    def next_to(self, loss: float) -> Increment:
        """The increment of the volume loss whose V_l is nearest to this one [-]."""
        return self.loss_increments[int(np.argmin(np.abs(self.volume_loss - loss)))]

    def nearest(self, losses: Iterable[float]) -> list[Increment]:
        """The increments whose V_l > 0 lie nearest to the wanted ones [-], each of them once. An increment that is
        farther away than two increments are from each other is left out."""
        found = [i for i in self.loss_increments if i["volume_loss"] > 0]
        values = np.array([i["volume_loss"] for i in found])
        apart = np.max(np.diff(values, prepend=0))
        chosen = {int(np.argmin(np.abs(values - v))) for v in losses if np.min(np.abs(values - v)) <= apart * 1.001}
        return [found[k] for k in sorted(chosen)]

    @cached_property
    def losses(self) -> list[Increment]:
        """The increments for which troughs and profiles are drawn: four of them, unless an option names others."""
        wanted = self.settings.losses or tuple(self.volume_loss[-1] * np.array([0.25, 0.5, 0.75, 1]))
        found = self.nearest(wanted)
        if not found:
            raise Missing(f"no increment is near V_l = {', '.join(f'{100 * v:g} %' for v in wanted)}")
        return found

    @property
    def cover(self) -> float:
        """Depth of the crown below the surface [m]."""
        axis_depth, diameter = self.need("axis_depth", "diameter")
        return axis_depth - diameter / 2

    @property
    def crown_height(self) -> float:
        """y of the crown [m]."""
        axis_depth, diameter, surface_y = self.need("axis_depth", "diameter", "surface_y")
        return surface_y - axis_depth + diameter / 2

    def crown(self) -> int:
        """Node of the opening on the axis of symmetry, at the top."""
        self.need("diameter")
        nodes = self.boundaries.get("tunnel", self.boundaries.get("opening"))  # a scene has the names of its mesh
        if nodes is None:
            raise Missing("run.h5 has no boundary tunnel")
        return nodes[np.argmax(self.coordinates[nodes, 1])]


def remembered(result: object, what: str, make: Callable[[], T]) -> T:
    """A value that several figures need: it is computed once and kept with the result under the name `what`."""
    kept = result.__dict__.setdefault("_remembered", {})
    if what not in kept:
        kept[what] = make()
    return kept[what]
