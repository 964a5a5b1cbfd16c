"""Arrays as short texts for the page; `blobs.js` is the way back.

Values become integers of 16 bits or fewer, the integers of an increment become differences from the increment before
(most points hardly change), the bytes are ordered by their weight, compressed by gzip and written in base64. Browsers
have gzip built in. A full-size tunnel, 81 increments of 3344 points, takes 0.1 to 0.4 MB a field.
"""

import base64
import gzip
from typing import Any

import numpy as np

Blob = dict[str, Any]

BITS = 16


def pack(values: np.ndarray, bits: int = BITS, scale: float = 0.0) -> Blob:
    """Packs values (frame, place), frame being an increment.

    With a scale s > 0 the integers count arsinh(x/s) instead of x, so that values from s up to very large ones have
    the same relative accuracy (stresses of 1 kPa and 1 MPa stand beside one another), and smaller ones an absolute one.
    A value that is not finite has a number of its own.
    """
    frames = np.asarray(values, dtype=float).reshape(len(values), -1)
    bent = np.arcsinh(frames / scale) if scale > 0 else frames
    finite = np.isfinite(bent)
    low, high = (float(bent[finite].min()), float(bent[finite].max())) if finite.any() else (0.0, 0.0)
    none = (1 << bits) - 1
    step = (high - low) / (none - 1) or 1.0
    codes = np.full(bent.shape, none, dtype=np.int64)
    codes[finite] = np.round((bent[finite] - low) / step).astype(np.int64)
    return {**_squeezed(codes), "low": low, "step": step, "scale": scale, "none": none}


def pack_numbers(values: np.ndarray) -> Blob:
    """Packs whole numbers from 0 to 65534, such as the nodes of elements, without any loss."""
    codes = np.asarray(values, dtype=np.int64).reshape(1, -1)
    if codes.size and not 0 <= codes.min() <= codes.max() < (1 << BITS) - 1:
        raise ValueError("whole numbers of the page go from 0 to 65534")
    return {**_squeezed(codes), "low": 0.0, "step": 1.0, "scale": 0.0, "none": (1 << BITS) - 1}


def _squeezed(codes: np.ndarray) -> Blob:
    """Differences in time, folded to positive numbers (0, -1, 1, -2, ... become 0, 1, 2, 3, ...), bytes by weight."""
    change = np.diff(codes, axis=0, prepend=0).astype(np.int16).astype(np.int32)
    folded = ((change << 1) ^ (change >> 31)) & 0xFFFF
    planes = (folded >> 8).astype(np.uint8).tobytes() + (folded & 0xFF).astype(np.uint8).tobytes()
    text = base64.b64encode(gzip.compress(planes, 9, mtime=0)).decode()
    return {"frames": len(codes), "count": codes.shape[1], "data": text}


def quantum(blob: Blob, value: float) -> float:
    """The largest error of a value that was packed so."""
    slope = float(np.hypot(blob["scale"], value)) if blob["scale"] > 0 else 1.0
    return 0.5 * float(blob["step"]) * slope * 1.001 + 1e-12 * abs(value)


def numbers(values: np.ndarray, digits: int = 5) -> list[float | None]:
    """A short list for JSON, where a value that is not finite is null."""
    return [float(f"{value:.{digits}g}") if np.isfinite(value) else None for value in np.asarray(values, dtype=float)]
