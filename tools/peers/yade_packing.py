# Yade runs this file (yade -j1 -x -n yade_packing.py FOLDER): it reads FOLDER/packing.json and writes FOLDER/yade.json.
# Names without an import are Yade's.
import json
import statistics
import sys
import time
from pathlib import Path

from yade_discs import engines, place

folder = Path(sys.argv[-1])
packing = json.loads((folder / "packing.json").read_text())
settle, steps, repetitions = packing["settle"], packing["steps"], packing["repetitions"]

place(packing)
collider = InsertionSortCollider([Bo1_Sphere_Aabb()])
O.engines = engines(collider)


def rate(n):
    start = time.perf_counter()
    O.run(n, True)
    return len(O.bodies) * n / (time.perf_counter() - start)


O.run(settle, True)
shear = 1e-3 / (steps * repetitions * O.dt)
O.cell.velGrad = Matrix3(shear, 0, 0, 0, -shear, 0, 0, 0, 0)
tries = []
for skin in (0.03, 0.06, 0.1, 0.2):
    collider.verletDist = skin * 2 * statistics.fmean(packing["radius"])
    O.run(100, True)
    tries.append((rate(1000), skin))
skin = max(tries)[1]
collider.verletDist = skin * 2 * statistics.fmean(packing["radius"])
rates = [rate(steps) for _ in range(repetitions)]
contacts = sum(1 for i in O.interactions if i.isReal)
answer = {"rate": statistics.median(rates), "skin": skin, "coordination": 2.0 * contacts / len(O.bodies)}
(folder / "yade.json").write_text(json.dumps(answer))
