"""A run's files as arrays. Dataset names and shapes: io/FORMAT.md."""

import re
from functools import cached_property
from pathlib import Path

import h5py
import numpy as np


class Missing(Exception):
    """The result does not hold what a figure needs; the message says what."""


class Increment:
    """One increment's file, read when asked."""

    def __init__(self, path):
        self.path = path
        with h5py.File(path, "r") as file:
            self.attributes = {name: _plain(value) for name, value in file.attrs.items()}
            self.names = {f"{group}/{name}" for group in ("node", "gauss", "element", "rve") if group in file
                          for name in file[group]}

    def __getitem__(self, attribute):
        return self.attributes[attribute]

    def field(self, name):
        """Values of e.g. "gauss/stress" (element, 4, components), without the last axis where there is one component."""
        if name not in self.names:
            raise Missing(f"{self.path.name} has no {name}")
        with h5py.File(self.path, "r") as file:
            values = file[name][()]
        return values[..., 0] if values.shape[-1] == 1 else values


class Result:
    """Mesh and increments of a run; `volume_loss` [%] chooses those of the troughs."""

    def __init__(self, folder, volume_loss=None):
        self.folder = Path(folder)
        self.wanted = volume_loss
        # The folder, not run.h5's links: a killed run may have one increment more than its index.
        paths = [p for p in (self.folder / "increments").glob("*.h5") if re.fullmatch(r"\d+", p.stem)]
        self.increments = [Increment(p) for p in sorted(paths, key=lambda p: int(p.stem))]
        with h5py.File(self.folder / "run.h5", "r") as file:
            self.has_mesh = "mesh" in file
            if self.has_mesh:
                mesh = file["mesh"]
                self.coordinates = mesh["coordinates"][()]
                self.connectivity = mesh["connectivity"][()]
                self.boundaries = {name: nodes[()] for name, nodes in mesh["boundaries"].items()}
                self.geometry = {name: float(value) for name, value in mesh["geometry"].attrs.items()}
            self.tables = {name: {column: values[()] for column, values in table.items()}
                           for name, table in file.get("tables", {}).items()}
        if not self.increments:
            raise Missing("there are no increments yet")

    def need(self, *names):
        """Numbers of the mesh's geometry."""
        if not self.has_mesh:
            raise Missing("the run has no mesh")
        for name in names:
            if name not in self.geometry:
                raise Missing(f"run.h5:/mesh/geometry has no attribute {name}")
        return [self.geometry[name] for name in names]

    def stage(self, *names):
        """Increments of the first of these stages that exists."""
        for name in names:
            found = [i for i in self.increments if i["stage"] == name]
            if found:
                return found
        raise Missing(f"there is no stage {' or '.join(names)}")

    @cached_property
    def losses(self):
        """Increments of the volume loss with V_l > 0 to draw troughs for: four of them unless some were asked for."""
        found = [i for i in self.stage("volume_loss") if i["volume_loss"] > 0]
        if not found:
            raise Missing("no increment has a volume loss")
        values = np.array([i["volume_loss"] for i in found])
        wanted = np.array(self.wanted) / 100 if self.wanted else values[-1] * np.array([0.25, 0.5, 0.75, 1])
        chosen = sorted({int(np.argmin(np.abs(values - v))) for v in wanted})
        return [found[k] for k in chosen]

    @property
    def cover(self):
        """Depth of the crown below the surface [m]."""
        axis_depth, diameter = self.need("axis_depth", "diameter")
        return axis_depth - diameter / 2

    def crown(self):
        """Node of the opening on the axis of symmetry, at the top."""
        self.need("diameter")
        if "tunnel" not in self.boundaries:
            raise Missing("run.h5 has no boundary tunnel")
        nodes = self.boundaries["tunnel"]
        return nodes[np.argmax(self.coordinates[nodes, 1])]


def _plain(value):
    return value.decode() if isinstance(value, bytes) else value
