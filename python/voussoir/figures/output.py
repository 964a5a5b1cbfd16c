"""Files and lines that the figure scripts leave behind."""

import contextlib
import os
import sys
from pathlib import Path


class CannotWrite(Exception):
    """A file or a line cannot be written; the message names it and the reason."""


def is_of_the_machine(error: BaseException) -> bool:
    """True for what the system refuses, as a disk that is full or may not be written. An OSError without a number is
    a library's own, as HDF5's about the content of a file."""
    return isinstance(error, MemoryError | CannotWrite) or (isinstance(error, OSError) and error.errno is not None)


def write(path: Path, content: bytes | str) -> None:
    """Writes a whole file or nothing: a figure of an earlier call stays as it is when the new one cannot be written."""
    temporary = path.with_name(path.name + ".tmp")
    try:
        temporary.write_bytes(content.encode() if isinstance(content, str) else content)
        temporary.replace(path)
    except OSError as error:
        with contextlib.suppress(OSError):  # of a folder that may not be written
            temporary.unlink(missing_ok=True)
        raise CannotWrite(f"{path}: cannot be written: {error.strerror}") from error


def make_folder(path: Path) -> None:
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CannotWrite(f"{path}: the folder cannot be made: {error.strerror}") from error


def say(line: str, error: bool = False) -> None:
    """Writes a line to the standard output, or to the standard error. When its reader has gone (`| head -1`), the lines
    are dropped and the figures are drawn all the same."""
    stream = sys.stderr if error else sys.stdout
    try:
        print(line, file=stream, flush=True)
    except OSError as reason:
        # What is still in the buffer would fail once more at the end of the process.
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
        if not isinstance(reason, BrokenPipeError) and not error:
            raise CannotWrite(f"the standard output cannot be written: {reason.strerror}") from reason
