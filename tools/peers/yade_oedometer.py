# Yade runs this file (yade -j1 -x -n yade_oedometer.py FOLDER): it reads FOLDER/oedometer.json and writes
# FOLDER/yade.json. The packing comes to rest at the pressure, and is then compressed along y without lateral strain,
# once at each inertial number. Names without an import are Yade's.
import json
import math
import statistics
import sys
from pathlib import Path

from yade_discs import DEPTH, MODULUS, engines, mass_of, place

folder = Path(sys.argv[-1])
task = json.loads((folder / "oedometer.json").read_text())
pressure, end = task["pressure"], task["end"]
place(task)
diameter = 2 * statistics.fmean(task["radius"])
mass = statistics.fmean(mass_of(r) for r in task["radius"])
stiffness = MODULUS * diameter / 2 / DEPTH  # about that of a packing of four contacts a grain [Pa]
servo_time = 400 * O.dt
fastest = 0.05  # rate of the servo [1/s]
calls_at_rest = 20  # calls of the servo between two looks at the unbalanced force
rows = []


def stress():
    tensor = getStress()
    return -tensor[0, 0], -tensor[1, 1], -0.5 * (tensor[0, 1] + tensor[1, 0])


def rest():
    """One call of the servo that holds the isotropic pressure; ends the run when the packing is at rest."""
    now = stress()[:2]
    rates = [max(-fastest, min(fastest, (s - pressure) / (stiffness * servo_time))) for s in now]
    O.cell.velGrad = Matrix3(rates[0], 0, 0, 0, rates[1], 0, 0, 0, 0)
    rest.calls += 1
    held = max(abs(s - pressure) for s in now) < 5e-3 * pressure
    if rest.calls % calls_at_rest == 0 and held and unbalancedForce(useMaxForce=False) < 1e-4:
        O.pause()


def compress():
    """Notes the stress, and keeps the inertial number while the stress grows."""
    xx, yy, xy = stress()
    rows.append((xx, yy, xy))
    rate = compress.inertial_number / math.sqrt(mass / (max(0.5 * (xx + yy), 0.3 * pressure) * DEPTH))
    O.cell.velGrad = Matrix3(0, 0, 0, 0, -rate, 0, 0, 0, 0)
    if yy > end:
        O.pause()


def drive(command, period, most_steps):
    """Runs until the command pauses the run. Returns whether it did so."""
    O.engines = [*engines(collider)[:-1], PyRunner(command=command, iterPeriod=period), *engines(collider)[-1:]]
    start = O.iter
    O.run(most_steps, True)
    return O.iter - start < most_steps


def coordination():
    """Contacts per grain times two."""
    return 2.0 * sum(1 for i in O.interactions if i.isReal and i.phys.normalForce.norm() > 0) / len(O.bodies)


collider = InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=0.06 * diameter)
rest.calls = 0
if not drive("rest()", 20, 300000):
    sys.exit("the packing did not come to rest")
answer = {"coordination": coordination(), "unbalanced": unbalancedForce(useMaxForce=False), "curves": {}}
state = str(folder / "rest.yade.gz")
O.save(state)
for number in task["inertial_numbers"]:
    O.load(state)
    collider = O.engines[1]
    rows, compress.inertial_number = [], number
    drive("compress()", 5, 4000000)
    answer["curves"][str(number)] = rows
(folder / "yade.json").write_text(json.dumps(answer))
