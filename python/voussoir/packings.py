"""Packings of grains: made from a recipe, read from the program's files, drawn in a notebook."""

import logging
import os
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from voussoir import packing_storage
from voussoir.engine import core, running
from voussoir.errors import NoEquilibrium, PackingWarning
from voussoir.notebook import packing_png
from voussoir.settings import Settings, flat, name, text_of, told_by_argument, whole_number

_log = logging.getLogger("voussoir")

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Packing:
    """A periodic packing of discs at rest, with the state of its contacts.

    Its arrays are the packing's own: copy them before you change them.
    """

    radius: Floats  #: (g,) radii of the grains [m]
    position: Floats  #: (g, 2) centres [m]
    rotation: Floats  #: (g,) rotation of each grain [rad]
    cell: Floats  #: (2, 2) periodic cell; its columns are the periodic vectors [m]
    thickness: float  #: out of the plane [m]
    contacts: Integers  #: (c, 2) numbers i < j of the grains of each contact
    history: Floats  #: (c, k) what the contact law keeps of a contact [SI]; `history_names` says what
    history_names: tuple[str, ...]  #: (k)
    numbers: dict[str, float]  #: measures of the packing by name, those of the properties below among them [SI]
    labels: dict[str, str]  #: texts by name: recipe, fingerprint of the recipe, keys of the soil

    @property
    def seed(self) -> int:
        """Seed of the recipe."""
        return int(self.numbers["seed"])

    @property
    def void_ratio(self) -> float:
        """Area of the voids over the area of the grains [-]."""
        return self.numbers["void_ratio"]

    @property
    def pressure(self) -> float:
        """Mean stress, compression positive [Pa]."""
        return self.numbers["pressure"]

    @property
    def coordination(self) -> float:
        """Contacts of a grain on average, 2 c / g [-]."""
        return self.numbers["coordination"]

    @property
    def soil(self) -> dict[str, str]:
        """The keys of the soil that it was made with, such as {"soil.modulus": "3 GPa"}."""
        return {key: text for key, text in self.labels.items() if key.startswith("soil.")}

    def __len__(self) -> int:
        """The number of grains."""
        return len(self.radius)

    def __repr__(self) -> str:
        return (
            f"<voussoir.Packing of {len(self)} grains, seed {self.seed}, void ratio {self.void_ratio:.4f}, "
            f"{self.pressure / 1e3:.4g} kPa, coordination {self.coordination:.3f}>"
        )

    def _repr_png_(self) -> bytes | None:
        return packing_png(self.radius, self.position, self.cell, self.contacts)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a packing file, which `load_packing` and the program (packing.file of a probe) read.

        Raises:
            ImportError: h5py is missing
            RuntimeError, OSError: the file cannot be written
        """
        packing_storage.write(path, as_dict(self))


def as_dict(packing: Packing) -> dict[str, Any]:
    """The packing as the compiled module takes it."""
    return {
        "radius": np.ascontiguousarray(packing.radius, dtype=np.float64),
        "x": np.ascontiguousarray(packing.position[:, 0], dtype=np.float64),
        "y": np.ascontiguousarray(packing.position[:, 1], dtype=np.float64),
        "rotation": np.ascontiguousarray(packing.rotation, dtype=np.float64),
        "cell": np.ascontiguousarray(packing.cell, dtype=np.float64),
        "thickness": float(packing.thickness),
        "contact_i": np.ascontiguousarray(packing.contacts[:, 0], dtype=np.int64),
        "contact_j": np.ascontiguousarray(packing.contacts[:, 1], dtype=np.int64),
        "history": np.ascontiguousarray(packing.history, dtype=np.float64),
        "history_names": list(packing.history_names),
        "numbers": packing.numbers,
        "labels": packing.labels,
    }


def grains_of(grains: dict[str, Any]) -> dict[str, Any]:
    """The members that a Packing and a Snapshot have in common, of grains as the compiled module gives them."""
    return {
        "radius": grains["radius"],
        "position": np.stack([grains["x"], grains["y"]], axis=1),
        "rotation": grains["rotation"],
        "cell": grains["cell"],
        "thickness": grains["thickness"],
        "contacts": np.stack([grains["contact_i"], grains["contact_j"]], axis=1),
    }


def from_dict(packing: dict[str, Any]) -> Packing:
    """The reverse of as_dict."""
    return Packing(
        **grains_of(packing),
        history=packing["history"],
        history_names=tuple(packing["history_names"]),
        numbers=dict(packing["numbers"]),
        labels=dict(packing["labels"]),
    )


def make_packings(
    seeds: int | Sequence[int] = 1,
    *,
    grains: int = 300,
    pressure: float = 100e3,
    settings: Settings | None = None,
    folder: str | os.PathLike[str] | None = None,
) -> list[Packing]:
    """Makes packings at rest under isotropic pressure, side by side: loose random discs that are compressed
    (docs/explanation/method.md). The same recipe and seed give the same packing, bit for bit, as in the program.

    Args:
        seeds: a number n for the seeds 1 to n, or the seeds themselves
        grains: of each packing
        pressure: isotropic, compression positive [Pa]
        settings: further keys of the tables [soil] and [packing], such as {"soil.friction": "30 deg",
            "packing.void_ratio": 0.2} (docs/reference/keys.md). Texts carry units. They override the arguments above.
        folder: where packings are kept, as the program's packing.folder: those that are there are read, and new ones
            are written (this needs h5py). None: they are not stored.

    Returns:
        The packings in the order of the seeds. A seed whose packing does not come to rest is left out, with a
        PackingWarning.

    Raises:
        InputError: a setting, or a value of an argument, is wrong
        TypeError: seeds are no integers; the pressure is no number
        ValueError: there is no seed
        NoEquilibrium: no packing comes to rest, or none reaches packing.void_ratio. Those of the default soil at
            100 kPa reached 0.17 to 0.28 (seeds 1 and 2; 100 and 300 grains).
    """
    wanted = _seeds(seeds)
    defaults: dict[str, Any] = {"packing.grains": grains, "packing.pressure": _in_pascal(pressure)}
    if folder is not None:
        defaults["packing.folder"] = str(Path(folder).absolute())
    text = text_of("pack", settings, ("soil", "packing"), defaults)
    try:
        with told_by_argument(settings, {key: key.removeprefix("packing.") for key in defaults}):
            made, notes, left_out = running().make_packings(text, name, wanted, folder is not None)
    except NoEquilibrium as fault:
        if "packing.void_ratio" in flat(settings):
            fault.add_note(
                "packing.void_ratio may be out of reach of this soil; without it, packings show what they reach"
            )
        raise
    packings = [from_dict(packing) for packing in made]
    for note in notes:
        _log.info(note)
    missing = len(wanted) - len(packings)
    if missing:
        reasons = "; ".join(left_out)
        warnings.warn(f"{missing} of {len(wanted)} packings are missing: {reasons}", PackingWarning, stacklevel=2)
    return packings


def _in_pascal(pressure: Any) -> str:
    if isinstance(pressure, str):
        raise TypeError(f"pressure is a number in Pa, such as 100e3, not {pressure!r}")
    return f"{float(pressure)!r} Pa"


def _seeds(seeds: Any) -> list[int]:
    if isinstance(seeds, str) or not isinstance(seeds, Iterable):
        seeds = range(1, whole_number(seeds, "the number of seeds") + 1)
    wanted = [whole_number(seed, "a seed") for seed in seeds]
    if not wanted:
        raise ValueError("there must be at least one seed")
    return wanted


def load_packing(path: str | os.PathLike[str], *, settings: Settings | None = None) -> Packing:
    """Reads a packing file of the program, packing_*.h5 or the end of a path of a probe.

    Args:
        path: of the file
        settings: keys of the table [soil], which replace the soil that the file says. The state stays what it is.

    Raises:
        FileNotFoundError: there is no such file
        Unreadable: it is no packing file, or a damaged one
        ValueError: it is no packing of this program
        InputError: a setting is wrong
        ImportError: h5py is missing
    """
    packing = packing_storage.read(path)
    if settings is not None:
        labels = {key: text for key, text in packing["labels"].items() if not key.startswith("soil.")}
        packing["labels"] = labels | core().soil_labels(text_of("pack", settings, ("soil",)), name)
    core().check_packing(packing)
    return from_dict(packing)
