"""Scenes on grids, from an own mesh and around a hole are run, shortened; scenes_tunnels_test.py has those of tunnels.

biaxial_scene and biaxial_bvp are one problem, and must have the same bits.
"""

import h5py
import numpy as np
from fixed_packings import YADE
from program import check, command, fresh, run, table
from scene_runs import GRIDS, TUNNELS, check_scene, scenes


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
    missing = set(scenes()) - set(GRIDS) - set(TUNNELS)
    check(not missing, f"run by no test: {', '.join(sorted(missing))}")
    same_bits()
    for name, short in GRIDS.items():
        check_scene(name, short)
