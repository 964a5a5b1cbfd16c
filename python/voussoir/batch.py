"""Batches of RVEs (representative volume elements of grains) as a material law: displacement gradients in, stresses and
tangents out."""

import logging
import os
from collections.abc import Iterable, Sequence
from types import TracebackType
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from voussoir.answers import Answer, Snapshot, report_dtype
from voussoir.engine import running
from voussoir.packings import Floats, Integers, Packing, as_dict, from_dict, grains_of, load_packing
from voussoir.settings import Settings, as_texts, name, text_of, told_by_argument, whole_number

_log = logging.getLogger("voussoir")

_bytes_of_a_grain = 200  # at least: 227 to 240 were measured on a batch of 1000 points, 300 and 100 grains

_precisions = {"float": "float", "double": "double", "float32": "float", "float64": "double"}


class RveBatch:
    """n points of a continuum, each with an RVE of grains, that answer together.

    An evaluation starts from the committed state, however often it is repeated; `commit` makes the last one the
    committed state. Within an increment the numbers of time steps are frozen at those of the first evaluation, so that
    the stress is a fixed function of the gradient; `commit` and `begin_increment` end this. What an evaluation answers
    may therefore differ by some 0.1 % from what it would have answered as the first one of its increment.

    A batch may be used by several threads, one at a time. It works while other Python threads run, and Ctrl-C stops it
    within a second.
    """

    def __init__(
        self,
        packings: "Packing | str | os.PathLike[str] | Iterable[Packing | str | os.PathLike[str]]",
        n: int | None = None,
        *,
        packing_of: ArrayLike | None = None,
        preset: str = "standard",
        accuracy: float | None = None,
        precision: str | None = None,
        tangent: str = "elastic",
        mirrored: bool | ArrayLike = False,
        microstructure: str | Sequence[str] = (),
        backend: str = "lanes",
        settings: Settings | None = None,
    ) -> None:
        """Makes a batch whose points are at rest under the pressure of their packings.

        Args:
            packings: a Packing or a packing file, or several
            n: number of points; where it is left out, as many as `packing_of` has, or else as packings
            packing_of: (n,) index of the packing of each point; dealt out in turn where it is left out
            preset: "fast", "standard" or "reference": speed against accuracy (docs/validation/trade.md)
            accuracy: wanted error of the stress over the pressure [-], in place of the preset's rate of strain
            precision: "float" or "double" of the pair forces; that of the preset where it is left out
            tangent: "contact" (eq. 4 of the paper), "elastic", "static" or "loading" (docs/explanation/tangents.md), or
                "auto", which is "elastic", on a GPU "contact"
            mirrored: whether points answer as the mirror image (x to -x) of their packing: all, or (n,) of them
            microstructure: one or several quantities to add to `fields`, such as "fabric" (key output.microstructure)
            backend: "lanes" of the processor, "gpu", or "auto" for a GPU where there is one
            settings: further keys of [engine] and newton.tangent_strain; they override the arguments above

        Raises:
            InputError: a setting, or a value of an argument, is wrong
            ValueError: wrong shape or index; a packing that is not of this program
            MemoryError: the points need more memory than this computer has
            RuntimeError: no GPU for backend="gpu"; after fork()
        """
        listed = _listed(packings)
        count = _count(listed, n, packing_of)
        if backend == "lanes":
            _check_memory(count * min(len(packing) for packing in listed))
        index = np.arange(count) % len(listed) if packing_of is None else np.asarray(packing_of)
        if index.shape != (count,) or index.dtype.kind not in "iu":
            raise ValueError(f"packing_of needs {count} integers, one for each point")
        given: dict[str, Any] = {
            "engine.preset": preset,
            "engine.backend": backend,
            "newton.tangent": tangent,
            "output.microstructure": [microstructure] if isinstance(microstructure, str) else list(microstructure),
        }
        if accuracy is not None:
            given["engine.accuracy"] = accuracy
        if precision is not None:
            given["engine.precision"] = _precisions.get(precision, precision)
        allowed = ("engine", "newton.tangent", "newton.tangent_strain", "output.microstructure")
        text = text_of("biaxial_bvp", settings, allowed, given)
        mirrors, parts = _mirrored(mirrored, len(index)), [as_dict(packing) for packing in listed]
        with told_by_argument(settings, {key: key.rpartition(".")[2] for key in given}):
            self._begin(running().new_batch(parts, index.tolist(), text, name, mirrors))

    @classmethod
    def from_case(
        cls,
        case_file: str | os.PathLike[str],
        n: int,
        settings: Settings | Sequence[str] = (),
        *,
        mirrored: bool | ArrayLike = False,
    ) -> Self:
        """A batch as a case of the program describes it by its tables [soil], [packing] and [engine], by
        newton.tangent and by output.microstructure. Its packings are made, or found in packing.folder, which needs
        h5py.

        Args:
            case_file: of one of the kinds pack, probe, column, tunnel
            n: number of points
            settings: keys that replace those of the case, as {"packing.grains": 300} or as texts
                ["packing.grains=300"], which --set of the program takes
            mirrored: as in RveBatch. packing.mirrored of the case does not count.

        Raises:
            InputError: with file, line and key
            NoEquilibrium: no packing comes to rest
        """
        count = whole_number(n, "n")
        batch, notes = running().batch_of_case(str(case_file), as_texts(settings), count, _mirrored(mirrored, count))
        for note in notes:
            _log.info(note)
        new = cls.__new__(cls)
        new._begin(batch)
        return new

    def _begin(self, batch: Any) -> None:
        self._core = batch
        self._packing_of = batch.packing_of().astype(np.int64)
        if device := batch.device():
            _log.info(device)

    def __len__(self) -> int:
        return len(self._core)

    def __repr__(self) -> str:
        state = "" if self._core.is_open else ", closed"
        return f"<voussoir.RveBatch of {len(self)} points, {len(np.unique(self._packing_of))} packings{state}>"

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Gives the grains' memory back. Every later use raises RuntimeError, but a second close()."""
        self._core.close()

    def evaluate(self, f_minus_i: ArrayLike, tangent: bool = True) -> Answer:
        """Stresses and tangents after displacement gradients.

        Args:
            f_minus_i: (n, 2, 2) the displacement gradient H = F - I (F minus identity, and not F), where F maps the
                committed configuration to the new one [-]
            tangent: False saves the time of the tangents. Which tangent it is, RveBatch(tangent=...) says.

        Returns:
            Answer. A point that has failed has NaN.

        Raises:
            ValueError: wrong shape, a gradient that is not finite, or all gradients are within 0.1 of the identity
                matrix, as F is. A batch of one point meets this where H is meant to double its cell: a search for H
                should stay below 0.9
            TypeError: `tangent` is neither True nor False
            KeyboardInterrupt: after Ctrl-C; the committed state is as before, and the next evaluation is the first one
                of the increment
            RuntimeError: the batch is closed; after fork()
        """
        gradients = np.ascontiguousarray(f_minus_i, dtype=np.float64)
        if gradients.shape != (len(self), 2, 2):
            raise ValueError(f"f_minus_i needs the shape ({len(self)}, 2, 2), has {gradients.shape}")
        answer = _answer(self._core.evaluate(gradients, _truth(tangent)))
        return answer if answer.usable else answer._replace(message=answer.message + _inside_out(gradients))

    def commit(self) -> None:
        """Makes the state of the last evaluation the committed one and begins an increment.

        Raises:
            RuntimeError: there is no evaluation since the last commit or set_state, or it was not usable, or it was
                interrupted
        """
        self._core.commit()

    def begin_increment(self) -> None:
        """Lets the next evaluation choose the numbers of time steps anew, such as after a step that is cut."""
        self._core.begin_increment()

    def committed(self, tangent: bool = True) -> Answer:
        """The answer of the committed state. The tangent is the one that its evaluation found, or after
        `tangent=False` that of eq. (4), which is stiffer than those of the other kinds."""
        return _answer(self._core.committed(_truth(tangent)))

    def state(self, points: ArrayLike | None = None) -> bytes:
        """The committed state of these points (None: of all) as bytes, for `set_state` of this or an equal batch.

        Args:
            points: numbers of points, of which negative ones count from the end, or a mask (n,) of bool

        Raises:
            IndexError: there is no such point, or the mask has another length
            TypeError: a point is no whole number
        """
        return bytes(self._core.state(self._points(points)))

    def set_state(self, state: bytes, points: ArrayLike | None = None) -> None:
        """Gives a state to these points (None: to all). Their packings must be those of the points that it was taken
        from, in the same order. An increment begins. A state is that of the grains: whether a point is mirrored is no
        part of it.

        Raises:
            ValueError: the bytes are no state of such points, or a bit of them is wrong; the points keep the state that
                they have
            TypeError: the state is no bytes
            IndexError: there is no such point
        """
        if not isinstance(state, bytes):
            raise TypeError(f"a state is bytes, as state() gives them, not {type(state).__name__}")
        self._core.set_state(state, self._points(points))

    def fields(self) -> dict[str, Floats]:
        """Quantities of the committed state at each point, (n,) or (n, components), with the names and units of result
        files (docs/reference/files.md): void_ratio, coordination, ..., and the microstructure that was asked for."""
        return {name: values for name, _, values in self._core.fields()}

    def field_units(self) -> dict[str, str]:
        """The unit of each of `fields`."""
        return {name: unit for name, unit, _ in self._core.fields()}

    @property
    def void_ratio(self) -> Floats:
        """(n,) of the committed state [-]."""
        return np.asarray(self._core.void_ratio())

    @property
    def packing_of(self) -> Integers:
        """(n,) index of each point's packing."""
        return self._packing_of

    def snapshot(self, point: int) -> Snapshot:
        """Grains and contact network of a point in the committed state, mirrored where the point is."""
        grains = self._core.snapshot(self._point(point))
        return Snapshot(**grains_of(grains), branch=grains["branch"], force=grains["force"])

    def packing(self, point: int) -> Packing:
        """The grains of a point in the committed state, from which another batch may start. They are never mirrored:
        a mirrored point answers as the image of these grains."""
        return from_dict(self._core.packing(self._point(point)))

    def _point(self, point: int) -> int:
        number = whole_number(point, "a point")
        if not -len(self) <= number < len(self):
            raise IndexError(f"there is no point {number}: the batch has {len(self)}")
        return number % len(self)

    def _points(self, points: ArrayLike | None) -> list[int]:
        if points is None:
            return list(range(len(self)))
        array = np.atleast_1d(np.asarray(points))
        if array.dtype == bool:
            if array.shape != (len(self),):
                raise IndexError(f"a mask of points needs {len(self)} truth values, one for each")
            return np.flatnonzero(array).tolist()
        if array.ndim > 1:
            raise IndexError("points are whole numbers in one row, or a mask")
        return [self._point(k) for k in array.tolist()]


