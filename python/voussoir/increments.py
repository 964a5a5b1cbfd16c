"""One load increment of a run on a mesh (increments/NNNN.h5, docs/reference/files.md)."""

from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from .errors import Missing
from .files import check_format, plain, reading, unit_of

Snapshot = dict[str, np.ndarray]  # arrays of one RVE, by the names of docs/reference/files.md

GROUPS = ("node", "gauss", "element", "rve")  # of fields


class Increment:
    """One increment's file, whose fields are read when they are needed. Tension is positive, as in the files.

    increment["volume_loss"] is a number of the increment (`attributes` has all of them), increment.field("stress") a
    field, increment.snapshot("rve_3") the grains of an RVE; `names` are the fields with their places, such as
    "gauss/stress". Raises Missing where it does not have what is asked for, Unreadable where the file is damaged.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        with reading(path) as file:
            check_format(file, path, "voussoir increment")
            self.attributes = {name: plain(value) for name, value in file.attrs.items()}
            self.names = {f"{group}/{name}" for group in GROUPS if group in file for name in file[group]}
            self.snapshots = sorted(file["snapshots"]) if "snapshots" in file else []
        self["stage"], self["volume_loss"]  # all that reads increments tells them apart by these

    def __getitem__(self, attribute: str) -> Any:
        if attribute not in self.attributes:
            raise Missing(f"{self.path} has no attribute {attribute}", sorted(self.attributes))
        return self.attributes[attribute]

    def __repr__(self) -> str:
        ended = "" if self.attributes.get("converged", 1) else ", not converged"
        return (
            f"<Increment {self.path.stem} of {self['stage']} at {self.attributes.get('load_parameter', 0):.5g}{ended}>"
        )

    def place_of(self, name: str) -> str:
        """The name of a field with its place: "gauss/stress" of "stress"."""
        if name in self.names:
            return name
        found = [f"{group}/{name}" for group in GROUPS if f"{group}/{name}" in self.names]
        if not found:
            raise Missing(f"{self.path} has no {name}", sorted(self.names))
        return found[0]

    def field(self, name: str) -> np.ndarray:
        """Values of e.g. "stress" or "gauss/stress": (element, 4, components) at Gauss points, (node, components) at
        nodes; without the last axis where there is one component. Units: `unit(name)`."""
        place = self.place_of(name)
        with reading(self.path) as file:
            values = file[place][()]
        return values[..., 0] if values.shape[-1] == 1 else values

    def unit(self, name: str) -> str:
        """The unit of a number or of a field of the increment; "-" where it has no dimension."""
        if name in self.attributes:
            return self.units.get(name, "-")
        place = self.place_of(name)
        with reading(self.path) as file:
            return unit_of(file[place])

    @cached_property
    def units(self) -> dict[str, str]:
        """The units of the numbers."""
        with reading(self.path) as file:
            return {name: str(plain(unit)) for name, unit in file["units"].attrs.items()} if "units" in file else {}

    @cached_property
    def residuals(self) -> np.ndarray:
        """Relative residual of each iterate [-]; empty where the increment had none."""
        with reading(self.path) as file:
            return file["convergence/residual"][()] if "convergence/residual" in file else np.empty(0)

    def snapshot(self, name: str) -> Snapshot:
        """Arrays of one RVE, by the names of docs/reference/files.md."""
        if name not in self.snapshots:
            raise Missing(f"{self.path} has no snapshot {name}", self.snapshots)
        with reading(self.path) as file:
            return {key: data[()] for key, data in file[f"snapshots/{name}"].items()}
