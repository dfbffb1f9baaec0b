# Two equal spheres that come together along x: Hertz's law as YADE has it. yade -n -x two_spheres.py, run by ../run.py with the
# environment variables OUT (a text file) and DEPTH (largest overlap over R). E* = 1: each sphere has E = 1 - nu^2.
import os

from yade import *

R, nu, depth = 1.0, 0.45, float(os.environ["DEPTH"])
steps = 10000
O.materials.append(FrictMat(young=1 - nu**2, poisson=nu, frictionAngle=0, density=1000))
O.bodies.append([sphere((-R, 0, 0), R), sphere((R, 0, 0), R)])
for body, sign in zip(O.bodies, (1, -1)):
    body.state.blockedDOFs = "xyzXYZ"
    body.state.vel = (sign * depth * R / 2 / steps, 0, 0)
O.dt = 1.0
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=0.1),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_MindlinPhys()], [Law2_ScGeom_MindlinPhys_Mindlin()]),
    NewtonIntegrator(damping=0),
]
with open(os.environ["OUT"], "w") as file:
    for _ in range(steps // 100):
        O.run(100, True)
        distance = (O.bodies[1].state.pos - O.bodies[0].state.pos).norm()
        file.write(f"{2 * R - distance:.9g} {abs(O.forces.f(0)[0]):.9g}\n")
os._exit(0)
