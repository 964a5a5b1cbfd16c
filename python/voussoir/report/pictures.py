"""The figures of tools/figures.py for the page: drawn, compressed and with a sentence each."""

import base64
import io
import tempfile
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
from PIL import Image

from voussoir.figures import guard, style
from voussoir.figures.catalogue import Figures
from voussoir.figures.output import is_of_the_machine
from voussoir.figures.result import Missing, Unreadable

DOTS_PER_INCH = 100
QUALITY = 75  # of WebP; a figure takes 20 to 90 kB


@dataclass
class Picture:
    name: str  # of its file, without the ending
    uri: str = ""  # data:image/webp;base64,...
    size: tuple[int, int] = (0, 0)
    text: str = ""  # the sentence below it
    number: str = ""  # of the study's figure or table
    what: str = ""  # what it shows


@dataclass
class Drawn:
    pictures: list[Picture]
    missing: list[str]  # why others could not be drawn
    faults: list[str]  # of this tool
    unreadable: bool = False  # a file of the result is damaged
    tables: list[tuple[str, str]] = field(default_factory=list)  # name and text of a table in Markdown

    def __add__(self, other: "Drawn") -> "Drawn":
        return Drawn(
            self.pictures + other.pictures,
            self.missing + other.missing,
            self.faults + other.faults,
            self.unreadable or other.unreadable,
            self.tables + other.tables,
        )


def chosen(figures: Figures, only: list[str] | None) -> Figures:
    """The figures with these names, without an ending; all of them where `only` is None."""
    return {name: draw for name, draw in figures.items() if only is None or Path(name).stem in only}


def draw_all(figures: Mapping[str, Callable[[Any, Path], None]], data: Any, note: str = "") -> Drawn:
    """Draws each figure that the data allow; one that fails loses no other one."""
    drawn = Drawn([], [], [])
    style.use_style()
    style.set_note(note)
    plt.rcParams["savefig.dpi"] = DOTS_PER_INCH
    with tempfile.TemporaryDirectory() as folder:
        for name, draw in figures.items():
            if name not in ("trends.md", "study.md"):  # the page has them as parts of its own
                _draw(drawn, draw, data, Path(folder) / name)
    style.set_note("")
    return drawn


def _draw(drawn: Drawn, draw: Callable[[Any, Path], None], data: Any, path: Path) -> None:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # tools/figures.py tells them
            draw(data, path)
    except Missing as reason:
        drawn.missing.append(f"{path.stem}: {reason}")
        drawn.unreadable = drawn.unreadable or isinstance(reason, Unreadable)
    except Exception as error:  # whatever it is, it must not lose the other figures
        if is_of_the_machine(error):
            raise
        drawn.faults.append(f"{path.stem}: {guard.describe(error)}")
    else:
        if path.suffix == ".png":
            drawn.pictures.append(embedded(path))
        elif path.suffix == ".md":
            drawn.tables.append((path.stem, path.read_text()))
    finally:
        plt.close("all")


def embedded(path: Path) -> Picture:
    """A picture file as WebP in a data URI."""
    with Image.open(path) as image:
        size = image.size
        packed = io.BytesIO()
        image.convert("RGB").save(packed, "WEBP", quality=QUALITY, method=4)
    return Picture(path.stem, f"data:image/webp;base64,{base64.b64encode(packed.getvalue()).decode()}", size)
