#!/usr/bin/env python3
"""Reads result.xdmf back with VTK's XDMF reader and prints every time step and field: tools/xdmf_check.py DIR_OR_FILE.

Exit status: 0 all fields can be read, 1 a field is missing or differs from the HDF5 file, 77 VTK is not installed
(skipped).
"""

import argparse
import sys
from pathlib import Path

import h5py
import numpy as np

SKIPPED = 77
VTK_QUADRATIC_QUAD = 23


def load_reader():
    try:
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
    except ImportError as reason:
        print(f"skipped: VTK's XDMF reader is not available ({reason}); pip install -r tools/requirements-test.txt")
        sys.exit(SKIPPED)
    return vtkXdmfReader, vtk_to_numpy


def first_grid(data):
    """The unstructured grid of the reader's result, which may wrap the grid in blocks."""
    while data is not None and hasattr(data, "GetNumberOfBlocks"):
        data = data.GetBlock(0)
    return data


def expected_fields(path):
    """Names and values below /xdmf of an increment's file."""
    with h5py.File(path, "r") as file:
        return (
            {
                place: {name: set_[()] for name, set_ in file["xdmf"].get(place, {}).items()}
                for place in ("node", "cell")
            }
            if "xdmf" in file
            else {"node": {}, "cell": {}}
        )


def expected_mesh(run_file, increment_file):
    """Coordinates at an increment and connectivity."""
    with h5py.File(run_file, "r") as run, h5py.File(increment_file, "r") as increment:
        moved = increment if "mesh/coordinates" in increment else run
        return moved["mesh/coordinates"][()], run["mesh/connectivity"][()]


def check_mesh(grid, mesh, to_numpy):
    coordinates, connectivity = mesh
    wrong = []
    if not np.allclose(to_numpy(grid.GetPoints().GetData())[:, :2], coordinates, rtol=1e-6):  # VTK keeps float32
        wrong.append("the points differ from the HDF5 file")
    if not np.array_equal(to_numpy(grid.GetCells().GetConnectivityArray()), connectivity.ravel()):
        wrong.append("the connectivity differs from the HDF5 file")
    return wrong


def check_step(grid, expected, to_numpy):
    """Prints the fields of one time step; returns a list of what is wrong."""
    wrong = []
    if grid.GetNumberOfCells() == 0 or grid.GetCellType(0) != VTK_QUADRATIC_QUAD:
        wrong.append("cells are not 8-node quadrilaterals")
    for place, data in (("node", grid.GetPointData()), ("cell", grid.GetCellData())):
        for name, values in expected[place].items():
            array = data.GetArray(name)
            if array is None:
                wrong.append(f"{place} field {name} is missing")
                continue
            read = to_numpy(array)
            print(f"    {place} {name}: {read.shape}, {read.min():.6g} to {read.max():.6g}")
            if read.shape != values.shape or not np.array_equal(read, values, equal_nan=True):
                wrong.append(f"{place} field {name} differs from the HDF5 file")
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("result", type=Path)
    path = parser.parse_args().result
    path = path / "result.xdmf" if path.is_dir() else path
    reader_type, to_numpy = load_reader()
    reader = reader_type()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    information = reader.GetOutputInformation(0)
    key = reader.GetExecutive().TIME_STEPS()
    times = [information.Get(key, k) for k in range(information.Length(key))] if information.Has(key) else []
    files = sorted((path.parent / "increments").glob("*.h5"), key=lambda p: int(p.stem))
    wrong = (
        []
        if [int(t) for t in times] == [int(p.stem) for p in files]
        else [f"times {times} for increments {[p.stem for p in files]}"]
    )
    for time, file in zip(times, files):
        reader.UpdateTimeStep(time)
        grid = first_grid(reader.GetOutputDataObject(0))
        print(f"  time {time:g}: {grid.GetNumberOfPoints()} points, {grid.GetNumberOfCells()} cells")
        found = check_mesh(grid, expected_mesh(path.parent / "run.h5", file), to_numpy)
        found += check_step(grid, expected_fields(file), to_numpy)
        wrong += [f"time {time:g}: {problem}" for problem in found]
    for problem in wrong:
        print(f"{path}: {problem}", file=sys.stderr)
    print(f"{path}: {len(times)} times, {'all fields agree' if not wrong else f'{len(wrong)} problems'}")
    return 1 if wrong or not times else 0


if __name__ == "__main__":
    sys.exit(main())
