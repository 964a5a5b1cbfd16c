"""What a path holds: a run of one of the kinds, packings, an ensemble or a sweep. `catalogue.OF` has the figures of
each sort by its name, such as "a tunnel"."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..element_results import is_probe
from ..ensembles import is_ensemble
from ..packing_files import is_packing, packing_files
from ..sweeps import is_sweep
from . import element_tests, ensemble
from .packings import Packings
from .probes import Probe
from .result import Missing, Result, RunIndex, Unreadable
from .settings import Settings
from .sweep import Sweep

SORTS = {  # of runs, by their kind
    "scene": "a scene",
    "tunnel": "a tunnel",
    "column": "a column",
    "biaxial_bvp": "a biaxial specimen",
    "biaxial": "biaxial tests",
    "calibrate": "a calibration",
}


@dataclass
class Source:
    what: str  # a key of catalogue.OF
    data: Any  # what the figures of this sort are drawn from
    left_out: list[Missing] = field(default_factory=list)
    note: str = ""  # for the foot of each figure


def open_source(paths: Sequence[Path], settings: Settings) -> Source:
    """One run, ensemble, sweep or folder of packings, several files of packings, or several runs of kind biaxial."""
    if any(is_packing(path) for path in paths):
        packings = Packings([file for path in paths for file in packing_files(path)])
        return Source("packings", packings, packings.left_out)
    if len(paths) > 1:
        return _several_runs(paths)
    (path,) = paths
    if is_sweep(path):
        sweep = Sweep(path, settings)
        return Source("a sweep", sweep, sweep.left_out)
    if is_ensemble(path):
        return Source("an ensemble", ensemble.Ensemble(path, settings))
    if is_probe(path):
        probe = Probe(path)
        return Source("a probe", probe, probe.left_out)
    return _run(path, settings)


def _run(path: Path, settings: Settings) -> Source:
    index = RunIndex(path)
    what = SORTS.get(index.kind, "a tunnel" if index.has_mesh else None)
    if what is None:
        raise Unreadable(f"{path} has results of the kind {index.kind}, which these tools do not know")
    if what == "biaxial tests":
        return Source(what, [element_tests.Series(index)])
    if what == "a calibration":
        return Source(what, index, index.left_out)
    result = Result(path, settings)
    return Source(what, result, result.left_out, result.draw_note())


def _several_runs(paths: Sequence[Path]) -> Source:
    """Runs of kind biaxial are drawn together; those that cannot be read are left out."""
    series, left_out = element_tests.read(paths)
    if not series:
        raise left_out[0]
    return Source("biaxial tests", series, left_out)
