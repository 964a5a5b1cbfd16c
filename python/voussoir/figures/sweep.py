"""A sweep as figures need it: its runs, of which there must be one."""

from pathlib import Path

from .. import sweeps
from ..errors import Missing, Unreadable
from ..sweeps import Member
from .settings import Settings


class Sweep(sweeps.Sweep):
    """The runs of a sweep that have a run.h5, with the places and volume losses that figures show."""

    def __init__(self, folder: Path | str, settings: Settings | None = None) -> None:
        self.settings = settings or Settings()
        super().__init__(folder)
        if not self.members:
            raise self.left_out[0] if self.left_out else Unreadable(f"{self.folder} has no run with a run.h5")

    def of_kind(self, kind: str) -> list[Member]:
        found = [member for member in self.members if member.kind == kind]
        if not found:
            raise Missing(f"{self.folder} has no run of kind {kind}")
        return found
