"""What the tests of the figures share: a script that is called in this process, and copies of a run to be damaged."""

import contextlib
import io
import shutil
import sys
from pathlib import Path
from unittest import mock

import matplotlib.pyplot as plt
from voussoir.figures import guard, style


def call(script, *words):
    """(exit status, lines of the standard output, lines of the standard error) of a script in this process. The
    pictures are small, since only their making counts."""

    def use_style():
        style.use_style()
        plt.rcParams.update({"savefig.dpi": 20, "savefig.bbox": None})

    out, err = io.StringIO(), io.StringIO()
    with (
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        mock.patch.object(sys, "argv", [f"{script.__name__}.py", *map(str, words)]),
        mock.patch.object(script, "use_style", use_style, create=True),
    ):
        status: int | str | None
        try:
            status = guard.run(script.main)
        except SystemExit as end:  # of argparse
            status = end.code
    return status, out.getvalue().splitlines(), err.getvalue().splitlines()


def copy(name, of="coarse"):
    """The folder runs/NAME, a copy of another one of the test's runs."""
    folder = Path("runs") / name
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(Path("runs") / of, folder)
    return folder
