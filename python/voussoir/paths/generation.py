"""Strain paths on packings, to one file: generate()."""

import datetime
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import card, engine, storage
from .block import Block
from .control import StressControl
from .dataset import Dataset
from .job import Job, consolidated, make_work
from .parts import Parts
from .progress import Progress
from .rows import Split, make_rows
from .schedule import Paths, as_paths

Array = np.ndarray


def generate(
    file: str | Path,
    paths: Paths | Array | Mapping[str, Paths | Array],
    packings: Any,
    *,
    packing_of: str | ArrayLike = "turn",
    mirrored: bool | ArrayLike = False,
    pressure: ArrayLike | None = None,
    preset: str = "standard",
    accuracy: float | str | None = None,
    precision: str | None = None,
    tangent: str | None = "elastic",
    backend: str = "lanes",
    settings: Mapping[str, Any] | None = None,
    fields: Sequence[str] | None = None,
    packing_split: Split = (0.75, 0.125, 0.125),
    path_split: Split = (0.75, 0.125, 0.125),
    control: StressControl | None = None,
    note: str = "",
    resume: bool = True,
    overwrite: bool = False,
    points_at_once: int = 8192,
    checkpoint_every: float = 60.0,
    reference_rows: int | None = None,
    progress: bool | Callable[[int, int], None] = False,
) -> Dataset:
    """Lets packings of grains take strain paths, and writes what they answer to an HDF5 file, with a card beside it.

    The work can be stopped at any moment, also by `kill -9`: the same call goes on from the last checkpoint and gives
    the same bits. A row whose grains fail (crushed, or not finite) keeps its points up to then; the failing point has
    the engine's status, later ones -1, and the values of both are NaN.

    Args:
        file: of the set, such as "set.h5"; the card is "set.md"
        paths: Paths, displacement gradients F - I (n, increments, 2, 2), or a dictionary {family: either of them}
        packings: a Packing, the path of its file, or several
        packing_of: "turn" (path i on packing i modulo their number), "all" (every path on every packing; the scatter
            between packings is then in the set), or (n,) indices. A path on a packing is a row.
        mirrored: rows whose grains answer as their mirror image x -> -x: all, or (rows,)
        pressure: isotropic, to which grains are brought before point 0 [Pa]: one, or (n,); None: that of the packing
        preset, accuracy, precision, tangent, backend, settings: as in voussoir.RveBatch; tangent=None: no tangents
        fields: names of voussoir.paths.FIELDS; None: the usual ones
        packing_split, path_split: shares of training, validation and test, or {"test": indices, ...}
        control: how held stresses are found
        note: a sentence for the card
        resume: whether to go on where an earlier call was stopped; False begins anew
        overwrite: whether a file of this name is replaced
        points_at_once: rows of one batch; memory grows with it
        checkpoint_every: time between checkpoints [s]
        reference_rows: so many rows are run again with the preset "reference", and the card tells the difference;
            None: one of 256, at most 16
        progress: True prints lines; a function is called with the row increments that are done and their total

    Raises:
        ValueError: an argument makes no sense
        FileExistsError: `file` is another dataset, or beside it lies the beginning of another one
        RuntimeError: another process makes this dataset
    """
    all_paths, grains = as_paths(paths), engine.packings_from(packings)
    rows = make_rows(len(all_paths), len(grains), packing_of, mirrored, (packing_split, path_split))
    how = engine.Engine(preset, accuracy, precision, tangent, backend, settings)
    holds = bool(all_paths.held.any()) or pressure is not None
    work = make_work(how, grains, fields, holds, control or StressControl(), checkpoint_every)
    work, pressures = consolidated(work, rows, pressure)
    job = Job(Path(file), all_paths, rows, pressures, work, points_at_once)
    if job.file.exists() and not overwrite:
        return _known(job)
    parts = Parts(job.file, job.plan(), resume)
    try:
        _run(job, parts, progress)
        _finish(job, parts, note, min(16, len(rows) // 256) if reference_rows is None else reference_rows)
    except BaseException:
        parts.leave()
        raise
    parts.discard()
    return Dataset(job.file)


def _run(job: Job, parts: Parts, progress: bool | Callable[[int, int], None]) -> None:
    """Computes the parts that are missing."""
    blocks = [rows for _, rows in job.blocks()]
    told, done = Progress(sum(len(rows.packing) * rows.increments for rows in blocks), progress), 0
    for rows in blocks:
        size = len(rows.packing)
        if not rows.is_done(parts):
            block = Block(job.work, rows, parts)
            told.begin(done + size * block.point)
            block.advance(lambda point, before=done, size=size: told(before + size * point))  # type: ignore[misc]
        done += size * rows.increments
        told.begin(done)


def _finish(job: Job, parts: Parts, note: str, reference_rows: int) -> None:
    """Puts the file together under another name, measures its errors and gives it its name."""
    made = job.file.with_name(job.file.name + ".new")
    about = {"note": note, "made": f"{datetime.datetime.now(datetime.UTC):%Y-%m-%d}"}
    blocks = [index for index, _ in job.blocks()]
    contents = storage.Contents(job.plan(), about, job.paths, job.rows, job.pressure, blocks)
    storage.assemble(made, contents, job.work, parts)
    card.finish(made, job.file, job.work.packings, job.work.engine, reference_rows)


def _known(job: Job) -> Dataset:
    """A dataset that is there already, if this call would give the same one."""
    data = Dataset(job.file)
    if data.plan == job.plan():
        return data
    data.close()
    raise FileExistsError(f"{job.file} is another dataset; overwrite=True replaces it")
