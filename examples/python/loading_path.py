"""A loading path of one's own: a grain of bonded primaries is squeezed in cycles, each deeper than the one before.

    python3 examples/python/loading_path.py [FIGURE]

Needs the compiled module: export PYTHONPATH=build/release/python. A path is any function of time that gives the rate of the distance
of the walls; it may look at whatever else it knows, such as the last row of the simulation that it drives.
"""

import math
import sys

import numpy as np

import softgrain

CASE = {"grain.radius": "5 mm", "bpm.primaries": 300, "time.step": "1 us"}
PERIOD = 4e-3  # of a cycle [s]
DEPTHS = [0.2e-3, 0.4e-3, 0.6e-3]  # by which the walls come together in each [m]


def cycles(time):
    """d/dt of the distance h0 - A (1 - cos(2 pi t/T))/2, where A is the depth of the cycle [m/s]."""
    depth = DEPTHS[min(int(time / PERIOD), len(DEPTHS) - 1)]
    return -depth * math.pi / PERIOD * math.sin(2 * math.pi * time / PERIOD)


def squeeze(case=CASE, every=40):
    """Distance of the walls [m] and the force between them [N/m], row by row."""
    simulation = softgrain.Simulation(case, motion=cycles, duration=PERIOD * len(DEPTHS))
    rows = [simulation.observe()] + [now.observe() for now in simulation.steps(every=every)]
    return {name: np.array([row[name] for row in rows]) for name in ("time", "wall_height", "force_top", "wall_work")}


def cycle_table(series):
    """For each cycle: how deep it went [m], its largest force [N/m], and the work that it took [J/m]."""
    table = []
    for k in range(len(DEPTHS)):
        within = np.flatnonzero((series["time"] >= PERIOD * (k - 1e-6)) & (series["time"] <= PERIOD * (k + 1 + 1e-6)))
        height, force, work = (series[name][within] for name in ("wall_height", "force_top", "wall_work"))
        table.append((height[0] - height.min(), force.max(), work[-1] - work[0]))
    return table


def draw(series, path):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(4.5, 3), layout="constrained")
    axes.plot(1e3 * (series["wall_height"][0] - series["wall_height"]), series["force_top"], color="k", lw=0.8)
    axes.set(xlabel="approach of the walls (mm)", ylabel="force (N/m)")
    figure.savefig(path)


def main(*arguments):
    series = squeeze()
    for depth, force, work in cycle_table(series):
        print(f"down by {1e3 * depth:.2f} mm: at most {force:.0f} N/m, {1e3 * work:.1f} mJ/m not given back")
    if arguments:
        draw(series, arguments[0])


if __name__ == "__main__":
    main(*sys.argv[1:])
