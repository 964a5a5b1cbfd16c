"""Draws figures one after another so that none loses the others, and tells in one line what became of each.

| exit status | what happened |
|---|---|
| 0 | each figure was drawn, or was skipped because the run has no data for it |
| 1 | the tool itself has a fault: the figure is missing, the others were drawn; `--traceback` shows the place in full |
| 2 | a run or a file of it cannot be read; what can be drawn without it was drawn |
| 4 | the machine failed (disk, memory) |
| 130 | Ctrl-C |
"""

import argparse
import sys
import traceback
import warnings
from collections.abc import Callable
from pathlib import Path

import matplotlib.pyplot as plt

from .output import CannotWrite, is_of_the_machine, say
from .result import Missing, Unreadable

DRAWN, FAULT, UNREADABLE, MACHINE, STOPPED = 0, 1, 2, 4, 130

PACKAGE = Path(__file__).resolve().parents[1]


def add_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--traceback", action="store_true", help="show in full where a fault of this tool arose")


class Guard:
    def __init__(self, tracebacks: bool = False) -> None:
        self.tracebacks = tracebacks
        self.status = DRAWN

    def make(self, name: str, path: Path, draw: Callable[[Path], None]) -> None:
        """Makes one file. An error of any kind but the machine's ends this file alone, and the status remembers it."""
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            warnings.simplefilter("ignore", DeprecationWarning)  # of libraries, among themselves
            try:
                draw(path)
            except Missing as reason:
                say(f"skipped {name}: {reason}")
                if isinstance(reason, Unreadable):
                    self.unreadable()
            except Exception as error:  # whatever it is, it must not lose the other figures
                if isinstance(error, OSError) and is_of_the_machine(error):
                    raise CannotWrite(f"{error.filename or path}: {error.strerror}") from error
                if is_of_the_machine(error):
                    raise
                self.fault(name, error)
            else:
                say(f"wrote {path}")
            finally:
                plt.close("all")
        for line in dict.fromkeys(f"{name}: a warning of {_place(w.filename, w.lineno)}: {w.message}" for w in warned):
            say(line, error=True)

    def unreadable(self) -> None:
        self.status = self.status or UNREADABLE

    def fault(self, name: str, error: Exception) -> None:
        self.status = FAULT
        say(f"FAULT in {name}: {describe(error)}; this is a fault of the tool, not of the run", error=True)
        if self.tracebacks:
            say("".join(traceback.format_exception(error)), error=True)


def describe(error: Exception) -> str:
    """The kind of an exception, its message in one line, and the innermost place of our own code on its way."""
    frames = traceback.extract_tb(error.__traceback__)
    ours = [frame for frame in frames if Path(frame.filename).is_relative_to(PACKAGE)] or list(frames)
    where = f" ({_place(ours[-1].filename, ours[-1].lineno)}, {ours[-1].name})" if ours else ""
    return f"{type(error).__name__}: {' '.join(str(error).split())}{where}"


def _place(file: str, line: int | None) -> str:
    path = Path(file)
    return f"{path.relative_to(PACKAGE.parent) if path.is_relative_to(PACKAGE) else path.name}:{line}"


def run(main: Callable[[], int]) -> int:
    """The exit status of a script: whatever stops it is told in one line."""
    try:
        return main()
    except Missing as reason:
        say(str(reason), error=True)
        return UNREADABLE
    except CannotWrite as reason:
        say(str(reason), error=True)
        return MACHINE
    except MemoryError:
        say("there is no memory left", error=True)
        return MACHINE
    except KeyboardInterrupt:
        say("stopped", error=True)
        return STOPPED
    except Exception as error:  # no figure script shows a traceback without being asked
        if isinstance(error, OSError) and is_of_the_machine(error):
            say(f"{error.filename or Path(sys.argv[0]).name}: {error.strerror}", error=True)
            return MACHINE
        guard = Guard("--traceback" in sys.argv)
        guard.fault(Path(sys.argv[0]).name, error)
        return guard.status
