"""A run's files as arrays. Dataset names and shapes: docs/reference/files.md."""

import os
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

import h5py
import numpy as np

from .settings import Settings
from .soils import Curve, State, curve_of, name_of, nearest_soil, state_of

FORMAT_VERSION = 1  # of docs/reference/files.md
KINDS = (
    "figures are drawn from runs of the kinds scene, tunnel, column, biaxial_bvp, biaxial, calibrate and probe, of "
    "packings (files or their folder), ensembles and sweeps"
)

LENGTHS = ("surface_y", "diameter", "axis_depth", "width", "height")  # of the geometry, which must be positive

Snapshot = dict[str, np.ndarray]  # arrays of one RVE, by the names of docs/reference/files.md
T = TypeVar("T")


class Missing(Exception):
    """The result lacks data that a figure needs; the message names these data."""


class Unreadable(Missing):
    """A file of the run cannot be read; the message names it and the reason."""


@contextmanager
def reading(path: Path) -> Iterator[h5py.File]:
    """An HDF5 file. Whatever h5py, TOML and texts raise where a file is damaged becomes Unreadable."""
    try:
        if path.exists() and not path.is_file():  # HDF5 would wait for a pipe
            raise Unreadable(f"{path} cannot be read: it is a folder, a pipe or a device")
        with h5py.File(path, "r") as file:
            yield file
    except Missing:
        raise
    except (OSError, KeyError, RuntimeError, ValueError, TypeError) as error:
        number = error.errno if isinstance(error, OSError) else None
        reason = os.strerror(number) if number else f"it is damaged, or no HDF5 file ({' '.join(str(error).split())})"
        raise Unreadable(f"{path} cannot be read: {reason}") from error


def check_format(file: h5py.File, path: Path, wanted: str) -> None:
    """Refuses a file that another program has written, or a later version of this one."""
    found, version = plain(file.attrs.get("format", "")), file.attrs.get("format_version", 0)
    if found != wanted:
        raise Unreadable(f'{path} is no "{wanted}" of this program')
    if version > FORMAT_VERSION:
        raise Unreadable(f"{path} has the format version {version}; these tools know {FORMAT_VERSION}")


class Increment:
    """One increment's file, whose data are read when they are needed."""

    def __init__(self, path: Path) -> None:
        self.path = path
        with reading(path) as file:
            check_format(file, path, "voussoir increment")
            self.attributes = {name: plain(value) for name, value in file.attrs.items()}
            self.names = {
                f"{group}/{name}"
                for group in ("node", "gauss", "element", "rve")
                if group in file
                for name in file[group]
            }
            self.snapshots = sorted(file["snapshots"]) if "snapshots" in file else []
        self["stage"], self["volume_loss"]  # every figure needs both

    def __getitem__(self, attribute: str) -> Any:
        if attribute not in self.attributes:
            raise Missing(f"{self.path} has no attribute {attribute}")
        return self.attributes[attribute]

    def field(self, name: str) -> np.ndarray:
        """Values of e.g. "gauss/stress" (element, 4, components), without the last axis where there is one
        component."""
        if name not in self.names:
            raise Missing(f"{self.path} has no {name}")
        with reading(self.path) as file:
            values = file[name][()]
        return values[..., 0] if values.shape[-1] == 1 else values

    def snapshot(self, name: str) -> Snapshot:
        """Arrays of one RVE, by the names of docs/reference/files.md."""
        if name not in self.snapshots:
            raise Missing(f"{self.path} has no snapshot {name}")
        with reading(self.path) as file:
            return {key: data[()] for key, data in file[f"snapshots/{name}"].items()}


