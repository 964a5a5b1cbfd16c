"""The HDF5 file of a dataset: how it is put together from its parts."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from voussoir.answers import status_names

from .block import Work, part_name
from .fields import BY_NAME, Field
from .parts import Arrays, Parts
from .rows import PARTS, Rows
from .schedule import Paths
from .tensors import strain_of_gradient, totals

Array = np.ndarray
FORMAT = "voussoir paths 1"
ROWS_A_CHUNK = 64


@dataclass(frozen=True)
class Contents:
    """What goes into a file besides what the grains answered."""

    plan: dict[str, Any]
    about: dict[str, str]  # further attributes
    paths: Paths
    rows: Rows
    pressure: Array  # (rows,) [Pa]
    blocks: list[Array]  # indices of the rows of each block


def assemble(file: Path, contents: Contents, work: Work, parts: Parts) -> None:
    """Writes the file of a dataset whose parts are all there."""
    paths, rows = contents.paths, contents.rows
    points = paths.increments + 1
    with h5py.File(file, "w") as out:
        _describe(out, contents, work)
        _put_tables(out, contents, work)
        _create(out, "gradient", (len(rows), points - 1, 2, 2), "f8", "-", "F - I from point k to point k + 1")
        if work.consolidation:
            shape = (len(rows), work.consolidation, 2, 2)
            _create(out, "consolidation", shape, "f8", "-", "F - I of the increments that lead to point 0")
        for one in work.fields:
            tail = (len(one.components),) if one.components else ()
            data = _create(out, one.name, (len(rows), points, *tail), one.kind, one.unit, one.meaning)
            if one.components:
                data.attrs["components"] = list(one.components)
        for number, index in enumerate(contents.blocks):
            _put_block(out, index, _block(parts, number, points, work.fields))


def _describe(out: h5py.File, contents: Contents, work: Work) -> None:
    out.attrs["format"] = FORMAT
    out.attrs["plan"] = json.dumps(contents.plan)
    out.attrs["version"] = contents.plan["version"]
    out.attrs.update(contents.about)
    for name, value in work.engine.plan().items():
        out.attrs[name] = value if isinstance(value, str | float) else json.dumps(value)
    out.attrs["status_names"] = list(status_names)
    out.attrs["split_names"] = list(PARTS)


def _put_tables(out: h5py.File, contents: Contents, work: Work) -> None:
    """What is known of each row, packing and path."""
    paths, rows, pressure = contents.paths, contents.rows, contents.pressure
    for name, values, unit, meaning in (
        ("row/path", rows.path.astype("i4"), "-", "index into path/"),
        ("row/packing", rows.packing.astype("i4"), "-", "index into packing/"),
        ("row/mirrored", rows.mirrored, "-", "whether the grains answer as their mirror image x -> -x"),
        ("row/pressure", pressure, "Pa", "isotropic pressure wanted at point 0"),
        ("path/family", paths.family.astype(h5py.string_dtype()), "-", "kind of the path"),
        ("path/held", paths.held, "-", "which stresses (xx, yy, xy) keep their value of point 0"),
        ("path/split", rows.path_part, "-", "train 0, validation 1, test 2"),
        ("packing/split", rows.packing_part, "-", "train 0, validation 1, test 2"),
        ("packing/seed", np.array([_number(one, "seed") for one in work.packings], "i8"), "-", "seed; -1: not known"),
        ("packing/grains", np.array([len(one.radius) for one in work.packings], "i4"), "-", "number of grains"),
        ("packing/void_ratio", _column(work.packings, "void_ratio"), "-", "at rest under its pressure"),
        ("packing/pressure", _column(work.packings, "pressure"), "Pa", "isotropic pressure at which it was made"),
        ("packing/coordination", _column(work.packings, "coordination"), "-", "contacts of a grain, mean"),
        ("packing/thickness", _column(work.packings, "thickness"), "m", "out of plane"),
    ):
        data = out.create_dataset(name, data=values)
        data.attrs["unit"], data.attrs["meaning"] = unit, meaning
    soils = [json.dumps(getattr(one, "soil", None) or {}, default=str) for one in work.packings]
    out.create_dataset("packing/soil", data=np.array(soils, object), dtype=h5py.string_dtype())


def _block(parts: Parts, number: int, points: int, fields: Sequence[Field]) -> Arrays:
    """All points of a block (row, point, ...)."""
    found = [_part(parts, number, k) for k in range(points)]
    arrays = {one.name: np.stack([part[one.name] for part in found], axis=1) for one in fields if one.name != "strain"}
    arrays["gradient"] = np.stack([part["gradient"] for part in found[1:]], axis=1)
    if found[0]["consolidation"].shape[1]:
        arrays["consolidation"] = found[0]["consolidation"]
    strain = strain_of_gradient(totals(arrays["gradient"]))
    strain[~np.isfinite(arrays["stress"]).all(axis=-1)] = np.nan
    arrays["strain"] = strain.astype(BY_NAME["strain"].kind)
    return arrays


def _part(parts: Parts, number: int, point: int) -> Arrays:
    found = parts.load(part_name(number, point))
    if found is None:
        raise RuntimeError(f"{parts.folder} lost its part {part_name(number, point)}; resume=False begins anew")
    return found


def _put_block(out: h5py.File, index: Array, arrays: Arrays) -> None:
    for here, there in _runs(index):
        for name, values in arrays.items():
            out[name][there] = values[here]


def _runs(index: Array) -> Iterator[tuple[slice, slice]]:
    """Rows of a block that stand one behind the other in the file: where in the block, and where in the file."""
    cuts = np.flatnonzero(np.diff(index) != 1) + 1
    for piece in np.split(np.arange(len(index)), cuts):
        first = int(index[piece[0]])
        yield slice(int(piece[0]), int(piece[-1]) + 1), slice(first, first + len(piece))


def _create(out: h5py.File, name: str, shape: tuple[int, ...], kind: str, unit: str, meaning: str) -> h5py.Dataset:
    """A compressed dataset whose chunks hold whole paths, because they are read path by path."""
    chunk = (min(ROWS_A_CHUNK, shape[0]), *shape[1:])
    data = out.create_dataset(name, shape, kind, chunks=chunk, compression="gzip", compression_opts=4, shuffle=True)
    data.attrs["unit"], data.attrs["meaning"] = unit, meaning
    return data


def _number(packing: Any, name: str) -> float:
    value = getattr(packing, name, None)
    return -1 if value is None else value


def _column(packings: Sequence[Any], name: str) -> Array:
    return np.array([getattr(one, name, None) or np.nan for one in packings], float)
