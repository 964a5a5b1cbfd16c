"""What a run tells of itself: its input, where it comes from, what it cost, and what its reader must be warned of."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from voussoir.figures.result import Missing, check_format, plain, reading

MOST_NAMED = 12  # unconverged increments that a warning names one by one; of other warnings FEW
FEW = 4
SUMS = {  # columns of the table whose sums tell the cost: label, factor, unit
    "wall_s": ("wall time without output", 1.0, "s"),
    "time_grains": ("of it: grains", 1.0, "s"),
    "time_tangents": ("of it: static tangents", 1.0, "s"),
    "time_assembly": ("of it: assembly", 1.0, "s"),
    "time_solve": ("of it: factorisations and solutions", 1.0, "s"),
    "time_output": ("wall time that waited for output", 1.0, "s"),
    "particle_steps": ("particle steps (grains × DEM steps)", 1.0, "-"),
    "evaluations": ("evaluations of the material batch", 1.0, "-"),
    "iterations": ("Newton iterates", 1.0, "-"),
    "cuts": ("cuts (halved increments)", 1.0, "-"),
}


@dataclass
class Facts:
    """Of one run; what its files do not tell is empty."""

    folder: Path
    kind: str = ""
    input: str = ""
    provenance: dict[str, Any] = field(default_factory=dict)
    table: dict[str, np.ndarray] = field(default_factory=dict)  # columns, one row an increment
    locked: str = ""  # the text of run.lock

    @property
    def increments(self) -> int:
        return len(self.table.get("stage", ()))

    def column(self, name: str) -> np.ndarray:
        """A numeric column; zeros where the run did not write it, as in rows that hold the start of a stage."""
        return np.nan_to_num(np.asarray(self.table.get(name, np.zeros(self.increments)), dtype=float))


def read(folder: Path, index: str = "run.h5") -> Facts:
    """The facts of a run or an ensemble."""
    facts = Facts(folder)
    lock = folder / "run.lock"
    if lock.is_file():
        facts.locked = " ".join(lock.read_text(errors="replace").split())[:200]
    path = folder / index
    if not path.exists():
        return facts
    with reading(path) as file:
        check_format(file, path, "voussoir ensemble" if index == "ensemble.h5" else "voussoir run")
        facts.input = plain(file["input"][()]) if "input" in file else ""
        facts.provenance = {name: plain(value) for name, value in file["provenance"].attrs.items()}
        facts.kind = str(facts.provenance.get("case_kind", ""))
        if index == "run.h5" and "table" in file:
            facts.table = {name: data[()] for name, data in file["table"].items()}
    if "stage" in facts.table:
        facts.table["stage"] = np.array([plain(value) for value in facts.table["stage"]])
    return facts


def cost(facts: Facts) -> list[tuple[str, str]]:
    """(what, how much) for the page's table; empty for a run without increments."""
    if not facts.increments:
        return []
    rows = [("increments", str(facts.increments))]
    for name, (label, factor, unit) in SUMS.items():
        if name in facts.table:
            total = factor * float(np.nansum(facts.column(name)))
            rows.append((label, amount(total) + ("" if unit == "-" else f" {unit}")))
    if "converged" in facts.table:
        rows.append(("unconverged increments", str(int((facts.column("converged") == 0).sum()))))
    if "peak_memory" in facts.table:
        peak = np.nanmax(facts.column("peak_memory"), initial=0)  # not measured at the start of a stage
        rows.append(("peak memory of the first process", f"{peak / 2**20:.0f} MiB"))
    if "threads" in facts.provenance:
        rows.append(("threads × processes", f"{facts.provenance['threads']} × {facts.provenance.get('ranks', 1)}"))
    return rows


def amount(value: float) -> str:
    """ "12 340" or "1.23e+10", and "–" where nothing is known."""
    if not np.isfinite(value):
        return "–"
    return f"{value:.4g}" if value >= 1e6 else f"{value:,.4g}".replace(",", " ")


