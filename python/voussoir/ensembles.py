"""Ensembles as NumPy arrays: means and bands over their members (ensemble.h5, docs/reference/files.md)."""

import tomllib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from .errors import Missing, Unreadable
from .files import Table, check_format, plain, reading, table_of, unit_of
from .results import Result
from .shown import Shown

INDEX = "ensemble.h5"
NAMES = ("mean", "deviation", "mean_half_width", "prediction_half_width")


@dataclass
class Bands:
    """Values over the members; the bands are mean ± half width: of the mean, and of one further member. `members` has
    one axis more, the first one; it is empty for fields, of which no members are kept."""

    mean: np.ndarray
    deviation: np.ndarray
    mean_half_width: np.ndarray
    prediction_half_width: np.ndarray
    members: np.ndarray
    unit: str = "-"

    def part(self, chosen: np.ndarray | int) -> "Bands":
        """The bands of chosen rows."""
        return Bands(
            self.mean[chosen],
            self.deviation[chosen],
            self.mean_half_width[chosen],
            self.prediction_half_width[chosen],
            self.members[:, chosen],
            self.unit,
        )


class Ensemble(Shown):
    """An ensemble's means and bands.

    folder, case, count (members that are reduced), begun (members that were begun), confidence (0.95), stage and load
    (load parameter) of the increments that all members have, curves (Bands over the increments, by the names of the
    columns), tables (Bands over the rows), trough_x (node) [m] and trough (increment, node) of the surface, or None.
    Raises Unreadable where there is no ensemble.h5, or where it is damaged.
    """

    kind = "ensemble"

    def __init__(self, folder: Path | str) -> None:
        self.folder = Path(folder)
        self.left_out: list[Missing] = []  # as of a run: an ensemble's index is read whole or not at all
        path = self.folder / INDEX
        with reading(path) as file:
            check_format(file, path, "voussoir ensemble")
            self.case: dict[str, Any] = tomllib.loads(plain(file["input"][()])) if "input" in file else {}
            self.count = int(file["bands"].attrs["members"])
            self.confidence = float(file["bands"].attrs["confidence"])
            self.begun = len(file["members/name"])
            self.members = table_of(file["members"])
            self.stage = np.array([plain(value) for value in file["table/stage"][()]])
            self.load = file["table/load_parameter"][()]
            self.curves = {name: _bands(group) for name, group in file["curves"].items()}
            self.tables = {
                name: {column: _bands(group) for column, group in table.items()}
                for name, table in file["tables"].items()
            }
            self.good_troughs = file["table/good_troughs"][()] if "table/good_troughs" in file else None
            self.trough_x = file["trough/x"][()] if "trough" in file else None
            self.trough = _bands(file["trough/settlement"]) if "trough" in file else None

    def curve(self, name: str) -> Bands:
        """The bands of a curve, such as "surface_settlement", over the increments."""
        if name not in self.curves:
            raise Missing(f"{self.folder / INDEX} has no curve {name}", self.curves)
        return self.curves[name]

    def fields(self, increment: int) -> dict[str, Bands]:
        """Bands of the fields of an increment, by their names with their places ("gauss/stress"); it is counted from 0
        in `stage` and `load`, and -1 is the last one."""
        with reading(self.folder / INDEX) as file:
            names = sorted(file["fields"])
        path = self.folder / "fields" / f"{names[increment]}.h5"
        with reading(path) as file:
            check_format(file, path, "voussoir ensemble fields")
            return {
                f"{group}/{name}": _bands(bands)
                for group in ("node", "gauss", "element", "rve")
                for name, bands in file.get(group, {}).items()
            }

    def member(self, name: str | int) -> Result:
        """The run of a member, by its number or its name ("member_000")."""
        return Result(self.folder / (name if isinstance(name, str) else str(self.members["name"][name])))

    @cached_property
    def table(self) -> Table:
        """Stage, load parameter and the curves as columns: NAME the mean, NAME_deviation, NAME_mean_half_width,
        NAME_prediction_half_width."""
        columns, units = {"stage": self.stage, "load_parameter": self.load}, {}
        for name, bands in self.curves.items():
            for part in NAMES:
                column = name if part == "mean" else f"{name}_{part}"
                columns[column], units[column] = getattr(bands, part), bands.unit
        return Table(columns, units)

    def to_pandas(self) -> Any:
        """`table` as a pandas.DataFrame. Raises ImportError without pandas."""
        return self.table.to_pandas()

    def to_xarray(self) -> Any:
        """The curves as an xarray.Dataset: the columns of `table` over the increments, and NAME_members (member,
        increment). Raises ImportError without xarray."""
        from .frames import dataset_of_curves

        return dataset_of_curves(self.table, {f"{name}_members": bands.members for name, bands in self.curves.items()})

    def _facts(self) -> list[str]:
        left_out = self.begun - self.count
        return [
            f"{self.count} members" + (f", {left_out} left out" if left_out else ""),
            f"{len(self.load)} increments of {', '.join(dict.fromkeys(self.stage))}",
            f"{len(self.curves)} curves",
        ]


def _bands(group: h5py.Group) -> Bands:
    members = group["members"][()] if "members" in group else np.empty((0, *group["mean"].shape))
    mean, deviation, mean_half_width, prediction_half_width = (group[name][()] for name in NAMES)
    return Bands(mean, deviation, mean_half_width, prediction_half_width, members, unit_of(group["mean"]))


def is_ensemble(folder: Path) -> bool:
    """True for the folder of a reduced ensemble. An ensemble without means and bands is told in one line."""
    try:
        if (folder / INDEX).exists():
            return True
        begun = (folder / "member_000").exists() and not (folder / "run.h5").exists()
    except OSError as error:
        raise Unreadable(f"{folder} cannot be read: {error.strerror}") from error
    if begun:
        raise Unreadable(
            f"{folder} is an ensemble without {INDEX}: it is not finished, or fewer than two members are; each member "
            "is a run of its own"
        )
    return False
