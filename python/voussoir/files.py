"""Files of results as NumPy arrays with their units. Names, shapes and units: docs/reference/files.md."""

import csv
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from .errors import Missing, Unreadable

try:
    import h5py
except ModuleNotFoundError as missing:
    raise ModuleNotFoundError(
        f"results are read by h5py; `pip install h5py` installs it ({missing})",
        name=missing.name,
    ) from missing

FORMAT_VERSION = 1  # of docs/reference/files.md
UNIT_IN_NAME = re.compile(r"_(Pa|m|rad)$")  # of a column of a csv file

Row = dict[str, str]


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


def plain(value: Any) -> Any:
    return value.decode() if isinstance(value, bytes) else value


def values_of(data: h5py.Dataset) -> np.ndarray:
    """A dataset; texts are decoded."""
    values = data[()]
    return np.array([plain(value) for value in values], dtype=str) if values.dtype.kind in "SO" else values


def unit_of(data: h5py.Dataset) -> str:
    return str(plain(data.attrs.get("unit", "-")))


class Table(dict[str, np.ndarray]):
    """Columns of equal length by their names; `units` has the unit of each ("-" where it has no dimension)."""

    def __init__(self, columns: Mapping[str, np.ndarray], units: Mapping[str, str] | None = None) -> None:
        super().__init__(columns)
        self.units = {name: (units or {}).get(name, "-") for name in columns}

    def __repr__(self) -> str:
        told = ", ".join(name if unit == "-" else f"{name} [{unit}]" for name, unit in self.units.items())
        return f"<Table of {self.rows} rows: {told}>"

    @property
    def rows(self) -> int:
        return len(next(iter(self.values()), ()))

    def to_pandas(self) -> Any:
        """The table as a pandas.DataFrame, whose `attrs["units"]` has the units. Raises ImportError without pandas."""
        from .frames import frame_of

        return frame_of(self)

    def _repr_html_(self) -> str:
        from .notebook import table_html

        return table_html(self)


def table_of(group: h5py.Group) -> Table:
    """A group of columns, such as /tables/NAME of run.h5."""
    return Table(
        {name: values_of(data) for name, data in group.items()},
        {name: unit_of(data) for name, data in group.items()},
    )


def read_rows(path: Path, needed: Sequence[str]) -> list[Row]:
    """The rows of a csv file, which must have these columns."""
    try:
        with path.open(newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file)
            missing = [column for column in needed if column not in (reader.fieldnames or ())]
            if missing:
                raise Unreadable(f"{path} cannot be read: it has no column {missing[0]}")
            return list(reader)
    except (UnicodeDecodeError, csv.Error) as error:
        raise Unreadable(f"{path} cannot be read: it is damaged ({error})") from error
    except OSError as error:
        raise Unreadable(f"{path} cannot be read: {error.strerror}") from error


def table_of_rows(rows: Sequence[Row]) -> Table:
    """Rows of a csv file as columns: numbers where all of a column are, an empty field being not a number, else texts.
    The names stay as they are; the unit is the end of a name."""
    columns = {name: _column([row[name] or "" for row in rows]) for name in (rows[0] if rows else ())}
    units = {name: found[1] for name in columns if (found := UNIT_IN_NAME.search(name))}
    return Table(columns, units)


def _column(texts: Sequence[str]) -> np.ndarray:
    try:
        return np.array([float(text) if text else np.nan for text in texts])
    except ValueError:
        return np.array(texts, dtype=str)
