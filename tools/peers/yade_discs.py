"""Discs of dense coarse sand (the literal set of cases/soils) in Yade. Scripts that Yade runs import this module."""

import math

from yade import *
from yade.utils import *

MODULUS, DENSITY, DEPTH, DAMPING = 3e9, 2650.0, 0.1, 0.3  # Pa, kg/m3, m, -
FRICTION = math.radians(25)


def mass_of(radius):
    return DENSITY * DEPTH * math.pi * radius**2


def place(packing):
    """Puts the packing's discs into a periodic cell: lists `radius`, `x`, `y`, and `width` and `height`, in metres."""
    O.periodic = True
    O.cell.hSize = Matrix3(packing["width"], 0, 0, 0, packing["height"], 0, 0, 0, DEPTH)
    O.materials.append(
        CohFrictMat(
            young=MODULUS,
            poisson=0.5,
            density=DENSITY,
            frictionAngle=FRICTION,
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
        body = O.bodies[O.bodies.append(sphere((x, y, DEPTH / 2), radius))]
        body.state.blockedDOFs = "zXY"
        mass = mass_of(radius)
        body.state.mass, body.state.inertia = mass, Vector3(1, 1, 1) * (0.5 * mass * radius**2)
    smallest = min(packing["radius"])
    O.dt = 0.3 * math.sqrt(mass_of(smallest) / (MODULUS * smallest))


def engines(collider):
    """The engines of one step; `NewtonIntegrator` is the last."""
    return [
        ForceResetter(),
        collider,
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom6D()],
            [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys()],
            [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(always_use_moment_law=True, useIncrementalForm=True)],
        ),
        NewtonIntegrator(damping=DAMPING),
    ]
