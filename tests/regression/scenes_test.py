"""Every case of kind "scene" is checked and run, shortened, with grains that are always the same.

Each must give its expected_short.csv, and its reactions, weights and loads must add up to nothing. biaxial_scene and
biaxial_bvp are one problem and must give the same bits; tunnel_scene must give the numbers of tunnel_quick.
"""

from collections.abc import Callable
from dataclasses import dataclass

import h5py
import numpy as np
from equilibrium import Array, Pressure, balances, check_balance
from expected import check_expected
from fixed_packings import LOOSE_SAND, SAND, YADE, packing_file
from program import ROOT, check, command, fresh, run, table

GRAVITY = "gravity.uniform_step=0.2"
P0 = 1e3  # packing.pressure of the scenes with gravity [Pa]
# What may be left of the sum of all forces, over the sum of the reactions' magnitudes. Newton's method lets a residual
# of 1e-3 of the loads stand, of which the sum sees a part; the most that was measured is 4.6e-4 (wall, in gravity).
LEFT = 1e-3


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


def opening_at_rest(unit_weight: float, surface: float, top: float) -> Pressure:
    """Of tunnels: below the surface and in gravity, the vertical stress of the ground at rest."""

    def pressure(edge: Array, stage: str, at: float) -> float:
        inside = np.all(edge[:, 1] < surface - 1e-6)
        return P0 + (at * unit_weight * (top - edge[1, 1]) if inside and stage == "gravity" else 0.0)

    return pressure


GRAVEL_FILE = packing_file("packings/cpg_d_400")
TWO_SANDS = f'packing.file=["{packing_file("packings/cps_d_150")}", "{packing_file("packings/cps_md_150")}"]'
TUNNEL = ["mesh.size_opening=2.5 m", "mesh.size_far=8 m", "gravity.uniform_step=0.1", "stage[1].steps=4"]
COARSE_TUNNEL = [
    "mesh.size_opening=2.5 m",
    "mesh.size_far=17 m",
    "column.elements=5",
    GRAVITY,
    "stage[1].steps=1",
    "stage[1].move[0].area=-0.25 %",
]
SHORT: dict[str, Short] = {
    "wall": Short([SAND, "mesh.columns=[4]", "mesh.rows=[2]", GRAVITY, "stage[1].steps=8", "stage[1].move[0].x=-8 mm"]),
    "trapdoor": Short(
        [SAND, "mesh.columns=[3, 4, 3]", "mesh.rows=[4]", GRAVITY, "stage[1].steps=4", "stage[1].move[0].y=-4 mm"]
    ),
    "footing": Short(
        [SAND, "mesh.columns=[2, 5]", "mesh.rows=[5]", GRAVITY, "stage[1].steps=4", "stage[1].move[0].y=-8 mm"]
    ),
    "full_tunnel": Short(
        [TWO_SANDS, "packing.variety=2", "packing.candidates=2", "mesh.width=40 m", *COARSE_TUNNEL],
        opening_at_rest(20e3, 35.0, 35.0),
        stages=("volume_loss",),
    ),
    "layers": Short(
        [
            LOOSE_SAND,
            "packing.candidates=1",
            f"region[0].packing.file={GRAVEL_FILE}",
            "mesh.width=8 m",
            *COARSE_TUNNEL,
            "mesh.size_opening=2 m",
        ],
        heavier=lambda at: 21e3 if at[1] < 19 else 19e3,
        stages=("volume_loss",),
    ),
    "slope": Short(
        [
            SAND,
            "packing.variety=1",
            "packing.candidates=1",
            "gravity.ratio=2",
            "gravity.uniform_step=0.5",
            "stage[1].steps=2",
            "stage[1].press[0].pressure=11 kPa",
        ],
        on_crest,
    ),
    "tunnel_scene": Short([SAND, "packing.variety=1", *TUNNEL, "stage[1].move[0].area=-1 %"], stages=("volume_loss",)),
    "biaxial_scene": Short(
        [YADE, "mesh.columns=[1]", "mesh.rows=[2]", "stage[0].steps=10", "stage[0].move[0].y=-1 mm"], axes="y"
    ),
    "cavity": Short(
        [
            SAND,
            "packing.pressure=200 kPa",
            "mesh.columns=[3]",
            "mesh.rows=[6]",
            "mesh.ratio=1.8",
            "stage[0].steps=4",
            "stage[1].steps=4",
            "stage[1].move[0].area=4 %",
        ]
    ),
    "infinite_slope": Short(
        [
            SAND,
            'mesh.x=["0 m", "8 m"]',
            "mesh.columns=[8]",
            "mesh.rows=[2]",
            GRAVITY,
            "stage[1].steps=4",
            "stage[1].tilt=20 deg",
            'record[0].point=["4 m", "1 m"]',
        ]
    ),
}


def same_bits() -> None:
    """The built-in kind and its scene, on lengths whose binary fractions are exact, so that both move the top alike."""
    built_in, scene = fresh("same_built_in"), fresh("same_scene")
    for case, folder, settings in (
        (
            "biaxial_bvp",
            built_in,
            ["columns=1", "rows=2", "width=0.0625 m", "height=0.125 m", "strain=1.5625 %", "strain_step=0.09765625 %"],
        ),
        (
            "biaxial_scene",
            scene,
            [
                "mesh.columns=[1]",
                "mesh.rows=[2]",
                'mesh.x=["0 m", "0.0625 m"]',
                'mesh.y=["0 m", "0.125 m"]',
                "stage[0].steps=16",
                "stage[0].move[0].y=-0.001953125 m",
            ],
        ),
    ):
        run(command(case, folder, [YADE, *(s if s.startswith(("mesh", "stage")) else f"{case}.{s}" for s in settings)]))
    first, second = table(built_in), table(scene)[1:]  # a scene's table begins with its first state
    check(len(first) == len(second) == 16, "the two runs have other increments")
    for one, other in zip(first, second, strict=True):
        for name in ("evaluations", "residual", "particle_steps"):
            check(
                one[name] == other[name], f"increment {one['index']}: {name} is {one[name]}, in the scene {other[name]}"
            )
        files = [folder / "increments" / f"{row['index']:04d}.h5" for folder, row in ((built_in, one), (scene, other))]
        with h5py.File(files[0]) as a, h5py.File(files[1]) as b:
            for name in ("gauss/stress", "gauss/strain", "node/displacement", "node/reaction"):
                check(np.array_equal(a[name][()], b[name][()]), f"increment {one['index']}: {name} has other bits")
        # Sums of the same reactions in another order.
        check(abs(one["axial_force"] / -other["reaction_top_y"] - 1) < 1e-12, "another force on the top")
    print("biaxial_scene has the bits of biaxial_bvp")


if __name__ == "__main__":
    same_bits()
    for folder in sorted(path.parent for path in (ROOT / "cases").glob("*/case.toml")):
        case = folder.name
        if 'kind = "scene"' not in (folder / "case.toml").read_text():
            continue
        check((folder / "README.md").exists(), f"cases/{case} has no README.md")
        check(case in SHORT, f"cases/{case} is run by no test")
        short, results = SHORT[case], fresh(f"results_{case}")
        run(command(case, results, [*short.settings, "packing.folder=packings"]))
        check_expected(results, folder / "expected_short.csv")
        worst = check_balance(balances(results, short.pressure, short.heavier, short.stages), short.left, short.axes)
        print(f"cases/{case}: ran; at most {worst:.1e} of the reactions are left of the sum of forces")
