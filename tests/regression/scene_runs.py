"""Cases of kind "scene", shortened: how each is run, and what is left of the sum of its forces.

Packings are always the same (fixed_packings.py). Each case must give its expected_short.csv, and its reactions, weights
and loads must add up to nothing.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from equilibrium import Array, Pressure, balances, check_balance
from expected import check_expected
from fixed_packings import GRAVEL_FILE, LOOSE_SAND, SAND, TWO_SANDS, YADE
from program import ROOT, check, command, fresh, run

GRAVITY = "gravity.uniform_step=0.2"
P0 = 1e3  # packing.pressure of the scenes with gravity [Pa]
# What may be left of the sum of all forces, over the sum of the reactions' magnitudes. Newton's method lets a residual
# of 1e-3 of the loads stand, of which the sum sees a part; the most that was measured is 8e-4 (trapdoor, in gravity).
LEFT = 2e-3


@dataclass
class Short:
    """Settings that shorten a case, and how its forces are balanced."""

    settings: list[str]
    pressure: Pressure | None = None
    heavier: Callable[[Array], float] | None = None
    stages: tuple[str, ...] = ()  # those that are balanced; all, where none is named
    axes: str = "xy"
    left: float = LEFT


def on_crest(edge: Array, stage: str, at: float) -> float:
    """Of the shortened slope: the crest, 10 m high, is loaded to 11 kPa at the load parameter 1."""
    return P0 + at * 10e3 if stage == "crest_load" and np.all(np.abs(edge[:, 1] - 10) < 1e-6) else P0


def in_hole(edge: Array, stage: str, at: float) -> float:
    """Of the cavity: nine tenths of 200 kPa are taken off the hole, whose radius is 0.5 m."""
    inside = stage == "contraction" and np.all(np.hypot(edge[:, 0], edge[:, 1]) < 0.51)
    return 200e3 * (1 - 0.9 * at) if inside else 200e3


TUNNEL = ["gravity.uniform_step=0.1", "mesh.size_opening=2.5 m", "mesh.size_far=8 m", "stage[1].steps=4"]
COARSE_TUNNEL = [
    "mesh.size_far=17 m",
    "column.elements=5",
    GRAVITY,
    "stage[1].steps=1",
    "stage[1].move[0].area=-0.25 %",
]
LOSS = ("volume_loss",)  # in gravity the opening is pressed by tractions whose sum is not computed here
ONE = ["packing.variety=1", "packing.candidates=1"]
GRIDS: dict[str, Short] = {
    "wall": Short([SAND, "mesh.columns=[4]", "mesh.rows=[2]", GRAVITY, "stage[1].steps=8", "stage[1].move[0].x=-8 mm"]),
    "trapdoor": Short(
        [SAND, "mesh.columns=[3, 4, 3]", "mesh.rows=[4]", GRAVITY, "stage[1].steps=4", "stage[1].move[0].y=-4 mm"]
    ),
    "footing": Short(
        [SAND, "mesh.columns=[2, 5]", "mesh.rows=[5]", GRAVITY, "stage[1].steps=4", "stage[1].move[0].y=-8 mm"]
    ),
    "slope": Short(
        [
            *(SAND, *ONE, "gravity.ratio=2", "gravity.uniform_step=0.5"),
            *("stage[1].steps=2", "stage[1].press[0].pressure=11 kPa"),
        ],
        on_crest,
    ),
    "biaxial_scene": Short(
        [YADE, "mesh.columns=[1]", "mesh.rows=[2]", "stage[0].steps=10", "stage[0].move[0].y=-1 mm"],
        axes="y",
    ),
    "cavity": Short(
        [
            *(SAND, "mesh.columns=[3]", "mesh.rows=[6]", "mesh.ratio=1.8"),
            *("stage[0].steps=4", "stage[1].steps=4", "stage[1].move[0].area=4 %"),
        ],
        in_hole,
        stages=("contraction",),
    ),
    "trench": Short(
        [
            *(SAND, *ONE, "mesh.columns=[2, 1, 4]", "mesh.rows=[2, 1, 1, 1, 1]", GRAVITY),
            *("stage[1].steps=2", "stage[2].steps=2", "stage[3].steps=2"),
        ],
        heavier=lambda at: 24e3 if 1 < at[0] < 1.2 and at[1] > 4 else 20e3,
        stages=("gravity",),  # of the sum behind it, expected_short.csv has the reaction of the base
    ),
    "infinite_slope": Short(
        [
            *(SAND, 'mesh.x=["0 m", "8 m"]', "mesh.columns=[8]", "mesh.rows=[2]", GRAVITY),
            *("stage[1].steps=4", "stage[1].tilt=20 deg", 'record[0].point=["4 m", "1 m"]'),
        ]
    ),
}
TUNNELS: dict[str, Short] = {
    "tunnel_scene": Short([SAND, "packing.variety=1", *TUNNEL, "stage[1].move[0].area=-1 %"], stages=LOSS),
    "full_tunnel": Short(
        [
            *(TWO_SANDS, "packing.variety=2", "packing.candidates=2", "mesh.width=40 m"),
            *("mesh.size_opening=2.5 m", *COARSE_TUNNEL),
        ],
        stages=LOSS,
    ),
    "layers": Short(
        [
            *(LOOSE_SAND, "packing.candidates=1", f"region[0].packing.file={GRAVEL_FILE}"),
            *("mesh.width=8 m", "mesh.size_opening=2 m", *COARSE_TUNNEL),
        ],
        heavier=lambda at: 21e3 if at[1] < 19 else 19e3,
        stages=LOSS,
    ),
}


def scenes() -> list[str]:
    """Names of all cases of kind "scene"."""
    cases = sorted(path.parent for path in (ROOT / "cases").glob("*/case.toml"))
    return [folder.name for folder in cases if 'kind = "scene"' in (folder / "case.toml").read_text()]


def check_scene(case: str, short: Short) -> None:
    check((ROOT / "cases" / case / "README.md").exists(), f"cases/{case} has no README.md")
    results = fresh(f"results_{case}")
    run(command(case, results, [*short.settings, "packing.folder=packings"]))
    check_expected(results, ROOT / "cases" / case / "expected_short.csv")
    worst = check_balance(balances(results, short.pressure, short.heavier, short.stages), short.left, short.axes)
    print(f"cases/{case}: ran; at most {worst:.1e} of the reactions are left of the sum of forces")
