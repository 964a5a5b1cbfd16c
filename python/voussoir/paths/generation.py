"""Strain paths on packings, to one file: generate()."""

import datetime
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import card, engine, storage
from .block import RATIO, Block, Rows, Work
from .control import StressControl
from .dataset import Dataset
from .fields import chosen, microstructure
from .parts import Parts, digest
from .progress import Progress
from .rows import Rows as TableRows
from .rows import Split, make_rows
from .schedule import Paths, as_paths

Array = np.ndarray
VERSION = 1  # of the parts


def generate(
    file: str | Path,
    paths: Paths | Array | Mapping[str, Paths | Array],
    packings: Any,
    *,
    packing_of: str | Array = "turn",
    mirrored: bool | Array = False,
    pressure: float | Array | None = None,
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
    """Lets packings of grains take strain paths and writes what they answer to an HDF5 file, with a data card beside
    it.

    - `paths`: Paths, an array of displacement gradients F - I (n, increments, 2, 2), or a dictionary {family: either}.
    - `packings`: a Packing, the path of one, or several. `packing_of`: "turn" (path i on packing i modulo their
      number), "all" (every path on every packing; the scatter between packings is then in the data), or an array (n,).
    - `mirrored`: rows whose grains answer as their mirror image x -> -x. `pressure`: isotropic pressure [Pa] to which
      the grains are brought before point 0, a number or one a path; None: that of the packing.
    - `preset` to `settings`: as in voussoir.RveBatch; tangent=None leaves tangents out. `fields`: names of
      voussoir.paths.FIELDS; None: the usual ones.
    - `packing_split`, `path_split`: shares of training, validation and test, or {"test": indices, ...}.
    - `control`: how stresses of drained paths are held. `reference_rows`: so many rows are run again with the preset
      "reference", and the card states the difference; None: one of 256, at most 16.
    - `points_at_once`: rows of one batch; memory grows with it. `note`: a sentence of yours for the card.
    - `progress`: True prints lines; a function is called with the numbers of row increments done and in total.

    The work can be stopped at any moment, also by `kill -9`: the same call goes on from the last checkpoint
    (`checkpoint_every` seconds) and gives the same bits. A row whose grains fail (crushed, not finite) keeps its points
    up to then; the failing point has the engine's status, later ones -1, and both have NaN in place of values.

    ValueError: arguments that make no sense. FileExistsError: `file` is there and is another dataset (`overwrite`
    replaces it), or beside it lies the beginning of another one. RuntimeError: another process makes this dataset."""
    path, all_paths = Path(file), as_paths(paths)
    grains = engine.packings_from(packings)
    rows = make_rows(len(all_paths), len(grains), packing_of, mirrored, (packing_split, path_split))
    wanted = chosen(fields, bool(all_paths.held.any()) or pressure is not None)
    if tangent is None:
        wanted = [one for one in wanted if one.name != "tangent"]
    how = engine.Engine(preset, accuracy, precision, tangent, backend, settings, microstructure(wanted))
    pressures = _pressures(pressure, len(all_paths), [one.pressure for one in grains])[rows.path, rows.packing]
    increments = _consolidation(pressures, np.array([one.pressure for one in grains])[rows.packing], pressure)
    work = Work(how, grains, wanted, control or StressControl(), increments, checkpoint_every)
    plan = _plan(work, all_paths, rows, pressures, points_at_once)
    if path.exists() and not overwrite:
        return _known(path, plan)
    parts = Parts(path, plan, resume)
    try:
        blocks = _blocks(all_paths, rows, pressures, points_at_once)
        _run(work, [block for _, block in blocks], parts, progress)
        about = {"note": note, "made": f"{datetime.datetime.now(datetime.UTC):%Y-%m-%d}"}
        again = min(16, len(rows) // 256) if reference_rows is None else reference_rows
        made = path.with_name(path.name + ".new")
        contents = storage.Contents(plan, about, all_paths, rows, pressures, [index for index, _ in blocks])
        storage.assemble(made, contents, work, parts)
        card.finish(made, path, grains, how, again)
    except BaseException:
        parts.leave()
        raise
    parts.discard()
    return Dataset(path)


def _run(work: Work, blocks: Sequence[Rows], parts: Parts, progress: bool | Callable[[int, int], None]) -> None:
    total = sum(len(rows.packing) * rows.increments for rows in blocks)
    told, done = Progress(total, progress), 0
    for rows in blocks:
        size = len(rows.packing)
        if not rows.is_done(parts):
            before = done
            block = Block(work, rows, parts)
            told.begin(before + size * block.point)
            block.advance(lambda point, before=before, size=size: told(before + size * point))  # type: ignore[misc]
        done += size * rows.increments
        told.begin(done)


def _blocks(paths: Paths, rows: TableRows, pressure: Array, at_once: int) -> list[tuple[Array, Rows]]:
    """Rows of one batch each, with their indices. Rows that hold stresses have blocks of their own, because each of
    their increments takes several evaluations of the whole batch."""
    holds = paths.held.any(axis=1)[rows.path]
    blocks: list[tuple[Array, Rows]] = []
    for index in (np.flatnonzero(~holds), np.flatnonzero(holds)):
        for first in range(0, len(index), at_once):
            some = index[first : first + at_once]
            path = rows.path[some]
            described = Rows(
                len(blocks),
                rows.packing[some],
                rows.mirrored[some],
                paths.gradient[path],
                paths.held[path],
                pressure[some],
            )
            blocks.append((some, described))
    return blocks


def _pressures(pressure: float | Array | None, paths: int, packings: Sequence[float]) -> Array:
    """The pressure at point 0 of each path on each packing (paths, packings) [Pa]."""
    own = np.broadcast_to(np.asarray(packings, float), (paths, len(packings)))
    if pressure is None:
        return own.copy()
    given = np.asarray(pressure, float)
    if given.shape not in ((), (paths,)) or not (np.isfinite(given) & (given > 0)).all():
        raise ValueError(f"pressure is a positive number, or one for each of {paths} paths [Pa]")
    return np.broadcast_to(np.broadcast_to(given, (paths,))[:, None], own.shape).copy()


def _consolidation(wanted: Array, packing: Array, pressure: Any) -> int:
    """The number of increments in which all rows come to their pressures; 0: they are there."""
    if pressure is None:
        return 0
    return max(1, int(np.ceil(np.abs(np.log(wanted / packing)).max() / np.log(RATIO))))


def _plan(work: Work, paths: Paths, rows: TableRows, pressure: Array, at_once: int) -> dict[str, Any]:
    """What decides every bit of a dataset, as JSON has it."""
    grains = [digest(*(getattr(one, name) for name in _GRAINS)) for one in work.packings]
    dealt = digest(rows.path, rows.packing, rows.mirrored, rows.packing_part, rows.path_part, pressure)
    return {
        "format": storage.FORMAT,
        "parts": VERSION,
        "version": engine.version(),
        "paths": digest(paths.gradient, paths.held, paths.family),
        "packings": grains,
        "rows": dealt,
        "engine": work.engine.plan(),
        "fields": [one.name for one in work.fields],
        "control": vars(work.control) if work.consolidation or paths.held.any() else {},
        "points_at_once": at_once,
    }


_GRAINS = ("radius", "position", "rotation", "cell", "contacts", "history")


def _known(path: Path, plan: dict[str, Any]) -> Dataset:
    """A dataset that is there already."""
    data = Dataset(path)
    if data.plan == plan:
        return data
    data.close()
    raise FileExistsError(f"{path} is another dataset; overwrite=True replaces it")
