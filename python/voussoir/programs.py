"""The program voussoir as a process of its own: where it is found, what it prints, how it ends."""

import codecs
import os
import pty
import select
import shutil
import signal
import subprocess
import tempfile
import time
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from .errors import Error, InputError, Interrupted, MachineFailure, NoEquilibrium

MOST_LINES = 40  # that an exception carries
LOOK = 0.1  # s between two looks at a process that prints nothing


def find_program(program: Path | str | None = None) -> Path:
    """The program: the argument, $VOUSSOIR, the one on the PATH, or that of the checkout or the installation that this
    package stands in. Raises voussoir.Error where there is none."""
    for given in (program, os.environ.get("VOUSSOIR")):
        if given:
            found = shutil.which(str(given))
            if not found:
                raise Error(f"{given} is no program that can be run")
            return Path(found).absolute()
    package = Path(__file__).resolve().parent
    built = [root / "host" / "voussoir" for root in (package.parents[1], package.parents[1] / "build" / "openmp")]
    built += sorted(package.parents[1].glob("build/*/host/voussoir"))
    built.append(package.parents[3] / "bin" / "voussoir")  # of an installation, share/voussoir/python
    found = shutil.which("voussoir") or next((str(path) for path in built if os.access(path, os.X_OK)), None)
    if not found:
        raise Error(
            "the program voussoir is not found: name it by program=..., by the variable VOUSSOIR or on the PATH "
            "(docs/how-to/install.md)"
        )
    return Path(found).absolute()


@dataclass
class Ended:
    """How the program ended: its exit status (-9 where SIGKILL ended it), its last lines, and its line on standard
    error without "voussoir: "."""

    status: int
    lines: tuple[str, ...]
    sentence: str

    def error(self, folder: Path) -> Error:
        """The exception of the exit status (docs/reference/exit_status.md)."""
        last = self.sentence or (self.lines[-1] if self.lines else "it printed nothing")
        made: Error
        if self.status == 2:
            made = InputError(last)
        elif self.status == 3:
            made = NoEquilibrium(f"{last}; results up to there: {folder}")
        elif self.status == 130:
            made = Interrupted(f"a signal stopped the run in {folder} after an increment; resume=True goes on")
        elif self.status < 0:
            name = signal.Signals(-self.status).name
            made = MachineFailure(f"{name} ended the program; resume=True goes on from the last checkpoint in {folder}")
        else:
            made = MachineFailure(last)
        made.folder, made.lines = folder, self.lines
        return made


@dataclass
class Process:
    """The program while it runs, in a session of its own: Ctrl-C reaches it once, by `stop`.

    It writes to a terminal that only this process reads, since it buffers its lines where it writes to a pipe, and
    shows each iterate only in a terminal.
    """

    words: Sequence[str]
    lines: deque[str] = field(default_factory=lambda: deque(maxlen=MOST_LINES))

    def __post_init__(self) -> None:
        self._terminal, theirs = pty.openpty()
        self._decoder = codecs.getincrementaldecoder("utf-8")("replace")
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 - closed by `end`
        try:
            self._process = subprocess.Popen(
                self.words, stdin=subprocess.DEVNULL, stdout=theirs, stderr=self._errors, start_new_session=True
            )
        except OSError as error:
            os.close(self._terminal)
            self._errors.close()
            raise MachineFailure(f"{self.words[0]} cannot be started: {error.strerror}") from error
        finally:
            os.close(theirs)

    def stop(self) -> None:
        """What Ctrl-C does in a terminal: the program ends after its increment; a second time it ends at once."""
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)

    def said(self) -> Iterator[tuple[str, bool]]:
        """Lines as they come until the program ends, and whether each is whole; a line that is not stands in a terminal
        until the next one replaces it. An empty line comes where nothing was printed for a while."""
        rest = ""
        while True:
            ended = self._process.poll() is not None
            text = self._read()
            if not text and ended:
                return
            *whole, rest = (rest + text).replace("\r\n", "\n").split("\n")
            for line in whole:
                shown = line.rpartition("\r")[2].strip()
                if shown:
                    self.lines.append(shown)
                yield shown, True
            rest = rest.rpartition("\r")[2]
            yield rest.strip(), False

    def _read(self) -> str:
        ready, _, _ = select.select([self._terminal], [], [], LOOK)
        if not ready:
            return ""
        try:
            return self._decoder.decode(os.read(self._terminal, 65536))
        except OSError:  # the program has closed its end
            time.sleep(LOOK / 10)
            return ""

    def end(self) -> Ended:
        """Waits for the end and gives the terminal back."""
        for _ in self.said():  # else the program may wait for its lines to be read
            pass
        status = self._process.wait()
        os.close(self._terminal)
        with self._errors as errors:
            errors.seek(0)
            told = errors.read().decode(errors="replace").strip().splitlines()
        sentence = told[-1].removeprefix("voussoir: ") if told else ""
        return Ended(status, tuple(self.lines), sentence)
