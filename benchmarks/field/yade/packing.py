# Disks (spheres that keep to a plane) with linear springs and friction in a periodic cell that shrinks at constant rates.
# yade -n -x packing.py, run by ../run.py with the environment variables START (a start.csv), OUT, STEPS, EVERY, DT, KN [N/m],
# FRICTION, DENSITY, RATE_X, RATE_Y [1/s] (compression positive). SI; the spheres have the masses of disks of depth 1 m.
import math
import os

from yade import *

setting = {name: os.environ[name] for name in ("START", "OUT", "STEPS", "EVERY", "DT", "KN", "FRICTION", "DENSITY", "RATE_X", "RATE_Y")}
lines = open(setting["START"]).read().splitlines()
words = lines[0].split()
width, height = float(words[3]), float(words[6])
grains = [[float(word) for word in line.split(",")[:3]] for line in lines[2:]]
depth = 8 * max(radius for _, _, radius in grains)  # of the cell; nothing lies above or below a disk
O.periodic = True
O.cell.setBox(width, height, depth)
kn, friction = float(setting["KN"]), float(setting["FRICTION"])
O.materials.append(FrictMat(young=1e7, poisson=0.3, frictionAngle=math.atan(friction), density=1000))
for x, y, radius in grains:
    body = O.bodies[O.bodies.append(sphere((x, y, depth / 2), radius))]
    body.state.blockedDOFs = "zXY"
    body.state.mass = float(setting["DENSITY"]) * math.pi * radius**2
    inertia = body.state.mass * radius**2 / 2
    body.state.inertia = (inertia, inertia, inertia)
O.dt = float(setting["DT"])
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=1e-4),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom()],
        [Ip2_FrictMat_FrictMat_FrictPhys(kn=MatchMaker(algo="val", val=kn), ks=MatchMaker(algo="val", val=2 / 7 * kn))],
        [Law2_ScGeom_FrictPhys_CundallStrack()],
    ),
    NewtonIntegrator(damping=0.2),
]
O.cell.velGrad = Matrix3(-float(setting["RATE_X"]), 0, 0, 0, -float(setting["RATE_Y"]), 0, 0, 0, 0)
every = int(setting["EVERY"])
with open(setting["OUT"] + ".txt", "w") as rows, open(setting["OUT"] + ".pairs", "w") as pairs:
    for _ in range(int(setting["STEPS"]) // every):
        O.run(every, True)
        size, stress = O.cell.size, getStress()
        touching = [(i.id1, i.id2) for i in O.interactions if i.phys.normalForce.norm() > 0]
        rows.write(f"{size[0]:.9g} {size[1]:.9g} {-stress[0, 0] * depth:.9g} {-stress[1, 1] * depth:.9g} {kineticEnergy():.9g}\n")
        pairs.write(" ".join(f"{a},{b}" for a, b in touching) + "\n")
os._exit(0)
