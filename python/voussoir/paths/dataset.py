"""Reading a dataset of strain paths."""

import json
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from .fields import BY_NAME, MOST_MEAN_OVERLAP
from .rows import PARTS
from .storage import FORMAT

Array = np.ndarray
Part = str | int | Sequence[int] | None


def open_dataset(file: str | Path) -> "Dataset":
    """Opens a file of voussoir.paths.generate for reading.

    FileNotFoundError: there is none (or only its beginning). ValueError: the file is no such dataset."""
    return Dataset(file)


class Dataset:
    """A dataset on disk. `data["stress"]` is a dataset of h5py: slices of it are NumPy arrays, and only what a slice
    names is read. Rows run along the first axis, points of time along the second; point 0 is the beginning, and
    `gradient[:, k]` leads from point k to point k + 1."""

    def __init__(self, file: str | Path) -> None:
        self.file = Path(file)
        beginning = self.file.with_name(self.file.name + ".parts")
        if not self.file.exists():
            unfinished = f"is not finished ({beginning}); call generate() again to go on"
            raise FileNotFoundError(f"{self.file} {unfinished if beginning.exists() else 'does not exist'}")
        self._h5 = h5py.File(self.file, "r")
        if self._h5.attrs.get("format") != FORMAT:
            self._h5.close()
            raise ValueError(f"{self.file} is no dataset of voussoir.paths ('{FORMAT}')")

    def __enter__(self) -> "Dataset":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        self._h5.close()

    def __len__(self) -> int:
        """The number of rows."""
        return int(self._h5["row/path"].shape[0])

    def __getitem__(self, name: str) -> h5py.Dataset:
        """A field ("stress"), or a column of a table ("packing/seed").

        KeyError: there is none; the message names those that there are."""
        if name not in self._h5:
            raise KeyError(f"{name}: {self.file} has {', '.join(self.fields)} and the tables row/, path/, packing/")
        return self._h5[name]

    def __contains__(self, name: str) -> bool:
        return name in self._h5

    def __iter__(self) -> Iterator[str]:
        """The names of `fields`."""
        return iter(self.fields)

    def __repr__(self) -> str:
        what = f"{len(self)} rows, {self.points} points, {len(self['packing/seed'])} packings"
        return f"Dataset({self.file.name}: {what}; {', '.join(self.fields)})"

    @property
    def fields(self) -> list[str]:
        """Names of what has rows and points: the fields and `gradient`."""
        return [name for name, data in self._h5.items() if isinstance(data, h5py.Dataset)]

    @property
    def points(self) -> int:
        return int(self._h5["stress"].shape[1])

    @property
    def card(self) -> str:
        """The data card, in Markdown."""
        return str(self._h5.attrs.get("card", ""))

    @property
    def attrs(self) -> dict[str, Any]:
        """How the set was made: version, preset, tangent, ..."""
        return dict(self._h5.attrs)

    @property
    def plan(self) -> dict[str, Any]:
        """What decides every bit of the set, as generate() compares it."""
        return json.loads(self._h5.attrs["plan"])

    def rows(self, packing: Part = None, path: Part = None, family: str | None = None, complete: bool = False) -> Array:
        """Indices of rows. `packing`, `path`: "train", "validation" or "test", or indices of packings and paths;
        `family`: a kind of paths; `complete`: only rows whose grains had contacts at all points, did not fail, and were
        nowhere pressed beyond the range of the contact law.

        A model that is to be judged on unknown ground learns from rows(packing="train", path="train").

        ValueError: there is no such part, or no such kind of paths."""
        chosen = np.ones(len(self), bool)
        for table, wanted in (("packing", packing), ("path", path)):
            if wanted is not None:
                chosen &= self._is_in(table, wanted)
        if family is not None:
            known = sorted(set(self.family))
            if family not in known:
                raise ValueError(f"{self.file} has no paths of the kind {family!r}; there are: {', '.join(known)}")
            chosen &= self.family == family
        if complete:
            status = self._h5["status"][:]
            chosen &= ((status == 0) | (status == 1)).all(axis=1)
            chosen &= (self._h5["mean_overlap"][:] <= MOST_MEAN_OVERLAP).all(axis=1)
        return np.flatnonzero(chosen)

    @property
    def family(self) -> Array:
        """The kind of path of each row."""
        return self._h5["path/family"].asstr()[:][self._h5["row/path"][:]]

    def export_npz(self, file: str | Path, rows: Array | None = None, fields: Iterable[str] | None = None) -> None:
        """Writes rows (all: None) of fields (all: None) to a NumPy file, together with the tables of the rows; the name
        of a table's column has an underscore in place of the slash."""
        which = np.arange(len(self)) if rows is None else np.asarray(rows)
        arrays = {name: self[name][:][which] for name in (self.fields if fields is None else fields)}
        for table in ("path", "packing"):
            index = self._h5[f"row/{table}"][:][which]
            arrays[f"row_{table}"] = index
            arrays[f"{table}_split"] = self._h5[f"{table}/split"][:][index]
        np.savez_compressed(file, card=self.card, row_family=self.family[which], **arrays)

    def to_xarray(self, fields: Iterable[str] | None = None) -> Any:
        """An xarray.Dataset of fields (all: None), with the tables as coordinates of the rows.

        ImportError: xarray is not installed."""
        import xarray

        index = {table: self._h5[f"row/{table}"][:] for table in ("path", "packing")}
        coordinates: dict[str, Any] = {table: ("row", values) for table, values in index.items()}
        coordinates["family"] = ("row", self.family)
        for table, values in index.items():
            coordinates[f"{table}_split"] = ("row", np.array(PARTS)[self._h5[f"{table}/split"][:][values]])
        arrays = {}
        for name in self.fields if fields is None else fields:
            dimensions, labels = _dimensions(name)
            coordinates.update(labels)
            about = {key: str(value) for key, value in self._h5[name].attrs.items() if key in ("unit", "meaning")}
            arrays[name] = (dimensions, self._h5[name][:], about)
        return xarray.Dataset(arrays, coordinates, {"card": self.card})

    def _is_in(self, table: str, wanted: Any) -> Array:
        index = self._h5[f"row/{table}"][:]
        if isinstance(wanted, str):
            if wanted not in PARTS:
                raise ValueError(f"the parts of a split are {', '.join(PARTS)}, not {wanted!r}")
            return self._h5[f"{table}/split"][:][index] == PARTS.index(wanted)
        return np.isin(index, wanted)


def _dimensions(name: str) -> tuple[list[str], dict[str, Any]]:
    """Names of the axes of a field, and labels of its components."""
    if name in ("gradient", "consolidation"):
        return ["row", f"increment_of_{name}", "i", "j"], {}
    components = BY_NAME[name].components
    if not components:
        return ["row", "point"], {}
    return ["row", "point", f"{name}_component"], {f"{name}_component": list(components)}