def _listed(packings: Any) -> list[Packing]:
    if isinstance(packings, Packing | str | os.PathLike):
        packings = [packings]
    if not isinstance(packings, Iterable):
        raise TypeError(f"packings are those of make_packings or packing files, not {packings!r}")
    listed = [packing if isinstance(packing, Packing) else load_packing(packing) for packing in packings]
    if not listed:
        raise ValueError("a batch needs at least one packing")
    return listed


def _count(packings: list[Packing], n: int | None, packing_of: ArrayLike | None) -> int:
    """The number of points."""
    if n is None:
        n = len(packings) if packing_of is None else np.size(packing_of)
    count = whole_number(n, "n")
    if count < 1:
        raise ValueError(f"a batch needs at least one point, and n is {count}")
    return count


def _check_memory(grains: int) -> None:
    """Refuses grains that cannot be held, before any list of their points is made: the system would end the process."""
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    needed = grains * _bytes_of_a_grain
    if needed > memory:
        raise MemoryError(
            f"{grains:.3g} grains of all points need at least {needed / 2**30:.0f} GiB, "
            f"and this computer has {memory / 2**30:.0f} GiB"
        )


def _mirrored(mirrored: bool | ArrayLike, n: int) -> list[bool]:
    """Empty where no point is mirrored."""
    flags = np.asarray(mirrored)
    if flags.shape not in ((), (n,)) or flags.dtype != bool:
        raise ValueError(f"mirrored needs one truth value, or {n} of them")
    return [bool(flag) for flag in np.broadcast_to(flags, (n,))] if flags.any() else []


def _truth(tangent: Any) -> bool:
    if not isinstance(tangent, bool | np.bool_):
        raise TypeError(f"tangent is True or False here, not {tangent!r}; RveBatch(tangent=...) says which it is")
    return bool(tangent)


def _inside_out(f_minus_i: Floats) -> str:
    """What is to be added to the message of a failure where a gradient turns a cell inside out."""
    volume = np.linalg.det(np.eye(2) + f_minus_i)
    wrong = np.flatnonzero(volume <= 0)
    if not len(wrong):
        return ""
    return f"; the gradient of point {wrong[0]} turns its cell inside out: det F is {volume[wrong[0]]:.3g}"


def _answer(parts: tuple[Any, ...]) -> Answer:
    stress, tangent, report, usable, message = parts
    return Answer(stress, tangent, report.view(report_dtype), usable, message)
