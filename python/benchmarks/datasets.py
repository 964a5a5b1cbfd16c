"""What datasets of strain paths cost (docs/measurements/datasets.md).

    python3 datasets.py large FILE.h5 [SECONDS]
    python3 datasets.py every FILE.h5 [SECONDS]
    python3 datasets.py parts

"large" makes 4096 paths of 50 increments on 8 packings of 300 grains, dealt out in turn, with so many seconds between
checkpoints; it may be killed and called again. "every" lets every path run on every packing. "parts" shows what fields,
tangents, presets, checkpoints and held stresses cost.

Packings are kept in ./packings. Calls of a batch are counted and timed: number, wall time and processor time [s]."""

import functools
import resource
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import voussoir
from voussoir import paths

calls: dict[str, list[float]] = {}


def timed(name: str) -> None:
    """Notes what a method of batches takes."""
    method = getattr(voussoir.RveBatch, name)

    @functools.wraps(method)
    def call(*words: Any, **more: Any) -> Any:
        wall, processor = time.perf_counter(), time.process_time()
        try:
            return method(*words, **more)
        finally:
            spent = (1, time.perf_counter() - wall, time.process_time() - processor)
            calls[name] = [a + b for a, b in zip(calls.get(name, [0, 0, 0]), spent)]

    setattr(voussoir.RveBatch, name, call)


def make(file: str, label: str, kinds: Any, packings: Any, **more: Any) -> None:
    calls.clear()
    wall, processor = time.perf_counter(), time.process_time()
    data = paths.generate(file, kinds, packings, **more)
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    rows = len(data) * (data.points - 1)
    size, peak = Path(file).stat().st_size / 1e6, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    print(
        f"{label}: {rows} row increments, {wall:.1f} s, processor {processor:.1f} s, {size:.2f} MB, peak {peak:.0f} MB"
    )
    print("   ", {name: (int(one[0]), round(one[1], 2), round(one[2], 2)) for name, one in calls.items()}, flush=True)
    print(data.card.split("## Errors to expect")[1].strip() + "\n" if more.get("reference_rows") else "", end="")


def large(packings: Any, file: str, packing_of: str, seconds: float = 60.0) -> None:
    def angles(n: int) -> np.ndarray:
        return np.pi * np.arange(n) / n

    kinds = {
        "random": paths.random(2048, 50, seed=1),
        "stratified": paths.stratified(1024, 50, seed=1),
        "undrained": paths.undrained(50, 0.02, angles(256)),
        "cyclic": paths.cyclic(50, np.geomspace(5e-4, 5e-3, 512), 2, angles(512)),
        "rotating": paths.rotating(50, np.geomspace(5e-4, 5e-3, 256), 1.0, angles(256)),
    }
    more: dict[str, Any] = {"checkpoint_every": seconds, "reference_rows": 16, "progress": True}
    make(file, "4096 paths", kinds, packings, packing_of=packing_of, **more)


def parts(packings: Any) -> None:
    walks, cheap = paths.random(1024, 25, seed=1), ["tangent", "steps", "unbalanced", "void_ratio", "coordination"]
    variants: dict[str, dict[str, Any]] = {
        "usual fields": {},
        "without the fabric": {"fields": cheap},
        "without tangents": {"tangent": None},
        "stresses alone": {"tangent": None, "fields": []},
        "contact tangents": {"tangent": "contact"},
        "preset fast": {"preset": "fast"},
        "a checkpoint each increment": {"checkpoint_every": 0},
    }
    for label, more in variants.items():
        make("parts.h5", label, walks, packings, overwrite=True, reference_rows=0, **more)
    tests = paths.drained(50, -np.linspace(0.01, 0.05, 256))
    make("parts.h5", "drained", tests, packings, overwrite=True, reference_rows=0)


for method in ("evaluate", "commit", "fields", "state"):
    timed(method)
made = voussoir.make_packings(8, grains=300, folder="packings")
if sys.argv[1] == "parts":
    parts(made)
else:
    large(made, sys.argv[2], {"large": "turn", "every": "all"}[sys.argv[1]], *map(float, sys.argv[3:]))
