"""Quantities as the case files write them, such as "3 GPa" or "39.1 deg"."""

import re
from typing import Any

# Factors to SI units; angles become radians, as in the files of results.
FACTORS = {
    "": 1.0,
    "-": 1.0,
    "%": 0.01,
    "deg": 0.017453292519943295,
    "rad": 1.0,
    "Pa": 1.0,
    "kPa": 1e3,
    "MPa": 1e6,
    "GPa": 1e9,
    "mm": 1e-3,
    "cm": 1e-2,
    "m": 1.0,
    "km": 1e3,
}


def quantity(written: Any) -> float:
    """ "3 GPa" -> 3e9; a number stays as it is. Raises ValueError where this is no number or its unit is not known."""
    if isinstance(written, int | float):
        return float(written)
    found = re.fullmatch(r"\s*([-+.\deE]+)\s*(\D*?)\s*", str(written))
    if not found or found[2] not in FACTORS:
        raise ValueError(f'"{written}" is no quantity with a unit that is known here')
    return float(found[1]) * FACTORS[found[2]]
