"""Opens folders of results: which kind a folder holds, its files tell."""

from pathlib import Path

from .element_results import PackResult, ProbeResult, is_probe
from .ensembles import Ensemble, is_ensemble
from .errors import Unreadable
from .packing_files import is_packing
from .results import Result
from .sweeps import Sweep, is_sweep


def open_result(folder: Path | str) -> Result:
    """The result of one run of any kind, or packings (a folder or a file of them), as NumPy arrays.

    A run that still goes on can be opened: its result has what is written until now. Raises Unreadable where the
    folder has no results or a file is damaged; ensembles and sweeps have open_ensemble and open_sweep."""
    path = Path(folder)
    if path.name == "run.h5":
        path = path.parent
    if is_packing(path):
        return PackResult(path)
    if is_probe(path):
        return ProbeResult(path)
    if (path / "run.h5").exists():
        return Result(path)
    if is_ensemble(path):
        raise Unreadable(f"{path} is an ensemble, which voussoir.open_ensemble opens")
    if path.is_dir() and is_sweep(path):
        raise Unreadable(f"{path} is a sweep, which voussoir.open_sweep opens")
    return Result(path)  # which tells why there is none


def open_ensemble(folder: Path | str) -> Ensemble:
    """Means and bands of an ensemble as NumPy arrays. Raises Unreadable where the folder has none."""
    path = Path(folder)
    if not is_ensemble(path) and (path / "run.h5").exists():  # is_ensemble tells of one that is not reduced yet
        raise Unreadable(f"{path} is a run without ensemble.h5, which voussoir.open_result opens")
    return Ensemble(path)


def open_sweep(folder: Path | str) -> Sweep:
    """The table of a sweep's runs, each of which opens. A sweep that still runs can be opened. Raises Unreadable where
    the folder has no sweep."""
    path = Path(folder)
    if not is_sweep(path):
        there = "" if path.is_dir() else ": it does not exist, or is no folder"
        raise Unreadable(f"{path} has no sweep{there}")
    return Sweep(path)
