"""sweep.h5 (docs/reference/files.md): one row a run, with how it ended, its axes' values, cost and results."""

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from .result import Unreadable, check_format, plain, reading
from .sweep import INDEX, Sweep

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
