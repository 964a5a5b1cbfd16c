"""Datasets from a shell: python -m voussoir.paths make | card | export."""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from . import Paths, biaxial, cyclic, drained, generate, open_dataset, random, rotating, stratified, undrained
from .rows import PARTS

Array = np.ndarray
KPA = 1e3

# Families as the shell knows them, of n paths: directions and amplitudes fill their ranges evenly.
FAMILIES: dict[str, Callable[[int, int, int], Array | Paths]] = {
    "random": lambda n, increments, seed: random(n, increments, seed=seed),
    "stratified": lambda n, increments, seed: stratified(n, increments, seed=seed),
    "undrained": lambda n, increments, _: undrained(increments, 0.02, _angles(n)),
    "biaxial": lambda n, increments, _: biaxial(increments, -0.02, np.linspace(0.0, 0.02, n)),
    "cyclic": lambda n, increments, _: cyclic(increments, np.geomspace(5e-4, 5e-3, n), 2, _angles(n)),
    "rotating": lambda n, increments, _: rotating(increments, np.geomspace(5e-4, 5e-3, n), 1.0, _angles(n)),
    "drained": lambda n, increments, _: drained(increments, np.linspace(-0.03, -0.01, n)),
}


def main(words: list[str] | None = None) -> int:
    arguments = _parser().parse_args(words)
    try:
        arguments.call(arguments)
    except (OSError, RuntimeError, ValueError) as error:
        print(f"voussoir.paths: {error}", file=sys.stderr)
        return 1
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m voussoir.paths", description=__doc__)
    calls = parser.add_subparsers(required=True)
    make = calls.add_parser("make", help="make a dataset, or go on with one that was stopped")
    make.set_defaults(call=_make)
    make.add_argument("file", type=Path)
    make.add_argument("paths", nargs="+", metavar="FAMILY:N", help=f"families: {', '.join(FAMILIES)}")
    make.add_argument("--increments", type=int, default=50)
    make.add_argument("--packings", type=int, default=8, help="number of packings (seeds 1, 2, ...)")
    make.add_argument("--grains", type=int, default=300)
    make.add_argument("--pressure", type=float, nargs="+", metavar="KPA", help="one, or the ends of a range [kPa]")
    make.add_argument("--every-packing", action="store_true", help="each path on every packing")
    make.add_argument("--folder", type=Path, help="where packings are kept")
    make.add_argument("--preset", default="standard")
    make.add_argument("--tangent", default="elastic", help="kind of tangent, or none")
    make.add_argument("--seed", type=int, default=0)
    make.add_argument("--overwrite", action="store_true")
    card = calls.add_parser("card", help="print the data card")
    card.set_defaults(call=lambda given: print(open_dataset(given.file).card))
    card.add_argument("file", type=Path)
    export = calls.add_parser("export", help="write rows to a NumPy file")
    export.set_defaults(call=_export)
    export.add_argument("file", type=Path)
    export.add_argument("npz", type=Path)
    export.add_argument("--packing", choices=PARTS)
    export.add_argument("--path", choices=PARTS)
    return parser


def _make(given: argparse.Namespace) -> None:
    from voussoir import make_packings

    sets = {}
    for word in given.paths:
        family, _, count = word.partition(":")
        if family not in FAMILIES or not count.isdecimal() or int(count) < 1:
            raise ValueError(f"'{word}' is not FAMILY:N, with a family of {', '.join(FAMILIES)}")
        sets[family] = FAMILIES[family](int(count), given.increments, given.seed)
    packings = make_packings(given.packings, grains=given.grains, folder=given.folder)
    more: dict[str, Any] = {"pressure": _pressure(given, sum(len(one) for one in sets.values()))}
    data = generate(
        given.file,
        sets,
        packings,
        packing_of="all" if given.every_packing else "turn",
        preset=given.preset,
        tangent=None if given.tangent == "none" else given.tangent,
        overwrite=given.overwrite,
        progress=True,
        **more,
    )
    print(data)


def _pressure(given: argparse.Namespace, paths: int) -> Array | None:
    """Pressures of the paths [Pa]: their logarithms are drawn evenly from the range."""
    if given.pressure is None:
        return None
    low, high = min(given.pressure), max(given.pressure)
    if len(given.pressure) > 2 or low <= 0:
        raise ValueError("--pressure takes one or two positive numbers [kPa]")
    drawn = np.random.default_rng(given.seed).uniform(np.log(low), np.log(high), paths)
    return KPA * np.exp(drawn)


def _export(given: argparse.Namespace) -> None:
    with open_dataset(given.file) as data:
        data.export_npz(given.npz, data.rows(packing=given.packing, path=given.path))


def _angles(n: int) -> Array:
    return np.pi * np.arange(n) / n


sys.exit(main())
