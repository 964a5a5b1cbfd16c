"""Grains as micro simulations of preCICE's Micro Manager 0.12: one object a point, one batch of RVEs behind them all.

The Micro Manager asks its objects one after the other, and it reads their answers when all have been asked. A `Hub`
therefore only notes the gradients; the first answer that is read runs all points of the process as one batch. A file of
the user's own names the grains, and the configuration of the Micro Manager names this file::

    from voussoir.precice import Hub, Point

    class MicroSimulation(Point):
        hub = Hub(case="grains.toml")

Every MPI rank has a hub and a batch of its own. docs/how-to/couple_with_precice.md has the whole of a coupling.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from voussoir.errors import Error

try:
    from micro_manager import MicroSimulationInterface
except ImportError:  # outside the Micro Manager: the hub can be used and tested all the same
    MicroSimulationInterface = object

__all__ = ["Hub", "Point"]

REFUSED = "the hub takes no adaptivity, load balancing, model switching, stateless models or tasking workers"


class Hub:
    """The batch of this process, and the Micro Manager's protocol on top of it.

    The grains come from one of

    - `case` and `settings`: a case file and overrides "key=value", as for `voussoir.RveBatch.from_case`, which deals
      the packings of the case out to the points of this process;
    - `packings` and further arguments of `voussoir.RveBatch` (`preset`, `tangent`, ...); the point of global id g has
      packing g modulo their number, whichever rank it is on;
    - `make_batch`, which is called with the global ids of the points of this process, in ascending order (n,).

    With `mirrored`, half of the points answer as mirror images of their packing: every second one by the global ids for
    a case, every second one of each packing otherwise.

    `gradients` says from where the displacement gradients of the macro side count: "window" from the start of the time
    window, as updated Lagrangian codes have them, or "total" from the start of the coupling. `tangents=False` saves
    the cost of tangents.

    An evaluation is accepted (committed) by the next `get_state`, `output` or `solve`, unless `set_state` takes it
    back. Where a window has several steps, the state of its start is kept to go back to.

    Grains that find no answer raise `voussoir.Error` with the global ids of their points.
    """

    def __init__(
        self,
        make_batch: Callable[[np.ndarray], Any] | None = None,
        *,
        case: str | Path | None = None,
        settings: tuple[str, ...] | list[str] = (),
        packings: Any = None,
        mirrored: bool = False,
        gradients: str = "window",
        tangents: bool = True,
        **options: Any,
    ) -> None:
        if sum(given is not None for given in (make_batch, case, packings)) != 1:
            raise ValueError("the grains of a Hub come from one of case, packings and make_batch")
        if gradients not in ("window", "total"):
            raise ValueError(f'gradients are of the "window" or "total", not "{gradients}"')
        if options and packings is None:
            raise TypeError(f"arguments of RveBatch go with packings alone: {', '.join(options)}")
        self._make_batch = make_batch or (lambda ids: self._batch_of(ids, case, settings, packings, options))
        self._total = gradients == "total"
        self._mirrored = mirrored
        self._tangents = tangents
        self._members: weakref.WeakValueDictionary[int, Point] = weakref.WeakValueDictionary()
        self._batch: Any = None
        self._ids: np.ndarray = np.zeros(0, int)
        self._requests: dict[int, _Answer] = {}
        self._pending = False  # an evaluation that neither has been accepted nor taken back
        self._start: _Start | None = None  # the state at the start of the window, where it can be taken back
        self._outputs = (0, -1)  # how many there were, and `accepted` at the last one
        self.evaluations = 0  #: calls of the batch so far
        self.accepted = 0  #: evaluations that have been committed so far

    @property
    def batch(self) -> Any:
        """The batch, or None before the first `solve`, which sizes it."""
        return self._batch

    @property
    def ids(self) -> np.ndarray:
        """Global ids of the batch's points, ascending, (n,)."""
        return self._ids

    def _batch_of(self, ids: np.ndarray, case: Any, settings: Any, packings: Any, options: dict[str, Any]) -> Any:
        import voussoir

        if case is not None:
            images = ids % 2 == 1 if self._mirrored else False
            return voussoir.RveBatch.from_case(case, len(ids), settings, mirrored=images)
        packings = packings if isinstance(packings, list | tuple) else [packings]
        images = ids // len(packings) % 2 == 1 if self._mirrored else False
        return voussoir.RveBatch(packings, len(ids), packing_of=ids % len(packings), mirrored=images, **options)

    # What the points call.

    def join(self, point: Point) -> None:
        """Takes a point in, by its global id. Points may come and go until the first `solve`."""
        if self._batch is not None or point.global_id < 0:
            raise RuntimeError(f"point {point.global_id} came after the batch had been made: {REFUSED}")
        if point.global_id in self._members:
            raise RuntimeError(f"there are two points with the global id {point.global_id}")
        self._members[point.global_id] = point

    def solve(self, point: Point, gradient: np.ndarray) -> Mapping[str, Any]:
        """Notes the displacement gradient of a point, (2, 2) [-]; the answer is filled when it is first read."""
        gradient = np.asarray(gradient, float)
        if gradient.shape != (2, 2) or not np.isfinite(gradient).all():
            raise ValueError(f"point {point.global_id}: a gradient is 2 x 2 finite numbers, not {gradient.tolist()}")
        if self._batch is None:
            self._ids = np.array(sorted(self._members))
            self._batch = self._make_batch(self._ids)
            self._asked = np.zeros((len(self._ids), 2, 2))
            self._deformation = np.zeros_like(self._asked)  # F - I of the committed state, for "total"
        if point.global_id in self._requests:
            if not self._pending:
                raise RuntimeError(
                    f"point {point.global_id} was asked again before an answer was read: {REFUSED}, and the macro side "
                    "has to read some data"
                )
            self._keep_start()
            self.accept()
        self._asked[np.searchsorted(self._ids, point.global_id)] = gradient
        self._requests[point.global_id] = answer = _Answer(self, point.global_id)
        return answer

    def accept(self) -> None:
        """Commits the evaluation that waits for it, if there is one."""
        if not self._pending:
            return
        self._batch.commit()
        if self._total:
            self._deformation = self._asked.copy()
        self._pending, self._requests = False, {}
        self.accepted += 1

    def state(self) -> _Start:
        """Accepts, and returns the mark of the state here; all points share it."""
        self.accept()
        if self._start is None or self._start.accepted != self.accepted:
            self._start = _Start(self.accepted)
        return self._start

    def take_back(self, start: _Start) -> None:
        """Goes back to the state that `state` marked last."""
        if start is not self._start:
            raise RuntimeError(f"the state to go back to is not the last one that was taken: {REFUSED}")
        self._pending, self._requests = False, {}
        if start.accepted != self.accepted:
            self._batch.set_state(start.bytes)
            self._deformation = start.deformation
            start.accepted = self.accepted

    def output(self, folder: str | Path) -> None:
        """Accepts, and writes the fields of all points of the process to a file of NumPy's, once for a time window."""
        self.accept()
        if self._outputs[1] == self.accepted:
            return
        self._outputs = (self._outputs[0] + 1, self.accepted)
        Path(folder).mkdir(parents=True, exist_ok=True)
        stress = self._batch.committed(tangent=False).stress
        file = Path(folder) / f"grains_{self._outputs[0]:06d}_from_{self._ids[0]}.npz"
        np.savez(file, global_id=self._ids, stress=stress, **self._batch.fields())

    def run(self) -> None:
        """Evaluates all points and fills their answers."""
        missing = [int(g) for g in self._ids if g not in self._requests or g not in self._members]
        if missing:
            raise RuntimeError(f"point {missing[0]} was not asked ({len(missing)} of {len(self._ids)}): {REFUSED}")
        relative = self._asked
        if self._total:  # F F_n^-1 - I, without cancellation
            relative = (self._asked - self._deformation) @ np.linalg.inv(np.eye(2) + self._deformation)
        answer = self._batch.evaluate(relative, tangent=self._tangents)
        self.evaluations += 1
        if not answer.usable:
            failed = self._ids[np.isnan(answer.stress).any((1, 2))].tolist()
            named = ", ".join(map(str, failed[:8])) + (", ..." if len(failed) > 8 else "")
            raise Error(
                f"the grains of {len(failed)} of {len(self._ids)} points found no answer, global ids {named}: "
                f"{answer.message}. A smaller time window may help"
            )
        self._pending = True
        for row, g in enumerate(self._ids):
            tangent = answer.tangent[row] if self._tangents else None
            self._requests[g].update(self._members[g].write(answer.stress[row], tangent, answer.report[row]))

    def _keep_start(self) -> None:
        """Keeps the state of the window's start before a second step of the window goes beyond it."""
        start = self._start
        if start is not None and start.accepted == self.accepted and start.bytes is None:
            start.bytes, start.deformation = self._batch.state(), self._deformation.copy()


