"""The figures of biaxial tests, drawn from the runs of a sweep: those with several pressures, which give a strength."""

from pathlib import Path

from . import strength_figures, table_two
from .element_tests import Series, read
from .result import Missing, remembered
from .sweep import Sweep


def series(sweep: Sweep) -> list[Series]:
    def look() -> list[Series]:
        found, left_out = read(member.folder for member in sweep.of_kind("biaxial"))
        several = [one for one in found if len(one.pressures) > 1]
        if not several:
            further = f" ({left_out[0]})" if left_out else ""
            raise Missing(f"{sweep.folder} has no biaxial run with several pressures{further}")
        return several

    return remembered(sweep, "biaxial tests", look)


def draw_curves(sweep: Sweep, path: Path) -> None:
    strength_figures.draw_curves(series(sweep), path)


def draw_plane(sweep: Sweep, path: Path) -> None:
    strength_figures.draw_plane(series(sweep), path)


def draw_angles(sweep: Sweep, path: Path) -> None:
    strength_figures.draw_angles(series(sweep), path)


def write_table_two(sweep: Sweep, path: Path) -> None:
    table_two.write(series(sweep), path)
