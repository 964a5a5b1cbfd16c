"""Voussoir: soil mechanics from grains, for Python.

The names of this package are loaded when they are first used, so that results can be read where the compiled module is
missing. python/README.md says what is where.
"""

import importlib
from typing import Any

__version__ = "0.2.0"

# name -> module of this package that has it
_places = {
    "Answer": "batch",
    "Error": "errors",
    "InputError": "errors",
    "NoEquilibrium": "errors",
    "Packing": "packings",
    "PackingWarning": "errors",
    "RveBatch": "batch",
    "Snapshot": "batch",
    "initialize": "engine",
    "load_packing": "packings",
    "make_packings": "packings",
    "report_dtype": "batch",
    "status_names": "batch",
    "threads": "engine",
}

__all__ = ["__version__", *sorted(_places)]  # noqa: PLE0604 - the names are texts


def __getattr__(name: str) -> Any:
    place = _places.get(name)
    if place is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(f"{__name__}.{place}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_places})
