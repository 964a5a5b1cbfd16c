# Yade runs this file (yade -j1 -x -n yade_packing.py FOLDER): it reads FOLDER/packing.json and writes FOLDER/yade.json.
# Names without an import are Yade's.
import json
import math
import statistics
import sys
import time
from pathlib import Path

folder = Path(sys.argv[-1])
packing = json.loads((folder / "packing.json").read_text())
settle, steps, repetitions = packing["settle"], packing["steps"], packing["repetitions"]

O.periodic = True
O.cell.hSize = Matrix3(packing["width"], 0, 0, 0, packing["height"], 0, 0, 0, 0.1)
friction = math.radians(25)
O.materials.append(
    CohFrictMat(
        young=3e9,
        poisson=0.5,
        density=2650,
        frictionAngle=friction,
        isCohesive=False,
        momentRotationLaw=True,
        alphaKr=1.0,
        alphaKtw=0.0,
        etaRoll=0.6,
        etaTwist=0.0,
        normalCohesion=0,
        shearCohesion=0,
    )
)
for radius, x, y in zip(packing["radius"], packing["x"], packing["y"]):
    body = O.bodies[O.bodies.append(sphere((x, y, 0.05), radius))]
    body.state.blockedDOFs = "zXY"
    mass = 2650 * 0.1 * math.pi * radius**2
    body.state.mass, body.state.inertia = mass, Vector3(1, 1, 1) * (0.5 * mass * radius**2)

smallest = min(packing["radius"])
O.dt = 0.3 * math.sqrt(2650 * 0.1 * math.pi * smallest**2 / (3e9 * smallest))
collider = InsertionSortCollider([Bo1_Sphere_Aabb()])
newton = NewtonIntegrator(damping=0.3)
O.engines = [
    ForceResetter(),
    collider,
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom6D()],
        [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys()],
        [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(always_use_moment_law=True, useIncrementalForm=True)],
    ),
    newton,
]


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