class RunIndex:
    """What `run.h5` of a run of any kind holds: its kind, its case and its tables."""

    def __init__(self, folder: Path | str) -> None:
        self.folder = Path(folder)
        self.left_out: list[Missing] = []  # why a file of the run could not be read
        index = self.folder / "run.h5"
        _check_folder(self.folder, index)
        with reading(index) as file:
            check_format(file, index, "voussoir run")
            self.case = tomllib.loads(plain(file["input"][()])) if "input" in file else {}
            self.has_mesh = "mesh" in file
            provenance = file["provenance"].attrs if "provenance" in file else {}
            self.kind = plain(provenance.get("case_kind", self.case.get("kind", "tunnel")))
            self.tables = {
                name: {column: values[()] for column, values in table.items()}
                for name, table in file.get("tables", {}).items()
            }
            self._read_further(file)

    def _read_further(self, file: h5py.File) -> None:
        """For what only some kinds have."""

    def table(self, name: str, *columns: str) -> dict[str, np.ndarray]:
        """A table, which must have these columns."""
        index = self.folder / "run.h5"
        if name not in self.tables:
            raise Missing(f"{index} has no table {name}")
        for column in columns:
            if column not in self.tables[name]:
                raise Missing(f"{index}: the table {name} has no column {column}")
        return self.tables[name]

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
        self.increments: list[Increment] = []
        super().__init__(folder)
        for path in _increment_files(self.folder / "increments"):
            try:
                self.increments.append(Increment(path))
            except Missing as reason:
                self.left_out.append(reason)
        if not self.has_mesh:
            raise Missing(f"{self.folder}: the run has no mesh")
        if not self.increments:
            column = self.folder / "column"
            further = f"; its column is a run of its own, {column}" if (column / "run.h5").exists() else ""
            first = f" ({self.left_out[0]})" if self.left_out else ""
            raise Missing(f"{self.folder}: the run has no increments that can be drawn{first}{further}")
        self._histories: dict[str, np.ndarray] = {}

    def _read_further(self, file: h5py.File) -> None:
        if self.has_mesh:
            mesh = file["mesh"]
            self.coordinates = mesh["coordinates"][()]
            self.connectivity = mesh["connectivity"][()]
            self.boundaries = {name: nodes[()] for name, nodes in mesh["boundaries"].items()}
            self.points = {name: int(node) for name, node in mesh["points"].attrs.items()} if "points" in mesh else {}
            self.geometry = {name: float(value) for name, value in mesh["geometry"].attrs.items()}
            # Region of each element, and their names; None where the mesh has one region only.
            self.regions = mesh["regions"][()].ravel() if "regions" in mesh else None
            self.region_names = [str(plain(name)) for name in mesh["region_names"][()]] if "regions" in mesh else []

    def draw_note(self) -> str:
        """What a single run leaves open, for the foot of its figures; empty where nothing was measured."""
        scatter = self.tables.get("draw_scatter", {})
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

    def stage(self, *names: str) -> list[Increment]:
        """Increments of the first of these stages that exists."""
        for name in names:
            found = [i for i in self.increments if i["stage"] == name]
            if found:
                return found
        raise Missing(f"there is no stage {' or '.join(names)}")

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

    def history(self, name: str) -> np.ndarray:
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


def _check_folder(folder: Path, index: Path) -> None:
    try:
        there = index.exists()
    except OSError as error:
        raise Unreadable(f"{folder} cannot be read: {error.strerror}") from error
    if there:
        return
    if folder.is_file():
        raise Unreadable(f"{folder} is a file, not the folder of a run")
    if not folder.exists():
        raise Unreadable(f"{folder} does not exist")
    raise Unreadable(f"{folder} has no run.h5: {KINDS}")


def _increment_files(folder: Path) -> list[Path]:
    """The folder's files are read, not the links of run.h5: a killed run may have one increment more than its index."""
    try:
        found = [p for p in folder.iterdir() if re.fullmatch(r"\d+\.h5", p.name)]
    except FileNotFoundError:
        return []
    except OSError as error:
        raise Unreadable(f"{folder} cannot be read: {error.strerror}") from error
    return sorted(found, key=lambda p: int(p.stem))


def remembered(result: object, what: str, make: Callable[[], T]) -> T:
    """A value that several figures need: it is computed once and kept with the result under the name `what`."""
    kept = result.__dict__.setdefault("_remembered", {})
    if what not in kept:
        kept[what] = make()
    return kept[what]


def plain(value: Any) -> Any:
    return value.decode() if isinstance(value, bytes) else value
