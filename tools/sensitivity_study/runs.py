"""The runs of a sweep of named points, and what is measured of each."""

import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from voussoir.figures import points, reaction
from voussoir.figures.result import Missing, Result

from . import fits, measures, places

AC_HEIGHT = 2.0  # above the crown, in D: where the tools took Ac before this comparison, which still reads it there
HIGHER = 2.25  # where they take it since (z/C = 0.25 at C/D = 3): there it contracts until V_l = 15 %
TUNNELS = "tunnels"  # grid of the sweep
LATE = 0.12  # V_l until which a place must contract; trends.contracts_until allows 3 % below the 15 % of the study


class Fault(Exception):
    """The input cannot be used; the message says why in one line."""


def settings_of(sweep: Path) -> dict[str, str]:
    """{point: its overrides} of the named axes of the tunnels' grid of a sweep file, in the file's order."""
    try:
        grids = tomllib.loads(sweep.read_text()).get("grid", [])
    except OSError as error:
        raise Fault(f"{sweep} cannot be read: {error.strerror}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise Fault(f"{sweep} is no TOML: {error}") from error
    found: dict[str, str] = {}
    for grid in grids if isinstance(grids, list) else []:
        if grid.get("name") != TUNNELS:
            continue
        for axis in (value for value in grid.values() if isinstance(value, dict)):
            for point, change in axis.items():
                changes = change if isinstance(change, list) else [change]
                found[point] = ", ".join(f"`{text}`" for text in changes)
    if not found:
        raise Fault(f'{sweep} has no grid "{TUNNELS}" with an axis of named points')
    return found


def members_of(folder: Path) -> list[Path]:
    """The folders of runs of one point: its members, or itself."""
    inner = sorted(p.parent for p in folder.glob("member_*/run.h5"))
    return inner or ([folder] if (folder / "run.h5").exists() else [])


class Measured:
    """What the tables say of one run."""

    def __init__(self, result: Result) -> None:
        self.result, self.loss = result, result.volume_loss
        self.folder = result.folder
        self.reactions = places.reactions(result)
        self.levels = {level.height: level for level in places.levels(result)}

    @cached_property
    def crown(self) -> measures.Recovery:
        return measures.recovery(self.loss, self.reactions[places.CROWN_ELEMENT])

    @cached_property
    def opening(self) -> measures.Recovery | None:
        """Over the width of the opening, where the mesh has points there."""
        curve = self.reactions.get(places.PLACES[0].label)
        return None if curve is None else measures.recovery(self.loss, curve)

    @cached_property
    def initial(self) -> float:
        """Vertical stress of the crown's element before the loss [Pa]."""
        return float(reaction.curve(self.result)[2])

    @cached_property
    def ac(self) -> measures.Contraction:
        """Of the single Gauss point that is nearest to the axis at AC_HEIGHT."""
        (diameter,) = self.result.need("diameter")
        if AC_HEIGHT * diameter > self.result.cover:
            raise Missing(f"{self.folder}: the point Ac would lie above the surface")
        place = points.nearest(self.result, "Ac", 0.0, self.result.crown_height + AC_HEIGHT * diameter)
        volumetric = points.history(self.result, "gauss/volumetric_strain", place)
        return measures.contraction(self.loss, volumetric)

    @cached_property
    def late_heights(self) -> tuple[float, float] | None:
        """The lowest and the highest height on the axis that contract until V_l = LATE or longer, in D."""
        volumes = [level.volume for level in self.levels.values()]
        return measures.heights_that_contract(self.levels, volumes, LATE)

    @cached_property
    def fits(self) -> dict[float, fits.Fits]:
        return fits.of_all_depths(self.result)


@dataclass
class Variation:
    """One point of the sweep with its draws."""

    name: str
    settings: str
    runs: list[Measured]


def measured(folder: Path) -> Measured:
    """A run that has come to V_l = 20 %; Missing where it has not."""
    result = Result(folder)
    if result.volume_loss[-1] < 0.2 - 1e-9:
        raise Missing(f"{folder} ends at V_l = {100 * result.volume_loss[-1]:.3g} %")
    return Measured(result)


def _all_of(name: str, settings: str, folders: list[Path]) -> Variation:
    variation = Variation(name, settings, [])
    for folder in folders:
        try:
            variation.runs.append(measured(folder))
        except Missing as reason:
            print(f"left out: {reason}", file=sys.stderr)
    return variation


def variations(folder: Path, sweep: Path) -> Iterator[Variation]:
    """Those points of the sweep that have a run which came to its end."""
    if not folder.is_dir():
        raise Fault(f"{folder} is no folder")
    for name, settings in settings_of(sweep).items():
        found = _all_of(name, settings, members_of(folder / TUNNELS / name))
        if found.runs:
            yield found


def at_full_size(folders: list[Path]) -> Variation:
    return _all_of("at full size", "", folders)
