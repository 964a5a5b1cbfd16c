"""A sweep's folder: which runs it holds. Runs are looked for in the folders, so that a sweep that still runs can be
drawn; `sweep.h5`, where it stands, gives the values of the axes."""

import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from .result import Missing, Unreadable, check_format, plain, reading
from .settings import Settings

INDEX = "sweep.h5"
DEEPEST = 3  # GRID/POINT/member_000
OWN_FOLDERS = {"column", "increments", "checkpoints", "fields", "outcomes"}  # within a run or a sweep


@dataclass
class Member:
    """One run of a sweep; `axes` are texts, as the sweep file has them."""

    name: str  # its folder below the sweep's, e.g. "rve_size/cps_d-grains_700"
    folder: Path
    kind: str
    axes: dict[str, str] = field(default_factory=dict)


class Sweep:
    """The runs of a sweep that have a run.h5."""

    def __init__(self, folder: Path | str, settings: Settings | None = None) -> None:
        self.folder = Path(folder)
        self.settings = settings or Settings()
        self.left_out: list[Missing] = []
        axes = self._axes()
        self.members: list[Member] = []
        for path in sorted(_run_folders(self.folder)):
            name = path.relative_to(self.folder).as_posix()
            try:
                self.members.append(Member(name, path, kind_of(path), axes.get(name, {})))
            except Missing as reason:
                self.left_out.append(reason)
        if not self.members:
            raise self.left_out[0] if self.left_out else Unreadable(f"{self.folder} has no run with a run.h5")

    def of_kind(self, kind: str) -> list[Member]:
        found = [member for member in self.members if member.kind == kind]
        if not found:
            raise Missing(f"{self.folder} has no run of kind {kind}")
        return found

    def _axes(self) -> dict[str, dict[str, str]]:
        """The values of the axes by the names of the runs, from sweep.h5; without this file none."""
        path = self.folder / INDEX
        if not path.exists():
            return {}
        with reading(path) as file:
            check_format(file, path, "voussoir sweep")
            names = [plain(value) for value in file["runs/name"][()]]
            values = {axis: [plain(v) for v in data[()]] for axis, data in file.get("axes", {}).items()}
        return {name: {axis: row[k] for axis, row in values.items() if row[k]} for k, name in enumerate(names)}


def kind_of(folder: Path) -> str:
    """The kind of a run, without reading its tables."""
    index = folder / "run.h5"
    with reading(index) as file:
        check_format(file, index, "voussoir run")
        return str(plain(file["provenance"].attrs["case_kind"]))


def _run_folders(folder: Path, depth: int = 0) -> Iterator[Path]:
    try:
        below = [entry for entry in os.scandir(folder) if entry.is_dir()]
    except OSError as error:
        raise Unreadable(f"{folder} cannot be read: {error.strerror}") from error
    for entry in below:
        if entry.name in OWN_FOLDERS:
            continue
        path = Path(entry.path)
        if (path / "run.h5").exists():
            yield path
        elif depth + 1 < DEEPEST:
            yield from _run_folders(path, depth + 1)


def is_sweep(folder: Path) -> bool:
    """True for a folder with runs below it that is neither a run nor an ensemble."""
    try:
        if not folder.is_dir() or any((folder / name).exists() for name in ("run.h5", "ensemble.h5", "member_000")):
            return False
        if (folder / INDEX).exists() or (folder / "summary.csv").exists():
            return True
    except OSError as error:
        raise Unreadable(f"{folder} cannot be read: {error.strerror}") from error
    return next(_run_folders(folder), None) is not None
