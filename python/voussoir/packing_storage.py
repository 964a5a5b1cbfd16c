"""Packing files of the program (docs/reference/files.md) by h5py. The compiled module calls `read` and `write`, where
the program uses the HDF5 library."""

import os
from pathlib import Path
from typing import Any

import numpy as np

from voussoir.engine import core
from voussoir.files import FORMAT_VERSION
from voussoir.packing_files import FORMAT, PackingFile

_units = {"radius": "m", "x": "m", "y": "m", "rotation": "rad", "cell": "m", "contact_i": "-", "contact_j": "-"}


def _h5py() -> Any:
    try:
        import h5py
    except ImportError as fault:
        raise ImportError("packing files need h5py, which `pip install h5py` installs") from fault
    return h5py


def read(path: str | os.PathLike[str]) -> dict[str, Any]:
    """A packing as the compiled module takes it.

    Raises:
        FileNotFoundError: there is no such file
        Unreadable: the file is no packing file, or is damaged
        ValueError: its grains were changed after it was written
    """
    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"{path}: " + ("it is no file" if path.exists() else "there is no such file"))
    file = PackingFile(path)
    packing: dict[str, Any] = {name: np.ascontiguousarray(getattr(file, name)) for name in (*_units, "history")}
    for name in ("thickness", "history_names", "numbers", "labels"):
        packing[name] = getattr(file, name)
    if file.content is not None and file.content != core().content_of(packing):
        raise ValueError(
            f"{path}: its grains were changed after this program had written them; a packing of your own has no "
            "attribute content"
        )
    return packing


def write(path: str | os.PathLike[str], packing: dict[str, Any]) -> None:
    """Writes a packing file, completely or not at all. Folders on the way are made."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    with _h5py().File(path.name, "w", driver="core", backing_store=False, libver=("v108", "v108")) as file:
        _fill(file, packing)
        file.flush()
        image = file.id.get_file_image()
    core().publish(str(path), image)


def _fill(file: Any, packing: dict[str, Any]) -> None:
    h5py = _h5py()

    def label(place: Any, name: str, text: str) -> None:  # of fixed length, which is what the program reads
        length = max(1, len(text.encode()))
        place.attrs.create(name, text, dtype=h5py.string_dtype("utf-8", length))

    def column(name: str, unit: str) -> None:
        file[name] = packing[name]
        label(file[name], "unit", unit)

    label(file, "format", FORMAT)
    file.attrs["format_version"] = np.int64(FORMAT_VERSION)
    file.attrs["thickness"] = float(packing["thickness"])
    file.attrs["content"] = np.int64(core().content_of(packing))
    for name, unit in _units.items():
        column(name, unit)
    column("history", "SI")
    label(file["history"], "names", ",".join(packing["history_names"]))
    numbers, labels = file.create_group("numbers"), file.create_group("labels")
    for name, value in packing["numbers"].items():
        numbers.attrs[name] = float(value)
    for name, text in packing["labels"].items():
        label(labels, name, text)
