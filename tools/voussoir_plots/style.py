"""One look for all figures."""

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)


def use_style():
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


def colours(name, count):
    """Colours of a sequence, without a map's palest end."""
    return plt.get_cmap(name)(np.linspace(0.0, 0.87, max(count, 2)))[:count]


def percent(fraction):
    """0.125 -> '12.5 %'"""
    return f"{100 * fraction:.3g} %"


def save(figure, path):
    figure.savefig(path)
    plt.close(figure)
