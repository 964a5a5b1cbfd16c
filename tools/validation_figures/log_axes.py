"""Logarithmic axes with numbers that can be read off."""

from math import log10
from typing import Literal

from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.ticker import LogLocator, NullFormatter

ALL = tuple(range(1, 10))


def log_axis(axis: Axes, which: Literal["x", "y"]) -> None:
    """Makes the axis logarithmic, with ticks at 0.1, 0.2, 0.5, 1, 2, 5, ...; over more than three decades at powers of
    ten alone, over less than 0.7 decades at every digit. All curves and limits must be there before."""
    along: Axis
    if which == "x":
        axis.set_xscale("log")
        (low, high), along = axis.get_xlim(), axis.xaxis
    else:
        axis.set_yscale("log")
        (low, high), along = axis.get_ylim(), axis.yaxis
    decades = abs(log10(high / low))
    along.set_major_locator(LogLocator(subs=(1,) if decades > 3.01 else (1, 2, 5) if decades >= 0.7 else ALL))
    along.set_major_formatter("{x:g}")
    along.set_minor_locator(LogLocator(subs=ALL))
    along.set_minor_formatter(NullFormatter())
