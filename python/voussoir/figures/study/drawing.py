"""What the figures of a study share: curves with bands, the colours of covers, soils and depths, the note below."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...ensembles import Bands
from ..style import CYCLE, LINES, save, set_note
from .data import Tunnel

COLOUR_OF_SOIL = {"dense sand": CYCLE[0], "medium dense sand": CYCLE[3], "gravel": CYCLE[2]}
LINE_OF_SOIL = {"dense sand": LINES[0], "medium dense sand": LINES[1], "gravel": LINES[2]}


def colour_of_cover(tunnel: Tunnel) -> str:
    """Shallow orange, middle blue, deep purple: they differ for readers with any colour vision."""
    return CYCLE[1] if tunnel.cover_ratio < 2.5 else CYCLE[0] if tunnel.cover_ratio < 3.5 else CYCLE[4]


def line_of_cover(tunnel: Tunnel) -> str:
    return LINES[1] if tunnel.cover_ratio < 2.5 else LINES[0] if tunnel.cover_ratio < 3.5 else LINES[2]


def colour_of_soil(tunnel: Tunnel) -> str:
    return COLOUR_OF_SOIL.get(tunnel.soil, CYCLE[6])


def line_of_soil(tunnel: Tunnel) -> str:
    return LINE_OF_SOIL.get(tunnel.soil, LINES[3])


def draw_bands(
    axis: Axes,
    x: np.ndarray,
    bands: Bands,
    colour: str | np.ndarray,
    label: str = "_",
    scale: float = 1.0,
    line: str = "-",
) -> None:
    """The mean, the band of the mean and the members as thin lines; a single run is one line. Two members have no band:
    Student's of one degree of freedom is nine times their deviation, and would hide everything else."""
    mean, half = scale * bands.mean, np.abs(scale) * bands.mean_half_width
    if len(bands.members) > 2:
        axis.fill_between(x, mean - half, mean + half, color=colour, alpha=0.22, linewidth=0)
    if len(bands.members) > 1:
        for member in bands.members:
            axis.plot(x, scale * member, color=colour, linewidth=0.4, alpha=0.7)
    axis.plot(x, mean, line, color=colour, linewidth=1.9, label=label)


def over_the_loss(axis: Axes, label: str, zero: bool = False) -> None:
    """Labels of an axis against V_l; `zero`: the values begin at 0 or below."""
    axis.set_xlabel("volume loss  $V_l$  [%]")
    axis.set_xlim(left=0)
    axis.set_ylabel(label)
    if zero:
        axis.set_ylim(bottom=min(0, axis.get_ylim()[0]))


def about_singles(tunnels: Sequence[Tunnel]) -> str:
    single = [t.name for t in tunnels if t.count == 1]
    return f"Single runs without bands: {', '.join(single)}." if single else ""


def about_bands(tunnels: Sequence[Tunnel]) -> str:
    """What lines and bands are."""
    many = [t for t in tunnels if t.count > 1]
    parts = []
    if many:
        counts = sorted({t.count for t in many})
        members = " or ".join(str(count) for count in counts)
        parts.append(
            f"Thick line: mean of {members} members (draws of the packings); band: 95 % band of this mean; thin lines: "
            "the members."
        )
        if any(t.count == 2 for t in many):
            parts.append("Two members have no band.")
    return " ".join([*parts, about_singles(tunnels)]).strip()


def about_members(tunnels: Sequence[Tunnel]) -> str:
    """Which members the pictures of fields show."""
    parts = []
    for tunnel in tunnels:
        if tunnel.count > 1:
            parts.append(f"{tunnel.name}: {tunnel.representative.folder.name} of {tunnel.count}")
        else:
            parts.append(f"{tunnel.name}: a single run")
    return f"Members shown: {'; '.join(parts)} (the member whose settlement of the surface at the end is the median)."


@contextmanager
def noted(*notes: str) -> Iterator[None]:
    """Figures that are written meanwhile have these notes below them."""
    set_note(" ".join(note for note in notes if note))
    try:
        yield
    finally:
        set_note("")


def finish(figure: Figure, path: Path, *notes: str) -> None:
    """Writes the figure with the notes below it."""
    with noted(*notes):
        save(figure, path)
