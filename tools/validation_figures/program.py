"""Runs of the program whose output is drawn."""

from collections.abc import Callable
from pathlib import Path

import voussoir

ROOT = Path(__file__).resolve().parent.parent.parent


class Program:
    """The program and the folder that holds its runs."""

    def __init__(self, path: Path, folder: Path) -> None:
        self.path, self.folder = path.resolve(), folder.resolve()

    def run(self, name: str, case: Path, *settings: str) -> Path:
        """The folder of a run of this case; the program is not called again where the run has finished. Raises
        voussoir.Error where it does not end well."""
        return self._once(
            name, lambda folder: voussoir.run(case, folder, settings=settings, replace=True, program=self.path)
        )

    def ensemble(self, name: str, case: Path, members: int, *settings: str) -> Path:
        """The folder of an ensemble of this case, as of `run`; an interrupted one goes on, one member at a time."""
        return self._once(
            name,
            lambda folder: voussoir.ensemble(
                case, folder, members=members, jobs=1, settings=settings, resume=True, program=self.path
            ),
        )

    def _once(self, name: str, compute: Callable[[Path], object]) -> Path:
        folder, done = self.folder / name, self.folder / f"{name}.done"
        if not done.exists():
            self.folder.mkdir(parents=True, exist_ok=True)
            compute(folder)
            done.touch()
        return folder
