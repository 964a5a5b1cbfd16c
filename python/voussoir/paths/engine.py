"""The batches that a dataset is made with."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from voussoir.answers import status_names

Array = np.ndarray
FIRST_FAILURE = status_names.index("neighbour_overflow")  # statuses from here on have no answer


@dataclass(frozen=True)
class Engine:
    """How grains are moved: the arguments of voussoir.RveBatch with these names."""

    preset: str = "standard"
    accuracy: float | str | None = None
    precision: str | None = None
    tangent: str | None = "elastic"  # None: no tangents
    backend: str = "lanes"
    settings: Mapping[str, Any] | None = None
    microstructure: tuple[str, ...] = ()

    def plan(self) -> dict[str, Any]:
        """As JSON has it."""
        known = {**asdict(self), "settings": dict(self.settings or {})}
        return json.loads(json.dumps(known, default=str))


def make_batch(engine: Engine, packings: Sequence[Any], packing_of: Array, mirrored: Array) -> Any:
    """A batch with one point a row."""
    import voussoir

    return voussoir.RveBatch(
        list(packings),
        len(packing_of),
        packing_of=packing_of,
        preset=engine.preset,
        accuracy=engine.accuracy,
        precision=engine.precision,
        tangent=engine.tangent or "elastic",
        mirrored=mirrored,
        microstructure=engine.microstructure,
        backend=engine.backend,
        settings=dict(engine.settings) if engine.settings else None,
    )


def version() -> str:
    """The version of the package that makes a dataset."""
    import voussoir

    return str(voussoir.__version__)


def packings_from(packings: Any) -> list[Any]:
    """Packings from a packing, the path of one, or a sequence of either.

    ValueError: there are none."""
    import voussoir

    several = packings if isinstance(packings, Sequence) and not isinstance(packings, str) else [packings]
    if not len(several):
        raise ValueError("a dataset needs at least one packing")
    return [one if hasattr(one, "radius") else voussoir.load_packing(one) for one in several]


def failures(answer: Any) -> Array:
    """The points (n,) whose evaluation failed."""
    return (answer.report["status"] >= FIRST_FAILURE) | ~np.isfinite(answer.stress).all(axis=(1, 2))
