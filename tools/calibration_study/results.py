"""Reads the curves of finished runs, and their angles by each definition."""

import json
import re
import sys
from collections.abc import Iterable, Sequence
from functools import cache
from pathlib import Path

from voussoir.figures.result import Missing, Unreadable, check_format, reading
from voussoir.figures.rve_size import MOST_SCATTER

from .definitions import DEFINITIONS, VERSION, Test, Value, with_error
from .plan import SOILS, Set
from .runs import folder_of

MOST_OVERLAP = (
    0.06  # mean over the contacts, over r_i + r_j, up to which the program counts a test (docs/explanation/range.md)
)
COLUMNS = ("axial_strain", "lateral_strain", "volumetric_strain", "p", "q")
_CURVE = re.compile(r"seed_(\d+)_([0-9.e+]+)_kPa")

Angles = dict[str, dict[str, Value]]  # {"peak": {definition: value}, ...}


def _name(seed: float, pressure: float) -> str:
    """The table of a test; `pressure` [Pa]."""
    return f"seed_{int(seed)}_{pressure * 1e-3:.4g}_kPa"


def tests_of(folder: Path) -> list[Test]:
    """The tests of one run whose lateral stress was held and whose overlaps the contact law allows, also those that
    broke off. Raises Missing where there is no such run."""
    index = folder / "run.h5"
    if not index.exists():
        raise Missing(f"{folder} has no run.h5: the run is not finished")
    tests = []
    with reading(index) as file:
        check_format(file, index, "voussoir run")
        tables = file["tables"]
        table = {name: tables["strength"][name][()] for name in ("seed", "pressure", "lateral_scatter", "mean_overlap")}
        usable = {
            _name(seed, pressure)  # the pressure of a packing is that of its rest, 400006 Pa where 400 kPa are wanted
            for seed, pressure, scatter, overlap in zip(*table.values(), strict=True)
            if scatter <= MOST_SCATTER and overlap <= MOST_OVERLAP
        }
        for name in tables:
            found = _CURVE.fullmatch(name)
            if not found or name not in usable:
                continue
            x = {key: tables[name][key][()] for key in COLUMNS}
            if len(x["p"]) > 10:
                tests.append(Test(int(found[1]), 1e3 * float(found[2]), x["axial_strain"], x["volumetric_strain"],
                                  x["axial_strain"] - x["lateral_strain"], x["p"], x["q"]))  # fmt: skip
    if not tests:
        raise Missing(f"{folder} has no test whose lateral stress was held")
    return tests


def all_angles(tests: Sequence[Test]) -> Angles:
    return {
        kind: {name: with_error(tests, definition) for name, definition in definitions.items()}
        for kind, definitions in DEFINITIONS.items()
    }


def angles_of(folder: Path) -> Angles:
    """All definitions of one run; kept beside it, because the jackknife takes a while."""
    kept, index = folder / "angles.json", folder / "run.h5"
    newer = kept.exists() and index.exists() and kept.stat().st_mtime >= index.stat().st_mtime
    if newer and (stored := _stored(kept)):
        return stored
    angles = all_angles(tests_of(folder))
    told = {k: {n: [v.mean, v.error, v.packings] for n, v in values.items()} for k, values in angles.items()}
    kept.write_text(json.dumps({"version": VERSION, "angles": told}))
    return angles


def _stored(file: Path) -> Angles | None:
    """None where the file is of another version or damaged, as by a call that was killed: it is made anew."""
    try:
        stored = json.loads(file.read_text())
        if stored["version"] != VERSION:
            return None
        return {kind: {name: Value(*v) for name, v in values.items()} for kind, values in stored["angles"].items()}
    except (AttributeError, KeyError, TypeError, ValueError):
        return None


@cache
def say_once(line: str) -> None:
    print(line, file=sys.stderr)


def of_group(group: Path, sets: Iterable[Set]) -> dict[str, dict[str, Angles]]:
    """{set: {soil: angles}} of what is finished; what is not is left out."""
    found: dict[str, dict[str, Angles]] = {}
    for one in sets:
        for soil in SOILS:
            try:
                found.setdefault(one.name, {})[soil] = angles_of(folder_of(group, soil, one.name))
            except Unreadable as damaged:
                say_once(f"calibrate_soils: left out: {damaged}")
            except Missing:
                continue
    return found
