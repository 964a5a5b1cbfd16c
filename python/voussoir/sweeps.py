"""Sweeps: which runs a folder holds, how each ended, and where its result is (sweep.h5, docs/reference/files.md).

Runs are looked for in the folders, so that a sweep that still runs can be read; `sweep.h5`, where it stands, gives the
values of the axes."""

import json
import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from .ensembles import Ensemble
from .errors import Missing, Unreadable
from .files import Table, check_format, plain, reading
from .results import Result
from .shown import Shown

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


class Sweep(Shown):
    """A sweep: `runs` tells how each run ended, its axes, cost and results; `table` has the same as columns;
    result(NAME) opens a run, ensemble(NAME) the bands of a point with several members.

    `members` are the runs that have a run.h5; why a run cannot be read, `left_out` says. Raises Unreadable where the
    folder has no sweep.
    """

    kind = "sweep"

    def __init__(self, folder: Path | str) -> None:
        self.folder = Path(folder)
        self.left_out: list[Missing] = []
        axes = self._axes()
        self.members: list[Member] = []
        for path in sorted(_run_folders(self.folder)):
            name = path.relative_to(self.folder).as_posix()
            try:
                self.members.append(Member(name, path, kind_of(path), axes.get(name, {})))
            except Missing as reason:
                self.left_out.append(reason)

    @cached_property
    def rows(self) -> "SweepTable":
        """The rows of sweep.h5."""
        return SweepTable(self)

    @property
    def runs(self) -> list["Run"]:
        """The runs in the order of the sweep file."""
        return self.rows.runs

    def run(self, name: str) -> "Run":
        """How a run ended, what it cost, and its results."""
        for run in self.runs:
            if run.name == name:
                return run
        raise Missing(f"{self.folder} has no run {name}; there are: {', '.join(run.name for run in self.runs)}")

    def result(self, name: str) -> Result:
        """The result of a run by its name; Missing where the run left none."""
        run = self.run(name)
        if not (self.folder / name / "run.h5").exists():
            raise Missing(f"the run {name} has left no results: {run.status} {run.reason}".rstrip())
        return Result(self.folder / name)

    @property
    def ensembles(self) -> list[str]:
        """Names of the points whose members are reduced to means and bands."""
        return [name for name in self.rows.points() if (self.folder / name / "ensemble.h5").exists()]

    def ensemble(self, name: str) -> Ensemble:
        """Means and bands of a point by its name."""
        return Ensemble(self.folder / name)

    @cached_property
    def table(self) -> Table:
        """One row a run: name, status, exit_code, kind, the axes (texts, as the sweep file has them), wall_s,
        particle_steps, iterations and the results; not a number where a run has none."""
        runs = self.runs
        columns: dict[str, np.ndarray] = {
            "name": np.array([run.name for run in runs]),
            "status": np.array([run.status for run in runs]),
            "exit_code": np.array([np.nan if run.exit_code is None else run.exit_code for run in runs]),
            "kind": np.array([run.kind for run in runs]),
        }
        for axis in dict.fromkeys(axis for run in runs for axis in run.axes):
            columns[axis] = np.array([run.axes.get(axis, "") for run in runs])
        for name in dict.fromkeys(name for run in runs for name in {**run.cost, **run.results}):
            columns[name] = np.array([{**run.cost, **run.results}.get(name, np.nan) for run in runs])
        return Table(columns, {**COST, **self.rows.units})

    def to_pandas(self) -> Any:
        """`table` as a pandas.DataFrame. Raises ImportError without pandas."""
        return self.table.to_pandas()

    def _facts(self) -> list[str]:
        ended: dict[str, int] = {}
        for run in self.runs:
            ended[run.status] = ended.get(run.status, 0) + 1
        return [f"{len(self.runs)} runs", *(f"{count} {status}" for status, count in ended.items())]

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


COST = {"wall_s": "s", "particle_steps": "-", "iterations": "-"}


