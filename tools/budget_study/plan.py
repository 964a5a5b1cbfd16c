"""The runs of the study. A run is named GROUP_DRAW; a draw is a set of seeds that no other draw of its group has."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
QUICK = ROOT / "cases/tunnel_quick/case.toml"
FULL = ROOT / "cases/tunnel_cps_d_cd3/case.toml"
VARIETIES = (1, 2, 4, 8, 16)
CANDIDATES = 8  # packings of a draw, or as many as the variety where this is more
TO_TEN_PERCENT = {"volume_loss.total": "10 %", "volume_loss.increments": 40}


@dataclass(frozen=True)
class Run:
    """One run of a sweep."""

    group: str  # all runs of a group differ in their draw alone
    draw: int
    base: Path
    settings: Mapping[str, object] = field(hash=False)

    @property
    def name(self) -> str:
        return f"{self.group}_{self.draw:03d}"


def _drawn(group: str, draws: Iterable[int], base: Path, settings: Mapping[str, object]) -> list[Run]:
    """The runs of one group. The seeds of a draw follow those of the draw before."""
    variety = int(str(settings.get("packing.variety", 1)))
    candidates = max(CANDIDATES, variety)
    return [
        Run(group, k, base, {**settings, "packing.candidates": candidates, "packing.seed": 1 + k * candidates})
        for k in draws
    ]


def _varieties(n: int, base: Path, settings: Mapping[str, object]) -> list[Run]:
    """Draw by draw, so that a study that is stopped has as many draws of each variety."""
    return [
        run
        for k in range(n)
        for variety in VARIETIES
        for run in _drawn(f"k{variety:02d}", [k], base, {**settings, "packing.variety": variety})
    ]


def draws(n: int = 24) -> list[Run]:
    return _varieties(n, QUICK, {})


def draws_full(n: int = 3) -> list[Run]:
    return _varieties(n, FULL, TO_TEN_PERCENT)


# One knob at a time around `tunnel_quick` with eight packings. The labels are the rows of the table.
KNOBS: dict[str, dict[str, object]] = {
    "base": {},
    "20 increments": {"volume_loss.increments": 20},
    "80 increments": {"volume_loss.increments": 80},
    "gravity in steps of 0.1": {"gravity.uniform_step": 0.1},
    "mesh finer": {"ground.mesh_size_opening": "1.0 m", "ground.mesh_size_far": "4.0 m"},
    "mesh finest": {"ground.mesh_size_opening": "0.8 m", "ground.mesh_size_far": "3.2 m"},
    "domain 50 m wide": {"ground.width": "50 m"},
    "domain 50 m high": {"ground.height": "50 m"},
    "opening on a fixed mesh": {"volume_loss.geometry": "fixed_mesh"},
    "preset fast": {"engine.preset": "fast"},
    "preset reference": {"engine.preset": "reference"},
    "contact tangent": {"newton.tangent": "contact"},
    "static tangent": {"newton.tangent": "static"},
    "relaxed from 5 %": {"newton.relax_near": 0.05},
    "deferral of 0.1 %": {"engine.defer": 1e-3},
    "variety 1": {"packing.variety": 1},
    "150 grains": {"packing.grains": 150},
    "700 grains": {"packing.grains": 700},
}
MOST_DRAWS = {"preset reference": 1}  # twenty times the work of the base
# At full size only a few knobs, because a run takes minutes.
KNOBS_OF_FULL_SIZE = ("base", "20 increments", "preset fast", "variety 1")


def _slug(label: str) -> str:
    return "".join(c if c.isalnum() else "_" for c in label)


def _knobs(labels: Iterable[str], n: int, base: Path, settings: Mapping[str, object]) -> list[Run]:
    return [
        run
        for k in range(n)
        for label in labels
        if k < MOST_DRAWS.get(label, n)
        for run in _drawn(_slug(label), [k], base, {"packing.variety": 8, **settings, **KNOBS[label]})
    ]


def knobs(n: int = 3) -> list[Run]:
    return _knobs(KNOBS, n, QUICK, {})


def knobs_full(n: int = 1) -> list[Run]:
    return _knobs(KNOBS_OF_FULL_SIZE, n, FULL, TO_TEN_PERCENT)


def label_of(group: str) -> str:
    """The row of a group in a table."""
    return next((label for label in KNOBS if _slug(label) == group), group)


def sweep_text(runs: Iterable[Run]) -> str:
    """The file of `voussoir sweep`. All runs of one list have one base."""
    listed = list(runs)
    text = [f"base = {json.dumps(str(listed[0].base))}"]
    for run in listed:
        settings = [f"{key}={json.dumps(value)}" for key, value in run.settings.items()]
        text.append(f"[[run]]\nname = {json.dumps(run.name)}\nset = {json.dumps(settings)}")
    return "\n".join(text) + "\n"
