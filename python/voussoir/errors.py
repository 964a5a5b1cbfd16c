"""The exceptions of the package; every one of them is a voussoir.Error, but for the end by Ctrl-C, which is a
KeyboardInterrupt as everywhere in Python.

| exception | what happened |
|---|---|
| InputError | a value that the user wrote is wrong: a case file, a key, a setting (exit status 2 of the program) |
| NoEquilibrium | an increment, a packing or a test came to no equilibrium (exit status 3) |
| MachineFailure | the machine failed: disk, memory, a file that vanished (exit status 4) |
| Interrupted | a signal other than Ctrl-C stopped a run after an increment (exit status 130) |
| Missing | results lack the data that were asked for |
| Unreadable | a file or a folder of results cannot be read: damaged, of another program, not there |

The compiled module raises them as well.
"""

import re
from collections.abc import Iterable
from pathlib import Path

_FILE = re.compile(r"(?P<place>(?P<file>\S.*?\.\w+)(?::(?P<line>\d+))?): (?:(?P<key>[A-Za-z_][\w.\[\]-]*): )?")
_SET = re.compile(r"(?P<place>--set) (?P<key>[^\s:]+): ")


class Error(RuntimeError):
    """What all exceptions of Voussoir have in common.

    folder, lines: of a run that ended so, the folder of its results, which opens as far as it was written, and the last
    lines that the program printed.
    """

    folder: Path | None = None
    lines: tuple[str, ...] = ()


class InputError(Error, ValueError):
    """A mistake of the user. The message is the program's line, such as "case.toml:12: soil.friction: must be at
    least 0 deg, is -3 deg".

    place: "FILE:LINE", "FILE", "settings:2" for the second entry of a dictionary of settings, "--set" for an override
    of the program, the name of an argument, such as "grains", or ""; file: the place without its line, or None; line:
    the line, or the number of the setting, or None; key: the key, such as "soil.friction", or ""; sentence: what is
    wrong, without place and key. What is not given is read from the message.
    """

    def __init__(
        self, message: str, place: str | None = None, key: str | None = None, sentence: str | None = None
    ) -> None:
        super().__init__(message)
        found = _SET.match(message) or _FILE.match(message)
        told = found.groupdict() if found else {}
        self.place = (told.get("place") or "") if place is None else place
        self.key = (told.get("key") or "") if key is None else key
        self.sentence = (message[found.end() :] if found else message) if sentence is None else sentence
        file, colon, line = self.place.rpartition(":")
        has_line = bool(colon) and line.isdigit()
        self.file = None if self.place.startswith("--") else (file if has_line else self.place) or None
        self.line = int(line) if has_line else None

    def __reduce__(self) -> tuple[type, tuple[str, ...], dict[str, object]]:
        return type(self), (str(self), self.place, self.key, self.sentence), self.__dict__


class NoEquilibrium(Error):
    """An increment, a packing or a test came to no equilibrium; the message has the program's last sentences."""


class MachineFailure(Error):
    """The machine failed (disk, memory, a file that vanished), or the program has an error within."""


class Interrupted(Error):
    """A signal stopped the run after an increment; it goes on with resume=True."""


class Missing(Error):
    """The result lacks data that were asked for; the message names these data, and a traceback those that there are."""

    def __init__(self, message: str = "", there_are: Iterable[str] = ()) -> None:
        super().__init__(message)
        if known := ", ".join(there_are):
            self.add_note(f"There are: {known}")


class Unreadable(Missing):
    """A file of the results cannot be read; the message names it and the reason."""


class PackingWarning(UserWarning):
    """A packing was left out, or a setting of packings is not used."""