class _Start:
    """The mark of a state. It has the state's bytes only where more than one step went beyond it."""

    def __init__(self, accepted: int) -> None:
        self.accepted = accepted
        self.bytes: bytes | None = None
        self.deformation: Any = None

    def __reduce__(self) -> Any:
        raise RuntimeError(f"a state of the hub cannot move to another process: {REFUSED}")


class _Answer(dict[str, Any]):
    """The answer of a point. It is empty until it is first read."""

    def __init__(self, hub: Hub, global_id: int) -> None:
        super().__init__()
        self._hub, self._id = hub, global_id

    def __missing__(self, name: str) -> Any:
        if self:
            raise KeyError(f"points do not write {name}; they write {', '.join(self)}")
        if self._hub._requests.get(self._id) is not self:
            raise RuntimeError(f"an answer was read after the next one had been asked for: {REFUSED}")
        self._hub.run()
        return self[name]

    def __reduce__(self) -> Any:
        raise RuntimeError(f"an answer of the hub cannot move to another process: {REFUSED}")


class Point(MicroSimulationInterface):
    """One micro simulation. A subclass `MicroSimulation` names the hub.

    The macro side sends the vectors Gradient-X = (du_x/dx, du_x/dy) and Gradient-Y = (du_y/dx, du_y/dy) [-]; `read`
    makes the gradient of other data. It gets what `write` returns: the vectors Stress-X = (xx, xy) and Stress-Y =
    (xy, yy), Cauchy's stress with tension positive [Pa]; the scalars Tangent-11, -12, -13, -22, -23, -33 in Voigt order
    (xx, yy, gamma_xy) [Pa]; and the scalars Status and Steps of the point's report.
    """

    hub: Hub

    def __init__(self, sim_id: int) -> None:
        self.global_id = int(sim_id)
        self.hub.join(self)

    def read(self, macro: Mapping[str, Any]) -> np.ndarray:
        """The displacement gradient, (2, 2) [-], of what the macro side has sent."""
        return np.array([macro["Gradient-X"][:2], macro["Gradient-Y"][:2]])

    def write(self, stress: np.ndarray, tangent: np.ndarray | None, report: Any) -> dict[str, Any]:
        """What the macro side gets, of a stress (2, 2), a tangent (3, 3) or None [Pa], and a report."""
        data = {"Stress-X": stress[0], "Stress-Y": stress[1]}
        if tangent is not None:
            data |= {f"Tangent-{i + 1}{j + 1}": tangent[i, j] for i in range(3) for j in range(i, 3)}
        return data | {"Status": float(report["status"]), "Steps": float(report["steps"])}

    def solve(self, macro: Mapping[str, Any], dt: float) -> Mapping[str, Any]:  # noqa: ARG002
        """Notes what the macro side has sent; grains know no time, so that the size of the step has no meaning."""
        return self.hub.solve(self, self.read(macro))

    def get_state(self) -> Any:
        """The mark of the state to which `set_state` may go back; it accepts the last evaluation."""
        return self.hub.state()

    def set_state(self, state: Any) -> None:
        """Goes back to the mark of the last `get_state`."""
        self.hub.take_back(state)

    def get_global_id(self) -> int:
        """The number of this point in the whole coupling."""
        return self.global_id

    def set_global_id(self, global_id: int) -> None:
        """Refuses another number, since the point has its place in the batch."""
        if global_id != self.global_id:
            raise RuntimeError(f"point {self.global_id} cannot become point {global_id}: {REFUSED}")
