"""A run's files as arrays. Dataset names and shapes: io/FORMAT.md."""

import re
import tomllib
from collections.abc import Callable, Iterable
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

import h5py
import numpy as np

from .settings import Settings

MILLIMETRES = {"mm": 1.0, "cm": 10.0, "m": 1e3, "km": 1e6}

Snapshot = dict[str, np.ndarray]  # arrays of one RVE, by the names of io/FORMAT.md
T = TypeVar("T")


class Missing(Exception):
    """The result lacks data that a figure needs; the message names these data."""


class Increment:
    """One increment's file, whose data are read when they are needed."""

    def __init__(self, path: Path) -> None:
        self.path = path
        with h5py.File(path, "r") as file:
            self.attributes = {name: _plain(value) for name, value in file.attrs.items()}
            self.names = {
                f"{group}/{name}"
                for group in ("node", "gauss", "element", "rve")
                if group in file
                for name in file[group]
            }
            self.snapshots = sorted(file["snapshots"]) if "snapshots" in file else []

    def __getitem__(self, attribute: str) -> Any:
        return self.attributes[attribute]

    def field(self, name: str) -> np.ndarray:
        """Values of e.g. "gauss/stress" (element, 4, components), without the last axis where there is one
        component."""
        if name not in self.names:
            raise Missing(f"{self.path.name} has no {name}")
        with h5py.File(self.path, "r") as file:
            values = file[name][()]
        return values[..., 0] if values.shape[-1] == 1 else values

    def snapshot(self, name: str) -> Snapshot:
        """Arrays of one RVE, by the names of io/FORMAT.md."""
        with h5py.File(self.path, "r") as file:
            return {key: data[()] for key, data in file[f"snapshots/{name}"].items()}


class Result:
    """Mesh and increments of a run; `settings` hold the places and volume losses that figures show."""

    def __init__(self, folder: Path | str, settings: Settings | None = None) -> None:
        self.folder = Path(folder)
        self.settings = settings or Settings()
        # The folder's files are read, not the links of run.h5: a killed run may have one increment more than its index.
        paths = [p for p in (self.folder / "increments").glob("*.h5") if re.fullmatch(r"\d+", p.stem)]
        self.increments = [Increment(p) for p in sorted(paths, key=lambda p: int(p.stem))]
        with h5py.File(self.folder / "run.h5", "r") as file:
            self.case = tomllib.loads(_plain(file["input"][()])) if "input" in file else {}
            self.has_mesh = "mesh" in file
            if self.has_mesh:
                mesh = file["mesh"]
                self.coordinates = mesh["coordinates"][()]
                self.connectivity = mesh["connectivity"][()]
                self.boundaries = {name: nodes[()] for name, nodes in mesh["boundaries"].items()}
                self.geometry = {name: float(value) for name, value in mesh["geometry"].attrs.items()}
            self.tables = {
                name: {column: values[()] for column, values in table.items()}
                for name, table in file.get("tables", {}).items()
            }
        if not self.increments:
            raise Missing(
                "there are no increments yet"
                if self.has_mesh
                else "the run has no mesh: figures are of columns, tunnels and biaxial_bvp"
            )
        self._histories: dict[str, np.ndarray] = {}

    def need(self, *names: str) -> list[float]:
        """Numbers of the mesh's geometry."""
        if not self.has_mesh:
            raise Missing("the run has no mesh")
        for name in names:
            if name not in self.geometry:
                raise Missing(f"run.h5:/mesh/geometry has no attribute {name}")
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
        """Increments of the volume loss, with the one at V_l = 0 where it was written; at least one has V_l > 0."""
        found = self.stage("volume_loss")
        if found[-1]["volume_loss"] <= 0:
            raise Missing("no increment has a volume loss")
        return found

    @cached_property
    def volume_loss(self) -> np.ndarray:
        """V_l of `loss_increments` [-]."""
        return np.array([i["volume_loss"] for i in self.loss_increments])

    def history(self, name: str) -> np.ndarray:
        """A field over `loss_increments`, e.g. "gauss/stress": (increment, element, 4, components)."""
        if name not in self._histories:
            self._histories[name] = np.array([i.field(name) for i in self.loss_increments])
        return self._histories[name]

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
        if "tunnel" not in self.boundaries:
            raise Missing("run.h5 has no boundary tunnel")
        nodes = self.boundaries["tunnel"]
        return nodes[np.argmax(self.coordinates[nodes, 1])]

    @property
    def soil(self) -> str:
        """ "gravel", "medium dense sand", "dense sand", or "no grains" (an elastic solid), as the case describes it;
        the study's trends differ."""
        if self.case.get("material", "grains") != "grains":
            return "no grains"
        soil, packing = self.case.get("soil", {}), self.case.get("packing", {})
        sizes = [re.fullmatch(r"\s*(\S+?)\s*(mm|cm|m|km)\s*", str(size)) for size in soil.get("sizes", [])]
        if any(float(size[1]) * MILLIMETRES[size[2]] > 10 for size in sizes if size):
            return "gravel"
        loose = packing.get("void_ratio", 0) > 0.22 or packing.get("consolidation_friction", 0) > 0.1
        return "medium dense sand" if loose else "dense sand"


def remembered(result: Result, what: str, make: Callable[[], T]) -> T:
    """A value that several figures need: it is computed once and kept with the result under the name `what`."""
    kept = result.__dict__.setdefault("_remembered", {})
    if what not in kept:
        kept[what] = make()
    return kept[what]


def _plain(value: Any) -> Any:
    return value.decode() if isinstance(value, bytes) else value
