"""What one call of generate() has to do, before anything is computed."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import engine
from .block import RATIO, BlockRows, Work
from .control import StressControl
from .fields import chosen, microstructure
from .parts import digest
from .rows import Rows
from .schedule import Paths
from .storage import FORMAT

Array = np.ndarray
PARTS_VERSION = 1
GRAINS = ("radius", "position", "rotation", "cell", "contacts", "history")


@dataclass(frozen=True)
class Job:
    """Paths, packings and settings of a dataset; `pressure` (rows,) is wanted at point 0 [Pa]."""

    file: Path
    paths: Paths
    rows: Rows
    pressure: Array
    work: Work
    points_at_once: int

    def plan(self) -> dict[str, Any]:
        """What decides every bit of the set, as JSON has it."""
        rows, paths, work = self.rows, self.paths, self.work
        dealt = (rows.path, rows.packing, rows.mirrored, rows.packing_part, rows.path_part, self.pressure)
        return {
            "format": FORMAT,
            "parts": PARTS_VERSION,
            "version": engine.version(),
            "paths": digest(paths.gradient, paths.held, paths.family),
            "packings": [_fingerprint(one) for one in work.packings],
            "rows": digest(*dealt),
            "engine": work.engine.plan(),
            "fields": [one.name for one in work.fields],
            "control": vars(work.control) if work.consolidation or paths.held.any() else {},
            "points_at_once": self.points_at_once,
        }

    def blocks(self) -> list[tuple[Array, BlockRows]]:
        """Rows of one batch each, with their indices. Rows that hold stresses have blocks of their own, because each of
        their increments takes several evaluations of the whole batch."""
        holds: Array = self.paths.held[self.rows.path].any(axis=1)
        pieces: list[Array] = []
        for index in (np.flatnonzero(~holds), np.flatnonzero(holds)):
            pieces += [index[k : k + self.points_at_once] for k in range(0, len(index), self.points_at_once)]
        return [(index, self._block(number, index)) for number, index in enumerate(pieces)]

    def _block(self, number: int, index: Array) -> BlockRows:
        path = self.rows.path[index]
        return BlockRows(
            number,
            self.rows.packing[index],
            self.rows.mirrored[index],
            self.paths.gradient[path],
            self.paths.held[path],
            self.pressure[index],
        )


def make_work(
    how: engine.Engine,
    packings: Sequence[Any],
    fields: Sequence[str] | None,
    holds: bool,
    control: StressControl,
    checkpoint_every: float,
) -> Work:
    """Settings of all blocks, without consolidation. `holds`: whether any stress is held."""
    wanted = [one for one in chosen(fields, holds) if one.name != "tangent" or how.tangent is not None]
    return Work(replace(how, microstructure=microstructure(wanted)), packings, wanted, control, 0, checkpoint_every)


def consolidated(work: Work, rows: Rows, wanted: ArrayLike | None) -> tuple[Work, Array]:
    """The work with the number of increments in which all rows come to their pressures, and these pressures [Pa]: those
    of the packings (None), or `wanted`, one number or one a path.

    ValueError: `wanted` has another shape, or is not positive."""
    own = np.array([one.pressure for one in work.packings], float)[rows.packing]
    if wanted is None:
        return work, own
    given, paths = np.asarray(wanted, float), len(rows.path_part)
    if given.shape not in ((), (paths,)) or not (np.isfinite(given) & (given > 0)).all():
        raise ValueError(f"pressure is a positive number, or one for each of {paths} paths [Pa]")
    pressure = np.broadcast_to(given, (paths,))[rows.path]
    increments = max(1, int(np.ceil(np.abs(np.log(pressure / own)).max() / np.log(RATIO))))
    return replace(work, consolidation=increments), pressure


def _fingerprint(packing: Any) -> str:
    soil: Mapping[str, Any] = getattr(packing, "soil", None) or {}
    texts = np.array([f"{key}={value}" for key, value in sorted(soil.items())], str)
    return digest(*(getattr(packing, name) for name in GRAINS), texts)
