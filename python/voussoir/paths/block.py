"""Rows of a dataset that one batch advances together, increment by increment."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import engine
from .control import State, StressControl, evaluate
from .fields import MASKED, TANGENT_PLACES, Field
from .parts import Arrays, Parts
from .tensors import voigt_of

Array = np.ndarray
RATIO = 1.15  # of the mean stress in one increment of consolidation


@dataclass(frozen=True)
class Work:
    """What all blocks of a dataset share."""

    engine: engine.Engine
    packings: Sequence[Any]
    fields: Sequence[Field]
    control: StressControl
    consolidation: int  # increments
    checkpoint_every: float  # seconds


@dataclass(frozen=True)
class BlockRows:
    """What the rows of a block are; each array has one entry a row."""

    number: int  # of the block
    packing: Array
    mirrored: Array
    gradient: Array  # (m, increments, 2, 2)
    held: Array  # (m, 3)
    pressure: Array  # after consolidation [Pa]

    @property
    def increments(self) -> int:
        return int(self.gradient.shape[1])

    def part(self, point: int) -> str:
        return part_name(self.number, point)

    def is_done(self, parts: Parts) -> bool:
        """Whether all parts are there; they are written in order."""
        return parts.has(self.part(self.increments))


def part_name(block: int, point: int) -> str:
    return f"block{block:04d}_point{point:05d}"


class Block:
    """A batch on its way: begun anew, or from the checkpoint that an earlier process left."""

    def __init__(self, work: Work, rows: BlockRows, parts: Parts) -> None:
        self.work, self.rows, self.parts = work, rows, parts
        self.batch = engine.make_batch(work.engine, work.packings, rows.packing, rows.mirrored)
        self.grains = np.array([len(one.radius) for one in work.packings])[rows.packing]
        self.checkpoint = f"block{rows.number:04d}_state"
        self.saved = time.monotonic()
        known = parts.load(self.checkpoint)
        if known is None:
            self._begin()
        else:
            self.batch.set_state(known["state"].tobytes())
            self.point, self.failed, self.target = int(known["point"]), known["failed"], known["target"]
            self.state = State(known["stress"], known["tangent"])
        self.is_between = True  # two increments: the committed state, `point`, `failed` and the parts belong together

    def advance(self, told: Callable[[int], None]) -> None:
        """Runs all increments that are left; `told` hears of each. What ends this during an evaluation or between two
        increments leaves a checkpoint; while an answer is written, the checkpoint before has to do."""
        try:
            while self.point < self.rows.increments:
                self._increment()
                told(self.point)
                if time.monotonic() - self.saved > self.work.checkpoint_every:
                    self._save()
        except BaseException:
            if self.is_between:
                self._save()
            raise
        finally:
            self.batch.close()
        if self.parts.has(self.checkpoint):
            self.parts.settle()
            self.parts.remove(self.checkpoint)

    def _begin(self) -> None:
        """Consolidation, and the part of point 0."""
        m = len(self.rows.packing)
        self.point, self.failed = 0, np.zeros(m, bool)
        self.state = State.of(self.batch.committed(tangent=True))
        first, held = -0.5 * (self.state.stress[:, 0] + self.state.stress[:, 1]), np.array([True, True, False])
        gradients = np.zeros((m, self.work.consolidation, 2, 2))
        answer, error = self.batch.committed(tangent=True), np.zeros(m)
        status: Array = np.full(m, MASKED, np.int8)  # of the increment in which each row failed
        for k in range(self.work.consolidation):
            share = (k + 1) / self.work.consolidation
            target = np.zeros((m, 3))
            target[:, :2] = -(first ** (1 - share) * self.rows.pressure**share)[:, None]
            answer, gradients[:, k], error, new = self._advance(gradients[:, k], np.tile(held, (m, 1)), target)
            status = np.where(new == MASKED, status, new)
        self.target = self.state.stress.copy()
        record = self._record(answer, np.full((m, 2, 2), np.nan), error, status)
        self.parts.save(self.rows.part(0), {**record, "consolidation": gradients})

    def _increment(self) -> None:
        before = self.failed.copy()
        gradient = self.rows.gradient[:, self.point]
        answer, used, error, status = self._advance(gradient, self.rows.held, self.target)
        used = np.where(before[:, None, None], np.nan, np.where(self.failed[:, None, None], gradient, used))
        self.point += 1
        self.parts.save(self.rows.part(self.point), self._record(answer, used, error, status))
        self.is_between = True

    def _advance(self, gradient: Array, held: Array, target: Array) -> tuple[Any, Array, Array, Array]:
        """Evaluates and commits one increment: answer, gradients, control errors, statuses of failures (MASKED where
        none or an earlier one). Rows that fail are strained no further, and the others are evaluated once more without
        them, with the same bits."""
        status = np.full(len(gradient), MASKED, np.int8)
        gradient = np.where(self.failed[:, None, None], 0.0, gradient)
        held = held & ~self.failed[:, None]
        wants = self.work.engine.tangent is not None
        done = evaluate(self.batch, self.state, gradient, held, target, wants, self.work.control)
        answer, used, all_failed = done.answer, done.gradient, self.failed
        for _ in range(3):
            failed = engine.failures(answer)
            if not failed.any():
                break
            new = failed & ~all_failed
            status[new] = answer.report["status"][new]
            all_failed = all_failed | failed
            used = np.where(failed[:, None, None], 0.0, used)
            answer = self.batch.evaluate(used, tangent=wants)
        self.is_between = False
        self.batch.commit()
        self.state, self.failed = done.state, all_failed
        self.state.stress = voigt_of(answer.stress)
        return answer, used, done.error, status

    def _record(self, answer: Any, gradient: Array, error: Array, status: Array) -> Arrays:
        """The part of one point. Rows that have failed have NaN, or -1 in integers; their status tells where."""
        record: Arrays = {"gradient": gradient}
        values = self._values(answer, error)
        for one in self.work.fields:
            if one.name != "strain":  # follows from the gradients, when all of them are known
                record[one.name] = np.asarray(values[one.name]()).astype(one.kind)
                record[one.name][self.failed] = one.empty()
        record["status"] = np.where(self.failed, status, record["status"]).astype(np.int8)
        return record

    def _values(self, answer: Any, error: Array) -> dict[str, Callable[[], Array]]:
        """How each field is got. fields() of a batch goes through all contacts, and is called only for what nothing
        else gives."""
        report, rows, column = answer.report, TANGENT_PLACES[0], TANGENT_PLACES[1]
        described = self.batch.fields() if any(one.source == "fields" for one in self.work.fields) else {}
        return {
            **{name: lambda name=name: report[name] for name in report.dtype.names},  # type: ignore[misc]
            **{name: lambda name=name: described[name] for name in described},  # type: ignore[misc]
            "stress": lambda: voigt_of(answer.stress),
            "tangent": lambda: answer.tangent[:, rows, column],
            "control_error": lambda: error,
            "void_ratio": lambda: self.batch.void_ratio,
            "coordination": lambda: 2 * report["contacts"] / self.grains,
        }

    def _save(self) -> None:
        self.parts.settle()
        state = np.frombuffer(self.batch.state(), np.uint8)
        self.parts.save(
            self.checkpoint,
            {
                "state": state,
                "point": np.array(self.point),
                "failed": self.failed,
                "target": self.target,
                "stress": self.state.stress,
                "tangent": self.state.tangent,
            },
        )
        self.parts.settle()
        self.saved = time.monotonic()
