"""The ground of an ensemble: its mean fields, the half widths of their bands, and its representative member."""

import numpy as np

from voussoir.ensembles import INDEX, Bands
from voussoir.figures.ensemble import Ensemble
from voussoir.figures.result import Increment, Missing, Result, plain, reading

from . import ground
from .fields import FIELDS
from .ground import States


class Members:
    """An ensemble with its members' folders; a member whose folder is gone is left out of what needs it."""

    def __init__(self, ensemble: Ensemble) -> None:
        self.ensemble = ensemble
        path = ensemble.folder / INDEX
        with reading(path) as file:
            begun = [plain(name) for name in file["members/name"][()]]
            self.names = [name for name, kept in zip(begun, file["members/reduced"][()]) if kept]
            self.indices = file["table/index"][()].astype(int)
        self.lost: list[str] = []
        self._results: dict[str, Result] = {}
        for name in self.names:
            try:
                self._results[name] = Result(ensemble.folder / name, ensemble.settings)
            except Missing as reason:
                self.lost.append(f"{name}: {reason}")

    def all(self) -> list[Result]:
        """The results of all members; needed where bands are computed of their fields."""
        if self.lost:
            raise Missing(f"members cannot be read: {'; '.join(self.lost)}")
        return [self._results[name] for name in self.names]

    def representative(self) -> tuple[str, Result]:
        """The member whose curves lie nearest to the mean: the smallest sum over the curves of the mean square of
        (member - mean) / deviation. Curves: surface settlement and ground reaction, or q/p of a specimen."""
        if not self._results:
            raise Missing(f"no member can be read: {'; '.join(self.lost)}")
        curves = [
            self.ensemble.curves[name]
            for name in ("surface_settlement", "ground_reaction", "q_over_p")
            if name in self.ensemble.curves
        ]
        far = np.array([sum(_distance(bands, k) for bands in curves) for k in range(len(self.names))])
        for k in np.argsort(far, kind="stable"):
            if self.names[k] in self._results:
                return self.names[k], self._results[self.names[k]]
        raise AssertionError("a member can be read")


def _distance(bands: Bands, member: int) -> float:
    there = np.isfinite(bands.mean) & (bands.deviation > 0)
    if not there.any():
        return 0.0
    return float(np.mean(((bands.members[member] - bands.mean)[there] / bands.deviation[there]) ** 2))


def increments_at(result: Result, stage: str, loads: np.ndarray) -> list[Increment]:
    """The increments of a stage at these load parameters, which the ensemble's members have in common."""
    found = [i for i in result.increments if i["stage"] == stage]
    have = np.array([i["load_parameter"] for i in found])
    nearest = [int(np.argmin(np.abs(have - load))) if len(have) else -1 for load in loads]
    if any(k < 0 or abs(have[k] - load) > 1e-9 for k, load in zip(nearest, loads)):
        raise Missing(f"{result.folder} lacks an increment of the ensemble")
    return [found[k] for k in nearest]


def increments_of_rows(result: Result, ensemble: Ensemble, rows: np.ndarray) -> list[Increment]:
    """The increments of an ensemble's rows, whatever their stages."""
    return [increments_at(result, str(ensemble.stage[row]), ensemble.load[row : row + 1])[0] for row in rows]


def mean_and_half_width(members: Members, rows: np.ndarray, stage: str) -> tuple[States, States]:
    """The mean fields and the half widths of the 95 % band of the mean, of the ensemble's increments `rows`."""
    mean, half = (_fields(members, rows, kind) for kind in ("mean", "mean_half_width"))
    if stage == "volume_loss" and "grain_rotation" in mean:
        mean["grain_rotation"] = mean["grain_rotation"] - mean["grain_rotation"][:1]  # counted from V_l = 0
    share = f"{100 * members.ensemble.confidence:g} %"
    note = (
        "The band of the mean is the mean ± this half width. That of rotations counts from the "
        "packing; those of |u| and q/p are not known."
    )
    return (
        States(f"mean of {members.ensemble.count} members", mean.pop("nodes"), mean, bits=12),
        States(f"half width of the {share} band of the mean", half.pop("nodes"), half, bits=7, note=note, band=True),
    )


def _fields(members: Members, rows: np.ndarray, kind: str) -> dict[str, np.ndarray]:
    """The fields that all these increments have, over them, and the displacements as "nodes"."""
    found: dict[str, list[np.ndarray]] = {}
    for row in rows:
        with reading(members.ensemble.folder / "fields" / f"{members.indices[row]:04d}.h5") as file:
            found.setdefault("nodes", []).append(file[f"node/displacement/{kind}"][()])
            for wanted in FIELDS:
                if wanted.data and wanted.data in file:
                    values = ground.component(file[f"{wanted.data}/{kind}"][()], wanted)
                    found.setdefault(wanted.name, []).append(values)
    return {name: np.array(values) for name, values in found.items() if len(values) == len(rows)}
