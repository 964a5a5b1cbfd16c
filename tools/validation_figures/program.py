"""Runs of the program whose output is drawn."""

import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent


class ProgramFailed(Exception):
    """The program is missing or ended with an error; the message names the run."""


class Program:
    """The program and the folder that holds its runs."""

    def __init__(self, path: Path, folder: Path) -> None:
        self.path, self.folder = path.resolve(), folder.resolve()

    def run(self, name: str, case: Path, *settings: str) -> Path:
        """The folder of a run of this case; the program is not called again where the run has finished."""
        return self._call(name, ["run", str(case), "--replace"], settings)

    def ensemble(self, name: str, case: Path, members: int, *settings: str) -> Path:
        """The folder of an ensemble of this case, as of `run`; an interrupted one goes on, one member at a time."""
        return self._call(name, ["ensemble", str(case), "-n", str(members), "-j", "1", "--resume"], settings)

    def _call(self, name: str, command: list[str], settings: tuple[str, ...]) -> Path:
        folder, log = self.folder / name, self.folder / f"{name}.log"
        done = self.folder / f"{name}.done"
        if done.exists():
            return folder
        self.folder.mkdir(parents=True, exist_ok=True)
        words = [str(self.path), *command, "-o", str(folder)]
        words += [word for setting in settings for word in ("--set", setting)]
        try:
            with log.open("w") as lines:
                status = subprocess.run(words, stdout=lines, stderr=lines, check=False).returncode
        except OSError as error:
            raise ProgramFailed(f"{self.path} cannot be started: {error.strerror}") from error
        if status != 0:
            raise ProgramFailed(f"{' '.join(words)} ended with exit status {status}; see {log}")
        done.touch()
        return folder
