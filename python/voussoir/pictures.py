"""Figures and the report page of results as functions. They need matplotlib; voussoir.figures has what they draw."""

import tempfile
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import matplotlib
import matplotlib.pyplot as plt

from .errors import Missing, Unreadable
from .figures import style
from .figures.catalogue import figures_of
from .figures.output import make_folder, write
from .figures.settings import Settings
from .figures.source import Source, open_source
from .report.making import page_of

# What a notebook shows of a result: the first of these figures for which there are data.
FIRST = (
    "ground",
    "deviatoric_strain",
    "stage_fields",
    "k0",
    "specimen",
    "biaxial_curves",
    "calibration",
    "probe_path",
    "probe_responses",
    "packings",
    "ensemble_settlement",
    "ensemble_boundaries",
    "ensemble_specimen",
    "ensemble_k0",
    "displacement",
)


@dataclass(frozen=True, repr=False)
class Picture:
    """A figure as the bytes of its file, in the format that its name ends in."""

    name: str
    content: bytes

    def __repr__(self) -> str:
        return f"<Picture {self.name}, {len(self.content)} bytes>"

    def save(self, path: Path | str) -> Path:
        """Writes the file, and returns its path."""
        write(Path(path), self.content)
        return Path(path)

    def _repr_png_(self) -> bytes | None:
        return self.content if self.name.endswith(".png") else None

    def _repr_markdown_(self) -> str | None:
        return self.content.decode() if self.name.endswith(".md") else None


def figure(folder: Path, name: str = "", **settings: Any) -> Picture:
    """One figure of the results in a folder; see voussoir.shown.Shown.figure."""
    source = open_source([folder], _settings(settings))
    everything = _of(source, [name] if name else None)
    wanted = everything if name else [file for stem in FIRST for file in everything if Path(file).stem == stem]
    reason = Missing(f"there is no picture of {source.what}")
    for file in wanted:
        try:
            return _drawn(source, file)
        except Missing as missing:
            reason = missing
    raise reason


def _settings(given: dict[str, Any]) -> Settings:
    known = [field.name for field in fields(Settings)]
    for name in given:
        if name not in known:
            raise TypeError(f"figures have no setting {name}; there are: {', '.join(known)}")
    return Settings(**given)


def _of(source: Source, only: Sequence[str] | None) -> list[str]:
    """The files of the figures of a source, all or only these, which are named with or without their ending."""
    everything = list(figures_of(source.what))
    for name in only or ():
        if name not in everything and name not in (Path(file).stem for file in everything):
            known = ", ".join(Path(file).stem for file in everything)
            raise ValueError(f"there is no figure {name} of {source.what}; there are: {known}")
    return [file for file in everything if only is None or {file, Path(file).stem} & set(only)]


def _drawn(source: Source, file: str) -> Picture:
    with tempfile.TemporaryDirectory() as folder:
        _draw(source, file, Path(folder) / file)
        return Picture(file, (Path(folder) / file).read_bytes())


def _draw(source: Source, file: str, path: Path) -> None:
    """Draws into a file. The style of the reader's own figures and figures that are open stay as they are."""
    before = set(plt.get_fignums())
    with matplotlib.rc_context(), warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of NumPy, about missing values
        style.use_style()
        style.set_note(source.note)
        try:
            figures_of(source.what)[file](source.data, path)
        finally:
            style.set_note("")
            for number in set(plt.get_fignums()) - before:
                plt.close(number)


def figures(
    folder: Path,
    output: Path | str | None = None,
    form: str = "png",
    only: Sequence[str] | None = None,
    **settings: Any,
) -> list[Path]:
    """All figures of the results in a folder; see voussoir.shown.Shown.figures."""
    source = open_source([folder], _settings(settings))
    to = Path(output) if output is not None else folder
    make_folder(to)
    written = []
    for name in _of(source, only):
        path = to / style.file_name(name, form)
        try:
            _draw(source, name, path)
        except Unreadable as reason:
            warnings.warn(f"skipped {name}: {reason}", stacklevel=3)
        except Missing:
            continue
        else:
            written.append(path)
    return written


def report(folder: Path, file: Path | str | None = None, only: Sequence[str] | None = None, **settings: Any) -> Path:
    """The HTML page of the results in a folder; see voussoir.shown.Shown.report."""
    output = Path(file) if file is not None else folder / "report.html"
    before = set(plt.get_fignums())
    with matplotlib.rc_context():
        page = page_of(folder, _settings(settings), only).page.written()
    for number in set(plt.get_fignums()) - before:
        plt.close(number)
    make_folder(output.parent)
    write(output, page)
    return output
