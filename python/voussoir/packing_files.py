"""Packing files as arrays (docs/reference/files.md, "Packings"). No compiled module is needed to read them."""

import re
from pathlib import Path

import numpy as np

from .errors import Unreadable
from .files import Table, check_format, plain, reading

FORMAT = "voussoir packing"  # attribute `format` of a packing file


class PackingFile:
    """The grains of a packing file; lengths in m, grains as discs of the thickness.

    radius, x, y, rotation (grain), cell (2, 2; columns are the periodic vectors), contact_i, contact_j (contact),
    history (contact, history_names; other programs write none), thickness, numbers (such as "void_ratio", "pressure"
    [Pa], "seed") and labels (the soil that it was made with); content: the hash of the grains that the program wrote,
    or None.
    """

    def __init__(self, path: Path | str) -> None:
        self.path = path = Path(path)
        with reading(path) as file:
            check_format(file, path, FORMAT)
            self.radius, self.x, self.y = (file[name][()] for name in ("radius", "x", "y"))
            self.rotation = file["rotation"][()] if "rotation" in file else np.zeros(len(self.radius))
            self.cell = file["cell"][()]
            self.contact_i, self.contact_j = file["contact_i"][()], file["contact_j"][()]
            self.history = file["history"][()] if "history" in file else np.zeros((len(self.contact_i), 0))
            names = str(plain(file["history"].attrs["names"])) if "history" in file else ""
            self.history_names = names.split(",") if names else []
            self.thickness = float(file.attrs["thickness"])
            self.content = int(file.attrs["content"]) if "content" in file.attrs else None
            self.numbers = {name: float(value) for name, value in file["numbers"].attrs.items()}
            self.labels = {name: str(plain(value)) for name, value in file["labels"].attrs.items()}
        grains = len(self.radius)
        whole = (
            grains and len(self.x) == len(self.y) == grains and np.all(self.radius > 0) and self.cell.shape == (2, 2)
        )
        if not whole or not np.linalg.det(self.cell) > 0:
            raise Unreadable(f"{path} cannot be read: its grains or its cell are impossible")
        contacts = np.concatenate([self.contact_i, self.contact_j])
        if len(contacts) and (contacts.min() < 0 or contacts.max() >= grains):
            raise Unreadable(f"{path} cannot be read: a contact has a grain that does not exist")

    def __fspath__(self) -> str:
        """Its path, so that RveBatch and load_packing take it as they take a path."""
        return str(self.path)

    def __repr__(self) -> str:
        return f"<PackingFile {self.path.name}: {len(self.radius)} grains, void ratio {self.void_ratio:.3f}>"

    @property
    def position(self) -> np.ndarray:
        """Centres of the grains (grain, 2) [m]."""
        return np.column_stack([self.x, self.y])

    @property
    def recipe(self) -> str:
        """What packings that differ by their seed alone have in common."""
        return re.sub(r"\bseed \d+ ?", "", self.labels.get("recipe", ""))

    @property
    def seed(self) -> int:
        return int(self.numbers.get("seed", 0))

    @property
    def void_ratio(self) -> float:
        """Area of voids over area of grains [-], as the study's 2D void ratio; overlaps are not subtracted."""
        return float(self.numbers.get("void_ratio", np.linalg.det(self.cell) / np.sum(np.pi * self.radius**2) - 1))

    def _repr_png_(self) -> bytes | None:
        from .notebook import packing_png

        return packing_png(self.radius, self.position, self.cell, np.column_stack([self.contact_i, self.contact_j]))


def packing_files(path: Path) -> list[Path]:
    """The packing files that a path names: the file itself, or those in a folder of packings."""
    if not path.is_dir():
        return [path]
    return sorted(path.glob("packing_*.h5")) or [path]


def is_packing(path: Path) -> bool:
    """True for a file in HDF5 by its name, and for a folder of packings that is no run."""
    try:
        if path.is_dir():
            return not (path / "run.h5").exists() and any(path.glob("packing_*.h5"))
        return path.suffix == ".h5" and path.exists()
    except OSError as error:
        raise Unreadable(f"{path} cannot be read: {error.strerror}") from error


def table_of_packings(packings: list[PackingFile]) -> Table:
    """One row a packing: file, seed, grains, contacts, void_ratio and the further numbers of the files."""
    columns: dict[str, np.ndarray] = {
        "file": np.array([packing.path.name for packing in packings]),
        "seed": np.array([packing.seed for packing in packings]),
        "grains": np.array([len(packing.radius) for packing in packings]),
        "contacts": np.array([len(packing.contact_i) for packing in packings]),
        "void_ratio": np.array([packing.void_ratio for packing in packings]),
    }
    for name in dict.fromkeys(name for packing in packings for name in packing.numbers):
        columns.setdefault(name, np.array([packing.numbers.get(name, np.nan) for packing in packings]))
    return Table(columns, {"pressure": "Pa"})
