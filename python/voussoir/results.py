"""Results of runs as NumPy arrays: open_result(folder). Names, shapes, units, signs: docs/reference/files.md."""

import re
import tomllib
from collections.abc import Iterable
from functools import cached_property
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np

from .errors import Missing, Unreadable
from .files import Table, check_format, plain, reading, table_of
from .increments import Increment
from .locks import is_running
from .shown import Shown

KINDS = (
    "results are runs of the kinds scene, tunnel, column, biaxial_bvp, biaxial, calibrate and probe, packings (files "
    "or their folder), ensembles and sweeps"
)
MAIN_TABLE = {"biaxial": "strength", "calibrate": "search", "probe": "probe", "pack": "packings"}
RECORDED = re.compile(
    r"(?:(?P<vector>displacement|reaction|traction|stress)_(?P<place>.+)_(?P<part>xx|yy|xy|x|y)"
    r"|(?P<scalar>q_over_p|volumetric_strain|p|q)_(?P<region>.+))"
)


class Result(Shown):
    """What the folder of a run holds; of a run that still goes on, what is written until now.

    folder, kind ("tunnel", "biaxial", ...), case (the resolved case file as dictionaries), provenance (where the
    result comes from), tables (the named tables, each a Table: columns with units). Of a run on a mesh also
    coordinates (node, 2) [m], connectivity (element, 8), boundaries (nodes by name), points (node by name), regions
    (element) or None, region_names, geometry (numbers of the ground), and the increments.

    figure, figures and report draw it (Shown). Probes have `ends` (the packings at the end of the path, by their
    seeds), packings have `packings` (each a PackingFile).

    Raises Unreadable where the folder has no results, or a file that is damaged. An increment that cannot be read is
    left out, and `left_out` says why.
    """

    def __init__(self, folder: Path | str) -> None:
        self.folder = Path(folder)
        self.left_out: list[Missing] = []  # why a file of the run could not be read
        self.kind = ""
        self.has_mesh = False
        self.case: dict[str, Any] = {}
        self.provenance: dict[str, Any] = {}
        self.tables: dict[str, Table] = {}
        self._read()

    def _read(self) -> None:
        index = self.folder / "run.h5"
        _check_folder(self.folder, index)
        with reading(index) as file:
            check_format(file, index, "voussoir run")
            self.case = tomllib.loads(plain(file["input"][()])) if "input" in file else {}
            self.has_mesh = "mesh" in file
            attributes = file["provenance"].attrs if "provenance" in file else {}
            self.provenance = {name: plain(value) for name, value in attributes.items()}
            self.kind = str(self.provenance.get("case_kind", self.case.get("kind", "tunnel")))
            self.tables = {name: table_of(table) for name, table in file.get("tables", {}).items()}
            if self.has_mesh:
                self._read_mesh(file["mesh"])

    def _read_mesh(self, mesh: Any) -> None:
        self.coordinates: np.ndarray = mesh["coordinates"][()]
        self.connectivity: np.ndarray = mesh["connectivity"][()]
        self.boundaries: dict[str, np.ndarray] = {name: nodes[()] for name, nodes in mesh["boundaries"].items()}
        named = mesh["points"].attrs.items() if "points" in mesh else ()
        self.points: dict[str, int] = {name: int(node) for name, node in named}
        self.geometry = {name: float(value) for name, value in mesh["geometry"].attrs.items()}
        # Region of each element, and their names; None where the mesh has one region only.
        self.regions: np.ndarray | None = mesh["regions"][()].ravel() if "regions" in mesh else None
        self.region_names = [str(plain(name)) for name in mesh["region_names"][()]] if "regions" in mesh else []

    @property
    def title(self) -> str:
        """The title of the case, or the name of the folder."""
        return str(self.case.get("title", "") or self.folder.resolve().name)

    @property
    def is_running(self) -> bool:
        """True while a process computes this run, on this machine or, as far as its files tell, on another one."""
        return is_running(self.folder)

    @cached_property
    def increments(self) -> list[Increment]:
        """The increments of all stages in order; empty for kinds without a mesh."""
        found = []
        for path in increment_files(self.folder / "increments") if self.has_mesh else []:
            try:
                found.append(Increment(path))
            except Missing as reason:
                self.left_out.append(reason)
        return found

    @property
    def stages(self) -> list[str]:
        """The names of the stages in the order in which they were run."""
        return [name for name, _ in groupby(increment["stage"] for increment in self.increments)]

    def stage(self, *names: str) -> list[Increment]:
        """Increments of the first of these stages that exists."""
        for name in names:
            found = [i for i in self.increments if i["stage"] == name]
            if found:
                return found
        raise Missing(f"there is no stage {' or '.join(names)}", self.stages)

    def _chosen(self, stage: str | None) -> list[Increment]:
        if not self.increments:
            raise Missing(f"{self.folder}: the run has no increments")
        return self.increments if stage is None else self.stage(stage)

    @property
    def fields(self) -> list[str]:
        """Names of the fields that the increments have, with their places: "gauss/stress", "node/displacement"."""
        return sorted(set().union(*(increment.names for increment in self.increments)))

    def history(self, name: str, stage: str | None = None) -> np.ndarray:
        """A field over all increments, or over those of a stage: (increment, element, 4, components) at Gauss points,
        (increment, node, components) at nodes; without the last axis where there is one component."""
        return np.array([increment.field(name) for increment in self._chosen(stage)])

    def unit(self, name: str) -> str:
        """The unit of a field, or of a number of the increments."""
        return self._chosen(None)[-1].unit(name)

    @cached_property
    def gauss_points(self) -> np.ndarray:
        """Places of the Gauss points in the mesh as it was made (element, 4, 2) [m]."""
        from .figures.q8 import gauss_coordinates

        if not self.has_mesh:
            raise Missing(f"{self.folder}: the run has no mesh")
        return gauss_coordinates(self.coordinates, self.connectivity)

    def table(self, name: str = "", *columns: str) -> Table:
        """A table, which must have these columns: one of `tables`, or "increments" with the numbers of all increments.
        Without a name: "increments" of a run on a mesh, "strength" of biaxial tests, "search" of a calibration,
        "probe" of a probe, "packings" of packings."""
        name = name or MAIN_TABLE.get(self.kind, "increments")
        found = self._of_increments if name == "increments" and self.increments else self.tables.get(name)
        index = self.folder / "run.h5"
        if found is None:
            raise Missing(f"{index} has no table {name}", [*["increments"] * bool(self.increments), *self.tables])
        for column in columns:
            if column not in found:
                raise Missing(f"{index}: the table {name} has no column {column}", found)
        return found

    @cached_property
    def _of_increments(self) -> Table:
        """The numbers of the files, not the table of run.h5: a run that goes on may have a file more than its index."""
        return numbers_of(self.increments)

    @cached_property
    def records(self) -> list[str]:
        """Names of what a scene records: points, regions, lines and boundaries."""
        if self.kind != "scene":
            return []
        found = [RECORDED.fullmatch(name) for name in self._of_increments]
        names = [match["place"] or match["region"] for match in found if match]
        lines = [name.removeprefix("line_") for name in self.tables if name.startswith("line_")]
        return sorted({*names, *lines})

    def record(self, name: str) -> Table:
        """What a scene recorded of a point, a region or a boundary, over its increments: stage, load_parameter and the
        columns without the record's name, such as displacement_x [m], stress_yy [Pa], reaction_y [N/m], q_over_p. Of a
        line: the rows of all its points (increment, s, x, y, ...)."""
        if name not in self.records:
            known = ", ".join(self.records) or "none"
            raise Missing(f"{self.folder} has no record {name}; there are: {known}")
        if f"line_{name}" in self.tables:
            return self.tables[f"line_{name}"]
        table = self._of_increments
        columns = {column: column for column in ("stage", "load_parameter")}
        for column in table:
            found = RECORDED.fullmatch(column)
            if found and name in (found["place"], found["region"]):
                columns[f"{found['vector']}_{found['part']}" if found["vector"] else found["scalar"]] = column
        return Table({short: table[c] for short, c in columns.items()}, {s: table.units[c] for s, c in columns.items()})

    @cached_property
    def column(self) -> "Result":
        """Of a tunnel: its column, a run of its own, which gave K0."""
        if not (self.folder / "column" / "run.h5").exists():
            raise Missing(f"{self.folder} has no column")
        return Result(self.folder / "column")

    def to_pandas(self, table: str = "") -> Any:
        """A table as a pandas.DataFrame; which one without a name: see `table`. Raises ImportError without pandas."""
        return self.table(table).to_pandas()

    def to_xarray(self, *names: str, stage: str | None = None) -> Any:
        """Fields over the increments, all or these, as an xarray.Dataset with the dimensions increment, element, point
        (of Gauss), node, component (xx, yy, xy) and axis (x, y). Raises ImportError without xarray."""
        from .frames import dataset_of

        return dataset_of(self, names, self._chosen(stage))

    def _facts(self) -> list[str]:
        facts = [f"kind {self.kind}"]
        if self.increments:
            facts.append(f"{len(self.increments)} increments of {', '.join(self.stages)}")
        if self.has_mesh:
            facts.append(f"{len(self.connectivity)} elements")
        if self.tables:
            facts.append(f"tables {', '.join(self.tables)}" if len(self.tables) <= 6 else f"{len(self.tables)} tables")
        failed = sum(not increment.attributes.get("converged", 1) for increment in self.increments)
        return [
            *facts,
            *([f"{failed} increments not converged"] if failed else []),
            *(["still running"] if self.is_running else []),
        ]


