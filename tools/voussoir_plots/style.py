"""One look for all figures."""

import io
import textwrap
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from .output import write


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
            "image.cmap": "viridis",
            "legend.framealpha": 0.9,
        }
    )


def colours(name: str, count: int) -> np.ndarray:
    """Colours of a sequence, without the palest end of the colour map."""
    return plt.get_cmap(name)(np.linspace(0.0, 0.87, max(count, 2)))[:count]


LETTERS_AN_INCH = 15  # of the note, which is set in 8 points

_notes: list[str] = []


def set_note(text: str) -> None:
    """A line below each of the figures that follow; empty: none."""
    _notes[:] = [text] if text else []


def save(figure: Figure, path: Path) -> None:
    for note in _notes:
        figure.draw_without_rendering()  # a layout that is computed moves the axes only then
        width, height = figure.get_size_inches()
        lines = textwrap.fill(note, int(width * LETTERS_AN_INCH))
        below = figure.get_tightbbox().y0 / height - 0.1 / height  # under all that is drawn, legends too
        figure.text(0.5, below, lines, ha="center", va="top", fontsize=8, color="0.35")
    picture = io.BytesIO()  # so that a full disk is met by `write` alone
    figure.savefig(picture, format="png")
    plt.close(figure)
    write(path, picture.getvalue())
