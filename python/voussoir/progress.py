"""How far a run is: a line in a terminal, a bar in a notebook."""

import html
import importlib
import re
import shutil
import sys
from collections.abc import Callable
from typing import Any

STEP = re.compile(r"^(?P<stage>\S+) (?P<done>\d+)/(?P<of>\d+)\b")  # of the program's lines on increments
Told = Callable[[str], None]


class Silent:
    """Shows nothing."""

    def show(self, line: str, whole: bool) -> None:
        """Shows a line of the program; one that is not whole is replaced by the next."""

    def close(self) -> None:
        """The run has ended."""


class Called(Silent):
    """Hands each whole line to a function."""

    def __init__(self, told: Told) -> None:
        self.told = told

    def show(self, line: str, whole: bool) -> None:
        if whole and line:
            self.told(line)


class Terminal(Silent):
    """The present line, at the foot of a terminal; it is removed at the end."""

    def __init__(self) -> None:
        self.stream = sys.stderr

    def show(self, line: str, whole: bool) -> None:  # noqa: ARG002
        if line:
            self._write(line)

    def close(self) -> None:
        self._write("")

    def _write(self, line: str) -> None:
        width = shutil.get_terminal_size().columns - 1
        self.stream.write(f"\r{line[:width]:<{width}}\r")
        self.stream.flush()


class Notebook(Silent):
    """A bar of the increments of the stage, and the present line below it, in one output that is replaced."""

    def __init__(self, title: str) -> None:
        self.title, self.bar, self.last = title, "", ""
        display: Any = importlib.import_module("IPython.display")
        self.html = display.HTML
        self.output = display.display(self.html(self._text("")), display_id=True)

    def show(self, line: str, whole: bool) -> None:  # noqa: ARG002
        found = STEP.match(line)
        if found:
            self.bar = f'<progress value="{found["done"]}" max="{found["of"]}"></progress> {found["stage"]} '
        if line and line != self.last:
            self.last = line
            self.output.update(self.html(self._text(line)))

    def close(self) -> None:
        self.output.update(self.html(self._text(f"ended: {self.last}")))

    def _text(self, line: str) -> str:
        return f"<b>{html.escape(self.title)}</b> {self.bar}<br><small>{html.escape(line)}</small>"


def progress_of(wanted: bool | Told | None, title: str) -> Silent:
    """What shows the progress. None: a bar in a notebook, a line where standard error is a terminal, else nothing.
    True: a bar or a line; False: nothing; a function gets each line of the program."""
    if callable(wanted):
        return Called(wanted)
    if wanted is False:
        return Silent()
    if in_notebook():
        return Notebook(title)
    return Terminal() if wanted or sys.stderr.isatty() else Silent()


def in_notebook() -> bool:
    """True in a process whose output a notebook shows: IPython with a kernel."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    return shell is not None and hasattr(shell, "kernel")
