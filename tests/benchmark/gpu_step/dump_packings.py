"""Writes packings of this program (packing_*.h5) as files that step_rates reads: N.packing for N grains.

usage: dump_packings.py FOLDER packing_*.h5
"""

import pathlib
import sys

import h5py
import numpy as np


def dump(packing: pathlib.Path, folder: pathlib.Path) -> None:
    """Number of grains and contacts, cell, positions, radii [m], histories [N, N m], keys i << 16 | j (ascending)."""
    with h5py.File(packing) as file:
        radius = file["radius"][:]
        position = np.column_stack([file["x"][:], file["y"][:]])
        key = file["contact_i"][:].astype(np.uint32) << 16 | file["contact_j"][:].astype(np.uint32)
        order = np.argsort(key)
        target = folder / f"{len(radius)}.packing"
        with target.open("wb") as out:
            np.array([len(radius), len(key)], np.int64).tofile(out)
            for part in (file["cell"][:], position, radius, file["history"][:][order]):
                part.astype(np.float64).tofile(out)
            key[order].tofile(out)
    print(f"{target}: {len(radius)} grains, {len(key)} contacts")


def main() -> None:
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name in sys.argv[2:]:
        dump(pathlib.Path(name), folder)


if __name__ == "__main__":
    main()
