"""One look for all figures."""

import argparse
import io
import textwrap
from pathlib import Path

import matplotlib
import numpy as np
from cycler import cycler
from matplotlib.figure import Figure
from PIL import Image

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from .output import write

# Okabe and Ito's colours, which readers with any colour vision tell apart; "C0", "C1", ... are these in this order.
CYCLE = ("#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#000000", "#8C6D1F")
LINES, MARKERS = ("-", "--", "-.", ":"), "osv^DPX*"  # so that curves differ in print without colours as well
SEQUENTIAL = "viridis"
STRAIN = "magma_r"  # sequential from white: nothing has happened where a field of strain is white
DIVERGING = "RdBu_r"  # red against blue with white between them, of fields with a sign
WEAK_FORCE, STRONG_FORCE, STRONGEST_FORCE = "#56B4E9", "#D55E00", "#6B1A00"  # they also differ in lightness
FORMATS = ("png", "svg", "pdf")


def add_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--format", choices=FORMATS, default="png", help="of the figures; svg and pdf are vectors")


def file_name(name: str, form: str) -> str:
    """The name of a figure in another format; tables keep theirs."""
    return str(Path(name).with_suffix(f".{form}")) if name.endswith(".png") else name


def use_style() -> None:
    plt.rcParams.update(
        {
            "figure.dpi": 110,
            "savefig.dpi": 160,
            "savefig.bbox": "tight",
            "font.size": 11,
            "axes.titlesize": 12,
            "axes.labelsize": 11,
            "legend.fontsize": 9.5,
            "axes.grid": True,
            "grid.alpha": 0.3,
            "axes.axisbelow": True,
            "lines.linewidth": 1.6,
            "image.cmap": SEQUENTIAL,
            "axes.prop_cycle": cycler(color=CYCLE),
            "pdf.fonttype": 42,  # letters stay letters
            "svg.hashsalt": "voussoir",  # so that equal figures are equal files
            "legend.framealpha": 0.9,
        }
    )


def colours(name: str, count: int) -> np.ndarray:
    """Colours of a sequence, without the palest end of the colour map."""
    return plt.get_cmap(name)(np.linspace(0.0, 0.87, max(count, 2)))[:count]


LETTERS_AN_INCH = 15  # of the note, which is set in 8 points

_WITHOUT_DATE = {"png": {}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}
_notes: list[str] = []


def set_note(text: str) -> None:
    """A line below each of the figures that follow; empty: none."""
    _notes[:] = [text] if text else []


def save(figure: Figure, path: Path, few_colours: bool = False) -> None:
    """Writes a figure in the format that the name of the file ends in, and closes it. `few_colours`: a PNG has at most
    256 colours, and a third of the size."""
    for note in _notes:
        figure.draw_without_rendering()  # a layout that is computed moves the axes only then
        width, height = figure.get_size_inches()
        lines = textwrap.fill(note, int(width * LETTERS_AN_INCH))
        below = figure.get_tightbbox().y0 / height - 0.1 / height  # under all that is drawn, legends too
        figure.text(0.5, below, lines, ha="center", va="top", fontsize=8, color="0.35")
    picture = io.BytesIO()  # so that a full disk is met by `write` alone
    form = path.suffix.removeprefix(".")
    figure.savefig(picture, format=form, metadata=_WITHOUT_DATE[form])
    plt.close(figure)
    write(path, _with_palette(picture) if few_colours and form == "png" else picture.getvalue())


def _with_palette(picture: io.BytesIO) -> bytes:
    small = io.BytesIO()
    Image.open(picture).convert("RGB").quantize(256).save(small, format="png", optimize=True)
    return small.getvalue()