def numbers_of(increments: Iterable[Increment]) -> Table:
    """The numbers of increments as columns; not a number where an increment does not have one."""
    all_of_them = list(increments)
    left_out = ("format", "format_version", "case_kind", "fingerprint")
    names = dict.fromkeys(name for i in all_of_them for name in i.attributes if name not in left_out)
    columns = {name: np.array([i.attributes.get(name, np.nan) for i in all_of_them]) for name in names}
    return Table(columns, {name: unit for i in all_of_them for name, unit in i.units.items()})


def increment_files(folder: Path) -> list[Path]:
    """The folder's files are read, not the links of run.h5: a killed run may have one increment more than its index."""
    try:
        found = [p for p in folder.iterdir() if re.fullmatch(r"\d+\.h5", p.name)]
    except FileNotFoundError:
        return []
    except OSError as error:
        raise Unreadable(f"{folder} cannot be read: {error.strerror}") from error
    return sorted(found, key=lambda p: int(p.stem))


def _check_folder(folder: Path, index: Path) -> None:
    try:
        there = index.exists()
    except OSError as error:
        raise Unreadable(f"{folder} cannot be read: {error.strerror}") from error
    if there:
        return
    if folder.is_file():
        raise Unreadable(f"{folder} is a file, not the folder of a run")
    if not folder.exists():
        raise Unreadable(f"{folder} does not exist")
    begun = " yet: its run has just begun" if is_running(folder) else ""
    raise Unreadable(f"{folder} has no run.h5{begun}: {KINDS}")
