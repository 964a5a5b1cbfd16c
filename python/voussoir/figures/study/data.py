"""The tunnels of a study: each of them a single run or the members of an ensemble, found in the folder of a sweep or
named one by one."""

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from pathlib import Path

import numpy as np

from ...ensembles import INDEX, Bands
from ...sweeps import kind_of
from .. import settlements
from ..resolution import percent
from ..result import Missing, Result, Unreadable, plain, reading
from ..settings import Settings
from ..soils import NAMES
from .bands import Number, number, of_members

SAME_LOSS = 1e-6  # two V_l that are nearer than this are one state [-]
SAME_COVER = 0.01  # the same for C/D [-]

Curve = Callable[[Result], np.ndarray]  # values over the run's `volume_loss`


class Tunnel:
    """One tunnel of the study: the runs over which it is averaged, the members."""

    def __init__(self, name: str, members: Sequence[Result]) -> None:
        self.name = name
        self.members = list(members)

    @property
    def count(self) -> int:
        return len(self.members)

    @property
    def soil(self) -> str:
        """One of the study's names only where it is the study's soil."""
        return self.members[0].soil

    @property
    def nearest_soil(self) -> str:
        return self.members[0].nearest_soil

    @property
    def code(self) -> str:
        """The paper's name of the soil, where it is one of the paper's."""
        return NAMES.get(self.soil, self.soil)

    @cached_property
    def cover_ratio(self) -> float:
        """C/D [-]."""
        (diameter,) = self.members[0].need("diameter")
        return self.members[0].cover / diameter

    @property
    def label(self) -> str:
        """For legends and titles."""
        return f"{self.code}, $C/D$ = {self.cover_ratio:.3g}"

    @cached_property
    def loss(self) -> np.ndarray:
        """V_l of the states that all members have [-]."""
        common = self.members[0].volume_loss
        for member in self.members[1:]:
            away = np.abs(common[:, None] - member.volume_loss[None, :]).min(axis=1)
            common = common[away < SAME_LOSS]
        if len(common) == 0:
            raise Missing(f"the members of {self.name} have no volume loss in common")
        return common

    def rows(self, member: Result) -> np.ndarray:
        """Where the states of `loss` stand among those of a member."""
        return np.abs(self.loss[:, None] - member.volume_loss[None, :]).argmin(axis=1)

    def over_loss(self, curve: Curve) -> Bands:
        """Bands of a curve over `loss`."""
        return of_members([curve(member)[self.rows(member)] for member in self.members])

    def number(self, value: Callable[[Result], float]) -> Number:
        """A number of each member, averaged. A member that lacks its data is left out."""
        found = []
        for member in self.members:
            try:
                found.append(value(member))
            except Missing as reason:
                lacking = reason
        if not found:
            raise lacking
        return number(found)

    @cached_property
    def representative(self) -> Result:
        """The member whose settlement of the surface at the end is the median; fields are drawn from it. Of an even
        number of members it is the lower one of the two in the middle."""
        final = [float(settlements.on_axis(member, 0.0)[self.rows(member)[-1]]) for member in self.members]
        return self.members[int(np.argsort(final)[(len(final) - 1) // 2])]

    def nearest(self, loss: float) -> float:
        """The V_l among the common states next to `loss` [-]."""
        return float(self.loss[np.argmin(np.abs(self.loss - loss))])


class Study:
    """All tunnels, by soil and cover."""

    def __init__(self, tunnels: Sequence[Tunnel], left_out: Sequence[Missing] = ()) -> None:
        self.tunnels = sorted(
            tunnels, key=lambda t: (list(NAMES).index(t.soil) if t.soil in NAMES else 9, t.cover_ratio)
        )
        self.left_out = list(left_out)
        if not self.tunnels:
            raise Missing(str(self.left_out[0]) if self.left_out else "there is no tunnel with a volume loss")
        self.settings = self.tunnels[0].members[0].settings

    def covers(self) -> list[Tunnel]:
        """The tunnels in dense sand or in a soil of the user that is nearest to it, by cover."""
        found = [tunnel for tunnel in self.tunnels if tunnel.nearest_soil == "dense sand"]
        if not found:
            raise Missing("there is no tunnel in dense sand")
        return found

    def at_cover(self, *wanted: float) -> list[Tunnel]:
        """Those of `covers` with these C/D."""
        found = [t for t in self.covers() if any(abs(t.cover_ratio - c) < SAME_COVER for c in wanted)]
        if not found:
            raise Missing(f"there is no tunnel in dense sand at C/D = {' or '.join(f'{c:g}' for c in wanted)}")
        return found

    def main(self) -> Tunnel:
        """The tunnel whose stresses and RVEs the paper shows: dense sand at C/D = 3, else the first in dense sand."""
        try:
            return self.at_cover(3.0)[0]
        except Missing:
            return self.covers()[0]

    def soils(self) -> list[Tunnel]:
        """Tunnels in different soils at the cover that most soils have in common."""
        covers = [t.cover_ratio for t in self.tunnels]

        def beside(cover: float) -> list[Tunnel]:
            return [t for t in self.tunnels if abs(t.cover_ratio - cover) < SAME_COVER and t.soil in NAMES]

        best = max(covers, key=lambda c: (len(beside(c)), abs(c - 3.0) < SAME_COVER))
        if not beside(best):
            raise Missing("there is no tunnel in one of the paper's soils")
        return beside(best)

    def soil(self, name: str) -> Tunnel:
        """The tunnel in a soil, of those of `soils`."""
        for tunnel in self.soils():
            if tunnel.soil == name:
                return tunnel
        raise Missing(f"there is no tunnel in {name} ({NAMES[name]}) at the cover of the other soils")


def open_study(folders: Sequence[Path], settings: Settings | None = None) -> Study:
    """The tunnels of a sweep's folder, or of runs and ensembles named one by one. Whatever cannot be read or is no
    tunnel at its volume loss is left out, and the reason is kept."""
    tunnels: list[Tunnel] = []
    left_out: list[Missing] = []
    for folder in folders:
        try:
            places = _points(folder)
        except Missing as reason:
            left_out.append(reason)
            continue
        tunnels += [tunnel for place in places if (tunnel := _read(place, settings, left_out))]
    return Study(tunnels, left_out)


def _read(place: Path, settings: Settings | None, left_out: list[Missing]) -> Tunnel | None:
    """The tunnel of one run or ensemble; nothing where none of its members can be read."""
    members = []
    for run in _members(place, left_out):
        try:
            members.append(_tunnel(Result(run, settings)))
        except Missing as reason:
            left_out.append(_naming(run, reason))
    members = equally_far(members, left_out)
    return Tunnel(place.resolve().name, members) if members else None


def _naming(folder: Path, reason: Missing) -> Missing:
    return reason if str(folder) in str(reason) else type(reason)(f"{folder}: {reason}")


def _subfolders(folder: Path) -> list[Path]:
    try:
        return sorted(path for path in folder.iterdir() if path.is_dir())
    except FileNotFoundError as error:
        raise Unreadable(f"{folder} does not exist") from error
    except OSError as error:
        raise Unreadable(f"{folder} cannot be read: {error.strerror}") from error


def _points(folder: Path) -> list[Path]:
    """Folders of runs and ensembles: the folder itself, or those below it (POINT, or GRID/POINT) whose runs are
    tunnels."""
    below = _subfolders(folder)
    if _is_point(folder):
        return [folder]
    found = []
    for path in below:
        found += [path] if _is_point(path) else [deeper for deeper in _subfolders(path) if _is_point(deeper)]
    found = [path for path in found if _kind(path) == "tunnel"]
    if not found:
        raise Unreadable(f"{folder} holds no tunnel: neither a run nor an ensemble nor a sweep of such runs")
    return found


def _is_point(folder: Path) -> bool:
    return any((folder / name).exists() for name in ("run.h5", INDEX, "member_000", "member_001"))


def _kind(point: Path) -> str:
    """The kind of a point's runs; "tunnel" where no run can be read, so that the reason is told."""
    for run in [point, *sorted(point.glob("member_*"))]:
        if (run / "run.h5").exists():
            try:
                return kind_of(run)
            except Missing:
                return "tunnel"
    return ""


def _members(point: Path, left_out: list[Missing]) -> list[Path]:
    """The runs of a point: of an ensemble those over which it is reduced; without ensemble.h5 all that were begun."""
    if (point / "run.h5").exists():
        return [point]
    index = point / INDEX
    if index.exists():
        try:
            with reading(index) as file:
                rows = zip(file["members/name"][()], file["members/reduced"][()])
                return [point / str(plain(name)) for name, reduced in rows if reduced]
        except Missing as reason:
            left_out.append(reason)
    return [path for path in sorted(point.glob("member_*")) if (path / "run.h5").exists()]


def _tunnel(result: Result) -> Result:
    """The run itself; raises Missing where it is no tunnel, or not at its volume loss yet."""
    result.need("diameter", "axis_depth", "surface_y")
    _ = result.start
    return result


def equally_far(members: Iterable[Result], left_out: list[Missing]) -> list[Result]:
    """The members that reached the largest V_l that any of them reached: a mean must not mix them with shorter ones."""
    members = list(members)
    if not members:
        return []
    last = max(member.volume_loss[-1] for member in members)
    for member in members:
        if member.volume_loss[-1] < last - SAME_LOSS:
            reached = f"it has reached V_l = {percent(member.volume_loss[-1])}, other members {percent(last)}"
            left_out.append(Missing(f"{member.folder}: {reached}"))
    return [member for member in members if member.volume_loss[-1] >= last - SAME_LOSS]
