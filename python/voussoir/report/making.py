"""The page of what a folder holds."""

import warnings
from collections.abc import Sequence
from pathlib import Path

from voussoir.errors import Missing, Unreadable
from voussoir.figures.settings import Settings
from voussoir.figures.source import open_source

from . import ensemble_page, run_page, sweep_page
from .parts import Builder


def page_of(folder: Path, settings: Settings, only: Sequence[str] | None = None) -> Builder:
    """The parts of the page; `only`: these figures alone (empty: none). Raises Unreadable where the folder has no
    results that can be read."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of NumPy, about missing values; tools/figures.py tells them
        try:
            source = open_source([folder], settings)
        except Unreadable:
            raise
        except Missing as reason:  # as of a run whose first increment is still computed: it has a case and a provenance
            return run_page.of_a_beginning(folder, reason)
        chosen = None if only is None else list(only)
        if source.what == "a sweep":
            return sweep_page.make(source.data, folder, chosen)
        if source.what == "an ensemble":
            return ensemble_page.make(source.data, folder, chosen)
        return run_page.make(source, folder, chosen)
