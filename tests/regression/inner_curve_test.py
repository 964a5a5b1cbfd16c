"""A curve inside the ground: the face of a pit is held while the pit is dug out, moves into it and is released, and so
is a point. `check` names both, the table has their forces, and with the forces of all other supports they balance the
ground. Two regions share one table. Nodes that are pulled are counted once."""

from pathlib import Path

import h5py
import numpy as np
from program import PROGRAM, check, fresh, run, table

COLUMNS, ROWS = 4, 3  # elements of 1 m
CASE = """
kind = "scene"
title = "face"
material = "linear_elastic"
gravity = {uniform_step = 0.5, ratio = 3}
mesh = {file = "face.msh"}
support = [{boundary = "base", fix = "xy"}, {boundary = ["axis", "right"], fix = "x"}]
record = [{name = "strut", point = ["4 m", "1 m"]}, {name = "corner", point = ["4 m", "3 m"]}]
region = [{name = ["sand", "pit"]}, {name = "wall", elastic = {modulus = "1 GPa", poisson = 0.2}}]
stage = [
  {name = "weight", gravity = 1},
  {name = "dig", steps = 1, excavate = [{region = "pit"}], move = [{boundary = "face", x = "0 m"}]},
  {name = "yield", steps = 2, move = [{boundary = "face", x = "-1 mm"}, {point = ["4 m", "1 m"], y = "0 m"}]},
  {name = "free", steps = 2, release = [{boundary = "face"}, {point = ["4 m", "1 m"]}]},
]
"""


def node(x, y):
    return 1 + x + (COLUMNS + 1) * y


def mesh():
    """A rectangle in the format 2.2 of Gmsh: the pit on the left of the curve "face", a wall on its right."""
    groups = ["1 1 axis", "1 2 base", "1 3 right", "1 4 face", "2 5 sand", "2 6 pit", "2 7 wall"]
    elements: list[tuple[int, ...]] = [
        *((1, node(0, y), node(0, y + 1)) for y in range(ROWS)),
        *((2, node(x, 0), node(x + 1, 0)) for x in range(COLUMNS)),
        *((3, node(COLUMNS, y), node(COLUMNS, y + 1)) for y in range(ROWS)),
        (4, node(2, ROWS - 1), node(2, ROWS)),
    ]
    for x in range(COLUMNS):
        for y in range(ROWS):
            group = 5 if y < ROWS - 1 or x == COLUMNS - 1 else 6 if x < COLUMNS - 2 else 7
            elements.append((group, node(x, y), node(x + 1, y), node(x + 1, y + 1), node(x, y + 1)))
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    lines += ['{} {} "{}"'.format(*group.split()) for group in groups]
    lines += ["$EndPhysicalNames", "$Nodes", str((COLUMNS + 1) * (ROWS + 1))]
    lines += [f"{node(x, y)} {x} {y} 0" for y in range(ROWS + 1) for x in range(COLUMNS + 1)]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    for number, (group, *nodes) in enumerate(elements, 1):
        kind = 1 if len(nodes) == 2 else 3
        lines.append(f"{number} {kind} 2 {group} {group} {' '.join(map(str, nodes))}")
    return "\n".join([*lines, "$EndElements", ""])


Path("face.msh").write_text(mesh())
Path("face.toml").write_text(CASE)

said = run([PROGRAM, "check", "face.toml"]).stdout
for text in (
    "face inside the ground (3 nodes)",
    "held: base xy, axis x, right x, face x; pit is dug out",
    "the point (4, 1) m y",
    "face moves: by (-0.001, 0) m",
    "the point (4, 1) m is released by 100 %",
    "region sand: ",
    "region pit: ",
):
    check(text in said, f"check does not say '{text}':\n{said}")

folder = fresh("face")
done = run([PROGRAM, "run", "face.toml", "-o", str(folder)])
check("region[1].elastic" not in done.stdout + done.stderr, "the wall has its own modulus, which counts")

ends = {row["stage"]: row for row in table(folder) if row["load_parameter"] == 1}
for stage in ("dig", "yield"):
    row = ends[stage]
    held = [row[f"reaction_{name}_x"] for name in ("axis", "base", "right", "face")]
    check(abs(sum(held)) < 1e-3 * max(map(abs, held)), f"{stage}: the reactions along x are {held}")
check(ends["dig"]["reaction_face_x"] > 1e3, "the face of the pit holds the ground behind it")
check(ends["yield"]["reaction_face_x"] < ends["dig"]["reaction_face_x"], "the face bears less when it gives way")
check(abs(ends["yield"]["displacement_face_x"] + 1e-3) < 1e-9, "the face goes into the pit by 1 mm")
check("traction_face_x" not in ends["dig"], "a curve inside the ground has no traction")
check(np.isnan(ends["free"]["reaction_face_x"]) or ends["free"]["reaction_face_x"] == 0, "nothing holds the face")

# A recorded point has the force of what holds it as a point, and with it the reactions along y balance the weights.
row = ends["yield"]
weight = 20e3 * (COLUMNS * ROWS - 2) + 1e3 * (COLUMNS - 2)
check(row["reaction_strut_y"] != 0 and row["reaction_strut_x"] == 0, "the point is held along y, and right owns its x")
check(ends["dig"]["reaction_strut_y"] == 0, "nothing holds the point before")
borne = row["reaction_base_y"] + row["reaction_strut_y"]
check(abs(borne / weight - 1) < 2e-3, f"base and point bear {borne} N/m of {weight} N/m")
check(ends["free"]["reaction_strut_y"] == 0, "nothing holds the point in the end")
check("reaction_corner_y" not in row, "a recorded point that only a boundary holds has no reaction of its own")
with h5py.File(folder / "run.h5") as results:
    place = np.argmin(np.linalg.norm(results["mesh/coordinates"][:] - (4.0, 1.0), axis=1))
with h5py.File(folder / f"increments/{row['index']:04d}.h5") as increment:
    check(increment["node/reaction"][place, 1] == row["reaction_strut_y"], "the field has the same force")

# A square of one element is drawn out upwards between rollers: all its eight nodes are pulled, the corners twice.
Path("square.toml").write_text("""
kind = "scene"
title = "square"
material = "linear_elastic"
mesh = {shape = "grid", x = ["0 m", "1 m"], columns = [1], y = ["0 m", "1 m"], rows = [1]}
region = [{name = "ground", unit_weight = "0 N/m3"}]
support = [{boundary = "base", fix = "y"}, {boundary = ["left", "right"], fix = "x"}]
stage = [{name = "pull", steps = 1, move = [{boundary = "top", y = "1 mm"}, {point = "top_right", y = "1 mm"}]}]
""")
folder = fresh("square")
said = run([PROGRAM, "run", "square.toml", "-o", str(folder)])
check(table(folder)[-1]["tensile_nodes"] == 8, f"{table(folder)[-1]['tensile_nodes']} of 8 nodes are pulled")
counts = {"base": "3 nodes", "left": "3 nodes", "right": "3 nodes", "top": "2 nodes", "top_right": "1 node"}
sentence = ", ".join(f"{name} ({count} at the most)" for name, count in counts.items())
check(f"pulled the ground at {sentence}: " in said.stdout + said.stderr, f"the sides pull at {counts}")