def warnings(facts: Facts) -> list[str]:
    """What must be seen at the top of the page; empty where nothing is wrong."""
    found = []
    if facts.locked:
        found.append(
            f"The run is still computed, or was killed: its folder holds run.lock ({facts.locked}). "
            "The page shows what was written until now."
        )
    if not facts.increments:
        return found
    unconverged = facts.column("converged") == 0 if "converged" in facts.table else np.zeros(facts.increments, bool)
    if unconverged.any():
        told = f"NOT CONVERGED: {counted(unconverged.sum(), 'increment')} of {facts.increments}"
        found.append(f"{told}: {named(facts, unconverged, 'residual', 'residual {:.2g}', MOST_NAMED)}.")
    for name, what, unit in (
        ("cuts", "cut (halved)", "cut"),
        ("step_limit_points", "left with RVEs at the step limit, which are not at rest", "RVE"),
        ("out_of_range_points", "left with RVEs beyond the range of the contact law", "RVE"),
    ):
        where = facts.column(name) > 0
        if where.any():
            told = f"{counted(where.sum(), 'increment')} of {facts.increments}: {what}"
            found.append(f"{told}: {named(facts, where, name, '{:.0f} ' + unit)}.")
    opened = facts.column("open_points")
    if opened.max(initial=0) > 0:
        found.append(f"RVEs without contacts: up to {opened.max():.0f}, at the end {opened[-1]:.0f}.")
    return found


def counted(count: int, what: str) -> str:
    return f"{count} {what}{'' if count == 1 else 's'}"


def named(facts: Facts, where: np.ndarray, column: str, form: str, most: int = FEW) -> str:
    """The increments of a mask by stage and load, e.g. "volume_loss 2.5 % (3 RVEs)"; the worst where they are many."""
    rows = np.flatnonzero(where)
    values = facts.column(column)
    few = sorted(rows[np.argsort(-values[rows], kind="stable")][:most])
    parts = [f"{_place(facts, k)} ({form.format(values[k])})" for k in few]
    rest = f" and {len(rows) - len(few)} others" if len(rows) > len(few) else ""
    return ("the worst are " if rest else "") + ", ".join(parts) + rest


def _place(facts: Facts, row: int) -> str:
    stage = str(facts.table["stage"][row])
    load = float(facts.column("load_parameter")[row])
    share = stage in ("volume_loss", "biaxial_bvp") and facts.kind != "scene"
    return f"{stage} {100 * load:.4g} %" if share else f"{stage} at {load:.4g}"


def unfinished(case: dict[str, Any], facts: Facts) -> list[str]:
    """A tunnel that ended before the volume loss which its case asks for, or a scene before its last stage's end."""
    if facts.kind == "scene" and facts.increments:
        return _unfinished_scene(case, facts)
    wanted = _fraction(case.get("volume_loss", {}).get("total")) if facts.kind == "tunnel" else None
    if wanted is None or not facts.increments:
        return []
    reached = float(facts.column("volume_loss").max(initial=0))
    if reached >= wanted * (1 - 1e-6):
        return []
    return [f"The run reached V_l = {100 * reached:.4g} % of the {100 * wanted:.4g} % that its case asks for."]


def _unfinished_scene(case: dict[str, Any], facts: Facts) -> list[str]:
    stages = [str(stage.get("name", "")) for stage in case.get("stage", [])]
    name, load = str(facts.table["stage"][-1]), float(facts.column("load_parameter")[-1])
    if not stages or (name == stages[-1] and load >= 1 - 1e-6):
        return []
    place = f"the stage {name}, of {len(stages)} stages number {stages.index(name) + 1}" if name in stages else name
    return [f"The run reached the load parameter {load:.4g} of {place}."]


def _fraction(text: Any) -> float | None:
    """ "20 %" or 0.2 as 0.2; None where it is neither."""
    try:
        return float(str(text).replace("%", "")) / (100 if "%" in str(text) else 1)
    except ValueError:
        return None


def readable(folders: Iterable[Path]) -> tuple[list[Facts], list[str]]:
    """The facts of several runs, and why others cannot be read."""
    found, failed = [], []
    for folder in folders:
        try:
            found.append(read(folder))
        except Missing as reason:
            failed.append(str(reason))
    return found, failed
