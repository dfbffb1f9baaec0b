#!/usr/bin/env python3
"""What laws of points say of the spheres of a run: Hertz's law, and the law of several contacts of Brodu et al. (2015).

    experiments/hydrogels/laws.py out/hydrogels -o experiments/hydrogels/results

Same spheres at the same places in the same box, no friction, at rest at each height of the piston. Writes forces.csv and
forces.png. Needs NumPy and Matplotlib; PYTHONPATH must name softgrain's Python."""

import argparse
import itertools
from pathlib import Path

import numpy as np

import softgrain

HEIGHTS = 32  # of the piston, evenly in strain
GEOMETRIC_FACTOR = 1.125  # of the law of several contacts: fitted by its authors
STILL, NOTHING = 1e-5, 1e-8  # what may be left on a sphere: of the largest force, of E R^2
MOST_PASSES, UNDER_RELAXATION = 1500, 0.1
SKIN = 0.3  # of a radius: how far apart pairs are kept in mind


class Packing:
    """Spheres between six walls, in units of the mean radius and of Young's modulus."""

    def __init__(self, place, radius, box, nu):
        self.place, self.radius, self.box, self.nu = place.copy(), radius, np.array(box, float), nu
        self.among = np.array(list(itertools.combinations(range(len(radius)), 2)), int).reshape(-1, 2)

    def press(self, height):
        """Moves the piston; what lies below follows."""
        self.place[:, 2] *= height / self.box[2]
        self.box[2] = height

    def find_contacts(self):
        """All that could touch soon, once from each side: sphere a, its partner b (-1 a wall), which wall, the side across."""
        a, b = self.among[np.linalg.norm(self.place[self.among[:, 0]] - self.place[self.among[:, 1]], axis=1)
                          < self.radius[self.among].sum(axis=1) + SKIN].T
        sphere, wall = (index.ravel() for index in np.indices((len(self.radius), 6)))
        axis, top = wall // 2, wall % 2
        distance = np.where(top, self.box[axis] - self.place[sphere, axis], self.place[sphere, axis])
        near = distance < self.radius[sphere] + SKIN
        self.a = np.concatenate([a, b, sphere[near]])
        self.b = np.concatenate([b, a, np.full(near.sum(), -1)])
        self.axis, self.top = axis[near], top[near]
        self.back = np.concatenate([np.arange(len(a)) + len(a), np.arange(len(a)), np.full(near.sum(), -1)])
        order = np.argsort(self.a, kind="stable")
        groups = np.split(order, np.flatnonzero(np.diff(self.a[order])) + 1)
        self.of, self.by = np.array([(j, k) for group in groups for j in group for k in group if j != k], int).reshape(-1, 2).T
        self.grown, self.found_at = np.zeros(len(self.a)), self.place.copy()

    def forces(self, several):
        """Normal forces of all contacts, what they leave on the spheres, and how far contacts are from what others make of them."""
        pairs = len(self.a) - len(self.axis)
        way = np.zeros((len(self.a), 3))
        way[:pairs] = self.place[self.b[:pairs]] - self.place[self.a[:pairs]]
        at = np.arange(pairs, len(self.a))
        centre = self.place[self.a[at], self.axis]
        way[at, self.axis] = np.where(self.top, self.box[self.axis] - centre, -centre)
        distance = np.linalg.norm(way, axis=1)
        normal = way / distance[:, None]
        inner = self.b >= 0
        reach = self.radius[self.a] + self.grown + np.where(inner, self.radius[self.b] + self.grown[self.back], 0)
        overlap = np.maximum(reach - distance, 0)
        curved = np.where(inner, 1 / (1 / self.radius[self.a] + 1 / self.radius[self.b]), self.radius[self.a])
        stiff = np.where(inner, 0.5, 1) / (1 - self.nu**2)
        force = 4 / 3 * stiff * np.sqrt(curved) * overlap**1.5
        growing = 0.0
        if several:
            share = np.where(inner, self.radius[self.a] / (self.radius[self.a] + self.radius[self.b]), 1)
            growing = self.grow(normal, (share * distance)[:, None] * normal, force)
        left = -np.stack([np.bincount(self.a, force * n, len(self.radius)) for n in normal.T], axis=1)
        return force, left, growing

    def grow(self, normal, place, force):
        """Each contact k of a sphere moves the surface at its contact j by what it does to a half-space (Boussinesq), with
        inward normals n and u from k to j:
        (1 + nu) F_k/(2 pi E d) [(n_k . u)(n_j . u) + (3 - 4 nu) n_k . n_j - (1 - 2 nu) (n_k + u) . n_j/(1 + n_k . u)]."""
        n_j, n_k = -normal[self.of], -normal[self.by]
        u = place[self.of] - place[self.by]
        d = np.maximum(np.linalg.norm(u, axis=1), 1e-6)
        u /= d[:, None]
        k_u, j_u, k_j = ((x * y).sum(axis=1) for x, y in ((n_k, u), (n_j, u), (n_k, n_j)))
        bracket = k_u * j_u + (3 - 4 * self.nu) * k_j - (1 - 2 * self.nu) * (k_j + j_u) / np.maximum(1 + k_u, 1e-6)
        inwards = (1 + self.nu) * force[self.by] / (2 * np.pi * d) * bracket
        target = -GEOMETRIC_FACTOR * np.bincount(self.of, inwards, len(force))
        self.grown += UNDER_RELAXATION * (target - self.grown)
        return np.abs(target - self.grown).max(initial=0)

    def relax(self, several):
        """To rest, by FIRE (Bitzek et al. 2006). Returns the force on the piston [E R^2], and what is left over the largest."""
        velocity, dt, mixing, downhill = np.zeros_like(self.place), 0.1, 0.1, 0
        for _ in range(MOST_PASSES):
            if not hasattr(self, "a") or np.abs(self.place - self.found_at).max() > SKIN / 4:
                grown = dict(zip(zip(self.a, self.b, self.walls()), self.grown)) if hasattr(self, "a") else {}
                self.find_contacts()
                self.grown = np.array([grown.get(key, 0.0) for key in zip(self.a, self.b, self.walls())])
            force, left, growing = self.forces(several)
            worst = np.abs(left).max()
            if worst <= max(STILL * force.max(), NOTHING) and growing <= STILL:
                break
            power = (left * velocity).sum()
            if power > 0:
                velocity = (1 - mixing) * velocity + mixing * left * np.linalg.norm(velocity) / np.linalg.norm(left)
                downhill += 1
                if downhill > 5:
                    dt, mixing = min(1.1 * dt, 1.0), 0.99 * mixing
            else:
                velocity[:], dt, mixing, downhill = 0, 0.5 * dt, 0.1, 0
                dt = max(dt, 0.02)
            velocity += dt * left
            self.place += dt * velocity
        on_piston = force[len(self.a) - len(self.axis):][(self.axis == 2) & (self.top == 1)].sum()
        return on_piston, worst / max(force.max(), 1e-300)

    def walls(self):
        """Of each contact the number of its wall; -1 for none."""
        return np.concatenate([np.full(len(self.a) - len(self.axis), -1), 2 * self.axis + self.top])


