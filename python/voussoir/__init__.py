"""Voussoir in Python: runs and their results, figures and reports.

Names are loaded when they are first used, so that `import voussoir` takes no time and needs neither NumPy nor h5py.
"""

import importlib
from typing import Any

_MODULES = {
    "errors": ("Error", "InputError", "Interrupted", "MachineFailure", "Missing", "NoEquilibrium", "Unreadable"),
    "opening": ("open_ensemble", "open_result", "open_sweep"),
    "runs": ("ensemble", "run", "sweep"),
}
_PLACES = {name: module for module, names in _MODULES.items() for name in names}

__all__ = sorted(_PLACES)  # noqa: PLE0605


def __getattr__(name: str) -> Any:
    if name in ("figures", "report"):
        return importlib.import_module(f"{__name__}.{name}")
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_PLACES[name]}"), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *_PLACES])
