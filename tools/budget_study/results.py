"""The results of one tunnel that the tables compare."""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from voussoir.figures.reaction import curve
from voussoir.figures.result import Missing, Result
from voussoir.figures.troughs import Trough

# The results, with their units and the factor from SI to the unit.
RESULTS = {
    "settlement_1": ("surface settlement at V_l = 1 %", "mm", 1e3),
    "settlement_5": ("at 5 %", "mm", 1e3),
    "settlement_10": ("at 10 %", "mm", 1e3),
    "width": ("K_s at 10 %", "-", 1.0),
    "reaction": ("least ground reaction until 10 %", "-", 1.0),
    "k0": ("K0 at the tunnel's axis", "-", 1.0),
}


@dataclass
class Measured:
    """Numbers of one run [SI]; `fits` says whether the trough has the shape of its curve."""

    values: dict[str, float]
    fits: bool
    particle_steps: float
    seconds: float  # of the grains
    lanes: float  # share of the lanes' steps that moved a grain, in the volume loss [-]; nan where the log lacks it


def _lanes_share(folder: Path) -> float:
    for line in (folder / "run.log").read_text().splitlines():
        if "volume_loss:" in line and "% of the steps of the lanes" in line:
            return float(line.split("volume_loss:")[1].split("%")[0]) / 100
    return float("nan")


def measured(folder: Path) -> Measured | None:
    """The results of a run until V_l = 10 %; None where it has not come to V_l = 10 %."""
    cache = folder / "budget.json"
    index = folder / "run.h5"
    if not index.exists():
        return None
    if cache.exists() and cache.stat().st_mtime > index.stat().st_mtime:
        return Measured(**json.loads(cache.read_text()))
    try:
        result = Result(folder)
        found = {round(100 * i["volume_loss"], 6): i for i in result.loss_increments}
        last = found.get(10.0)
        if last is None:
            return None
        trough = Trough(result, last, 0.0)
        loss, ratio, _ = curve(result)
        reaction = float(np.min(ratio[loss <= 0.1 * (1 + 1e-9)]))
    except Missing:
        return None
    table, k0 = result.table("increments"), result.table("k0")
    steps = float(np.nansum(table["particle_steps"]))
    # Runs of earlier versions count the tangents with the grains and have no column of their own for them.
    seconds = sum(float(np.nansum(table[name])) for name in ("time_grains", "time_tangents") if name in table)
    (axis_depth, unit_weight, surcharge) = result.need("axis_depth", "unit_weight", "surcharge")
    in_loss = np.isfinite(table["volume_loss"]) & (table["volume_loss"] > 0)
    settlement = {
        f"settlement_{percent}": float(
            np.interp(percent / 100, table["volume_loss"][in_loss], table["surface_settlement"][in_loss])
        )
        for percent in (1, 5, 10)
    }
    values = {
        **settlement,
        "width": float(trough.width),
        "reaction": reaction,
        "k0": float(np.interp(surcharge + unit_weight * axis_depth, k0["vertical_stress"], k0["ratio"])),
    }
    numbers = Measured(values, bool(trough.fit.good), steps, seconds, _lanes_share(folder))
    cache.write_text(json.dumps(numbers.__dict__))
    return numbers
