"""The same strains once more, with other settings of the engine: what a preset changes, and tangents of other kinds."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from . import engine
from .dataset import Dataset
from .tensors import voigt_of

Array = np.ndarray


def replay(data: Dataset, packings: Sequence[Any], rows: Array, **changes: Any) -> Array:
    """Stresses (m, points, 3) [Pa] of rows of a dataset, sorted, from the strains that are stored. `packings` are
    those of the set, in its order; `changes` replace settings of its engine, such as preset="reference".

    Every strain is prescribed, also where the set held a stress. Rows that fail have NaN from there on."""
    rows = np.unique(np.asarray(rows))
    plan = data.plan["engine"]
    how = replace(engine.Engine(**{**plan, "microstructure": tuple(plan["microstructure"])}), **changes)
    steps = [data["gradient"][rows]]
    if "consolidation" in data:
        steps.insert(0, data["consolidation"][rows])
    gradient = np.nan_to_num(np.concatenate(steps, axis=1))
    first = gradient.shape[1] - (data.points - 1)
    batch = engine.make_batch(how, packings, data["row/packing"][:][rows], data["row/mirrored"][:][rows])
    stress = np.full((len(rows), gradient.shape[1] + 1, 3), np.nan)
    failed = np.zeros(len(rows), bool)
    try:
        stress[:, 0] = voigt_of(batch.committed(tangent=False).stress)
        for k in range(gradient.shape[1]):
            failed |= _advance(batch, gradient[:, k], failed)
            stress[:, k + 1] = voigt_of(batch.committed(tangent=False).stress)
            stress[failed, k + 1] = np.nan
    finally:
        batch.close()
    return stress[:, first:]


def _advance(batch: Any, gradient: Array, failed: Array) -> Array:
    """Evaluates and commits one increment; which rows failed."""
    failed = failed.copy()
    for _ in range(3):
        answer = batch.evaluate(np.where(failed[:, None, None], 0.0, gradient), tangent=False)
        new = engine.failures(answer)
        if not new.any():
            break
        failed |= new
    batch.commit()
    return failed
