"""Voussoir in Python: grains as a material law, runs of the program and their results, figures and reports.

Names are loaded when they are first used, so that `import voussoir` takes no time, and so that results can be read
where the compiled module is missing. docs/tutorial/grains_in_a_notebook.md shows what the package is for.
"""

import importlib
from typing import Any

__version__ = "0.2.0"

_MODULES = {
    "engine": ("initialize", "threads"),
    "packings": ("Packing", "load_packing", "make_packings"),
    "batch": ("RveBatch",),
    "answers": ("Answer", "Snapshot", "report_dtype", "status_names"),
    "runs": ("ensemble", "run", "sweep"),
    "opening": ("open_ensemble", "open_result", "open_sweep"),
    "results": ("Result",),
    "increments": ("Increment",),
    "ensembles": ("Bands", "Ensemble"),
    "sweeps": ("Run", "Sweep"),
    "files": ("Table",),
    "packing_files": ("PackingFile",),
    "shown": ("Shown",),
    "pictures": ("Picture",),
    "errors": (
        "Error",
        "InputError",
        "Interrupted",
        "MachineFailure",
        "Missing",
        "NoEquilibrium",
        "PackingWarning",
        "Unreadable",
    ),
}
_SUBMODULES = ("figures", "paths", "precice", "report")
_PLACES = {name: module for module, names in _MODULES.items() for name in names}

__all__ = ["__version__", *sorted(_PLACES)]  # noqa: PLE0604 - the names are texts


def __getattr__(name: str) -> Any:
    if name in _SUBMODULES:
        return importlib.import_module(f"{__name__}.{name}")
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(f"{__name__}.{_PLACES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_PLACES, *_SUBMODULES})