@dataclass
class Run:
    """One run of a sweep. `exit_code` is None where nothing tells how it ended."""

    name: str
    status: str
    exit_code: int | None = None
    reason: str = ""
    kind: str = ""
    grid: str = ""
    point: str = ""
    axes: dict[str, str] = field(default_factory=dict)
    cost: dict[str, float] = field(default_factory=dict)
    results: dict[str, float] = field(default_factory=dict)

    @property
    def failed(self) -> bool:
        return self.exit_code not in (0, None)


class SweepTable:
    """The rows of sweep.h5; without this file the runs that the folders hold, of which less is known."""

    def __init__(self, sweep: Sweep) -> None:
        self.folder: Path = sweep.folder
        self.input = ""
        self.units: dict[str, str] = {}
        self.gathered = (sweep.folder / INDEX).exists()
        self.runs = self._read() if self.gathered else _of_folders(sweep)

    def _read(self) -> list[Run]:
        path = self.folder / INDEX
        with reading(path) as file:
            check_format(file, path, "voussoir sweep")
            self.input = str(plain(file["input"][()])) if "input" in file else ""
            columns = {name: [plain(v) for v in data[()]] for name, data in file["runs"].items()}
            count = len(columns["name"])
            columns["exit_code"] = [int(code) for code in columns["exit_code"]]
            axes = {name: [str(plain(v)) for v in data[()]] for name, data in _group(file, "axes").items()}
            results = {name: np.asarray(data[()], dtype=float) for name, data in _group(file, "results").items()}
            self.units = {
                name: str(plain(data.attrs.get("unit", "-"))) for name, data in _group(file, "results").items()
            }
        if any(len(values) != count for part in (columns, axes, results) for values in part.values()):
            raise Unreadable(f"{path} cannot be read: the columns of its runs have different lengths")
        return [_row(k, columns, axes, results) for k in range(count)]

    def points(self) -> dict[str, list[Run]]:
        """Runs by the folder of their point, below the sweep's: the members of an ensemble, or one run."""
        found: dict[str, list[Run]] = {}
        for run in self.runs:
            member = run.name.rsplit("/", 1)[-1].startswith("member_")
            place = run.name.rsplit("/", 1)[0] if member and "/" in run.name else run.name
            found.setdefault(place, []).append(run)
        return found


def _group(file: h5py.File, name: str) -> dict[str, Any]:
    return dict(file[name].items()) if name in file else {}


def _row(k: int, columns: dict[str, list], axes: dict[str, list[str]], results: dict[str, np.ndarray]) -> Run:
    def text(name: str) -> str:
        return str(columns[name][k]) if name in columns else ""

    return Run(
        name=text("name"),
        status=text("status"),
        exit_code=columns["exit_code"][k],
        reason=text("reason"),
        kind=text("kind"),
        grid=text("grid"),
        point=text("point"),
        axes={name: values[k] for name, values in axes.items() if values[k] != ""},
        cost={name: float(columns[name][k]) for name in COST if name in columns},
        results={name: float(values[k]) for name, values in results.items() if np.isfinite(values[k])},
    )


def _of_folders(sweep: Sweep) -> list[Run]:
    """The runs in the folders, and those that ended without one, as DIR/outcomes tells."""
    runs = {m.name: Run(m.name, "not ended", kind=m.kind, grid=_grid(m.name), axes=m.axes) for m in sweep.members}
    for path in sorted((sweep.folder / "outcomes").glob("*.json")):
        name = path.stem.replace("__", "/")
        try:
            told = json.loads(path.read_text())
            status, code, reason = str(told["status"]), int(told["exit_code"]), str(told.get("reason", ""))
        except (OSError, ValueError, KeyError, TypeError, AttributeError):
            continue  # half written by a killed run, whose folder is there all the same
        run = runs.setdefault(name, Run(name, status, grid=_grid(name)))
        run.status, run.exit_code, run.reason = status, code, reason
    return list(runs.values())


def _grid(name: str) -> str:
    return name.split("/", maxsplit=1)[0] if "/" in name else ""