def spheres_of(run):
    """Places (n, 3) and radii (n,) [m] in a box that begins at 0, its edges, E [Pa] and nu."""
    first = run[0]
    corners = first.surface["walls"].reshape(-1, 3)
    origin = corners.min(axis=0)
    return (first.particles["position"] - origin, first.particles["radius"], np.ptp(corners, axis=0),
            run.case["mpm"]["young_modulus"], run.case["mpm"]["poisson_ratio"])


def forces_of(run, several):
    """Strains, forces on the piston [N], and the largest share of a force that was left."""
    place, radius, box, young, nu = spheres_of(run)
    unit = radius.mean()
    packing = Packing(place / unit, radius / unit, box / unit, nu)
    strains = np.linspace(0, run.series["strain"][-1], HEIGHTS)
    found = []
    for strain in strains:
        packing.press(box[2] / unit * np.exp(-strain))
        found.append(packing.relax(several))
    force, left = np.array(found).T
    return strains, force * young * unit**2, left


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", help="directory of the run")
    parser.add_argument("-o", "--output", required=True, help="where forces.csv and forces.png go")
    options = parser.parse_args()
    run, folder = softgrain.open(options.run), Path(options.output)
    folder.mkdir(parents=True, exist_ok=True)
    strain, hertz, left = forces_of(run, several=False)
    _, several, left_of_several = forces_of(run, several=True)
    series = run.series
    ours = {name: np.interp(strain, series["strain"], series[name]) for name in ("force_top", "force_bottom", "phi", "phi_0", "z")}
    columns = {"strain": strain, "phi_0": ours["phi_0"], "phi": ours["phi"], "force_deformable[N]": (ours["force_top"] + ours["force_bottom"]) / 2,
               "force_hertz[N]": hertz, "force_several_contacts[N]": several, "left_hertz": left, "left_several": left_of_several, "z": ours["z"]}
    with (folder / "forces.csv").open("w") as file:
        file.write(",".join(columns) + "\n")
        file.writelines(",".join(f"{value:.5g}" for value in row) + "\n" for row in zip(*columns.values()))
    draw(columns, folder / "forces.png", run)


def draw(columns, path, run):
    """Force on the piston over packing fraction."""
    from matplotlib.figure import Figure
    from softgrain import plot
    from softgrain.plot.style import BLUE, GREEN, MM, SINGLE_COLUMN, VERMILLION

    with plot.style():
        figure = Figure(figsize=(1.4 * SINGLE_COLUMN * MM, SINGLE_COLUMN * MM), layout="constrained")
        axes = figure.subplots()
        for name, label, colour, dash in (("force_several_contacts[N]", "points, law of several contacts", GREEN, "--"),
                                          ("force_deformable[N]", "deformable spheres", VERMILLION, "-"),
                                          ("force_hertz[N]", "points, Hertz's law", BLUE, ":")):
            axes.plot(columns["phi_0"], columns[name], color=colour, ls=dash, label=label)
        axes.set(xlabel=r"$\Phi_0$, volumes at the start over that of the box", ylabel="force on the piston [N]",
                 xlim=(0.55, None), ylim=(0, None))
        axes.legend(loc="upper left")
        plot.save(figure, path, [run])


if __name__ == "__main__":
    main()
