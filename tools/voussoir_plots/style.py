"""One look for all figures."""

import io
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


def save(figure: Figure, path: Path) -> None:
    picture = io.BytesIO()  # so that a full disk is met by `write` alone
    figure.savefig(picture, format="png")
    plt.close(figure)
    write(path, picture.getvalue())
