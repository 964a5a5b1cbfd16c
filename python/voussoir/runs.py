"""Runs of the program from Python, each in a process of its own: run, ensemble, sweep.

How the program ends becomes a result or an exception (docs/reference/exit_status.md): InputError with file, line and
key, NoEquilibrium, MachineFailure, Interrupted; Ctrl-C ends a run after its increment, and KeyboardInterrupt follows.
"""

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from .ensembles import Ensemble
from .errors import InputError
from .opening import open_ensemble, open_result, open_sweep
from .programs import Ended, Process, find_program
from .progress import Told, progress_of
from .results import Result
from .settings import as_texts
from .sweeps import Sweep

Settings = Mapping[str, Any] | Sequence[str]
PACKINGS = "out/packings"  # where packings go unless a case says otherwise


def run(
    case: Path | str,
    out: Path | str | None = None,
    *,
    settings: Settings = (),
    resume: bool = False,
    replace: bool = False,
    program: Path | str | None = None,
    threads: int | None = None,
    progress: bool | Told | None = None,
) -> Result:
    """Runs a case file and opens its result.

    out: folder of the results (out/TITLE of the case); of the kind pack, which has none, the packings are opened.
    settings: keys that replace those of the case, as {"packing.grains": 300, "ground.diameter": "6 m"} or as texts
    "table.key=value". resume: go on with an earlier run in the folder; replace: remove its results first. program: the
    program (else that of the environment variable VOUSSOIR, of the PATH, of the checkout's build). threads: their
    number (OMP_NUM_THREADS, or all cores).
    progress: None shows a bar in a notebook and a line in a terminal; False nothing; a function gets each line.

    Raises InputError where the input has a fault, NoEquilibrium where no equilibrium is found (`folder` of the
    exception has the results up to there, its `lines` what the program printed), MachineFailure, and KeyboardInterrupt
    after Ctrl-C: then resume=True goes on. Where this process is killed, the run goes on; open_result(out) shows it.
    """
    chosen = as_texts(settings)
    folder = Path(out) if out is not None else Path("out") / _title(case, chosen)
    words = ["run", str(case), "-o", str(folder), *_sets(chosen)]
    words += ["--resume"] * resume + ["--replace"] * replace + _threads(threads)
    packs = value_of(case, chosen, "kind", "") == "pack"
    _until_the_end(words, folder, program, progress)
    return open_result(value_of(case, chosen, "packing.folder", PACKINGS) if packs else folder)


def ensemble(
    case: Path | str,
    out: Path | str | None = None,
    *,
    members: int | None = None,
    until: str | None = None,
    result: str | None = None,
    jobs: int | None = None,
    settings: Settings = (),
    resume: bool = False,
    program: Path | str | None = None,
    threads: int | None = None,
    progress: bool | Told | None = None,
) -> Ensemble:
    """Runs a case with several draws of its packings and opens their means and bands (out/TITLE_ensemble).

    members: their number (-n of the program); until: the standard error of the `result`, over its mean, that is enough,
    such as "5 %"; jobs: runs at a time; threads: of each run. Further arguments and exceptions: `run`.
    """
    chosen = as_texts(settings)
    folder = Path(out) if out is not None else Path("out") / f"{_title(case, chosen)}_ensemble"
    words = ["ensemble", str(case), "-o", str(folder), *_sets(chosen), *_given("-n", members), *_given("-j", jobs)]
    words += [*_given("--until", until), *_given("--result", result), *["--resume"] * resume, *_threads(threads)]
    _until_the_end(words, folder, program, progress)
    return open_ensemble(folder)


def sweep(
    file: Path | str,
    out: Path | str | None = None,
    *,
    jobs: int | None = None,
    resume: bool = False,
    program: Path | str | None = None,
    threads: int | None = None,
    progress: bool | Told | None = None,
) -> Sweep:
    """Runs the cases of a sweep file and opens the table of its runs (out/STEM of the file).

    jobs: runs at a time; threads: of each run. Where one of the runs failed, the exception is that of the sweep's exit
    status, and open_sweep(error.folder) has the others. Further arguments and exceptions: `run`.
    """
    folder = Path(out) if out is not None else Path("out") / Path(file).stem
    words = ["sweep", str(file), "-o", str(folder), *_given("-j", jobs), *["--resume"] * resume, *_threads(threads)]
    _until_the_end(words, folder, program, progress)
    return open_sweep(folder)


def _until_the_end(
    words: Sequence[str], folder: Path, program: Path | str | None, progress: bool | Told | None
) -> None:
    """Runs the program to its end; raises the exception of its exit status."""
    shown = progress_of(progress, f"voussoir {words[0]} {words[1]}")
    process = Process([str(find_program(program)), *words])
    interrupted = False
    lines = process.said()
    try:
        while True:
            try:
                for line, whole in lines:
                    shown.show(line, whole)
                break
            except KeyboardInterrupt:
                interrupted = True
                process.stop()
                lines = process.said()
    except BaseException:  # of the function that shows the progress: the run must not go on unseen
        process.stop()
        process.end()
        raise
    ended = process.end()
    shown.close()
    _raise_for(ended, folder, interrupted)


def _raise_for(ended: Ended, folder: Path, interrupted: bool) -> None:
    if interrupted and (ended.status == 130 or ended.status < 0):
        raise KeyboardInterrupt(f"the run in {folder} has stopped; resume=True goes on")
    if ended.status != 0:
        raise ended.error(folder)


def value_of(case: Path | str, settings: Sequence[str], key: str, default: str) -> str:
    """A text of a case file, such as "packing.folder", after the settings. A file that cannot be read has none: the
    program tells why."""
    for setting in reversed(settings):
        name, _, value = setting.partition("=")
        if name.strip() == key:
            return value.strip().strip("'\"")
    try:
        found: Any = tomllib.loads(Path(case).read_text())
        for part in key.split("."):
            found = found[part]
    except (OSError, ValueError, KeyError, TypeError):
        return default
    return str(found)


def _title(case: Path | str, settings: Sequence[str]) -> str:
    file = Path(case).resolve()
    name = value_of(case, settings, "title", file.parent.name if file.name == "case.toml" else file.stem)
    if Path(name).name != name:
        raise InputError(f"{case}: title: {name!r} is no name of a folder; name the folder of the results", key="title")
    return name


def _sets(settings: Sequence[str]) -> list[str]:
    return [word for setting in settings for word in ("--set", setting)]


def _given(option: str, value: object) -> list[str]:
    return [] if value is None else [option, str(value)]


def _threads(threads: int | None) -> list[str]:
    return _given("--threads", threads)
