#!/usr/bin/env python3
"""One tablet from elastic, plastic and bonded grains on the same places: density over stress, recovery, energies.

    models.py OUT elastic=RUN plastic=RUN bonded=RUN     writes OUT/models.png and OUT/models.csv
"""
import csv
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import softgrain
from softgrain import measure
from softgrain.plot.style import DOUBLE_COLUMN, GREY, MM, RUN_COLOURS, save, style

RANGE = 0.3  # of the axis of stress [MPa]


def facts(run):
    """What the README's table holds, of one run."""
    series = run.series
    load = measure.vertical_stress(series)
    pressed = int(np.argmax(load))
    unloaded = pressed + int(np.argmax(load[pressed:] < 0.02 * load[pressed]))
    height, work = series["wall_height"], series["wall_work"]
    return {"phi_at_load": series["phi"][pressed], "phi_in_the_end": series["phi"][-1],
            "axial_recovery": height[unloaded] / height[pressed] - 1,
            "radial_over_axial": series["radial_ratio"][pressed], "bottom_over_top": series["transmission_ratio"][pressed],
            "z_at_load": series["z"][pressed], "z_in_the_end": series["z"][-1],
            "work_under_load": work[pressed], "work_given_back": (work[pressed] - work[unloaded]) / work[pressed],
            "energy_error": np.abs(series["energy_error"]).max() / work[pressed]}


def draw(runs):
    figure = Figure(figsize=(DOUBLE_COLUMN * MM, 62 * MM), layout="constrained")
    left, right = figure.subplots(1, 2)
    for (name, run), colour in zip(runs.items(), RUN_COLOURS):
        series = run.series
        load = measure.vertical_stress(series) / 1e6
        pressed = int(np.argmax(load))
        left.plot(load[: pressed + 1], series["phi"][: pressed + 1], color=colour, label=name)
        left.plot(load[pressed:], series["phi"][pressed:], color=colour, lw=0.7, ls="--")
        right.plot(series["phi"][: pressed + 1], series["z"][: pressed + 1], color=colour, label=name)
        right.plot(series["phi"][pressed:], series["z"][pressed:], color=colour, lw=0.7, ls="--")
    left.plot([], [], color=GREY, lw=0.7, ls="--", label="after the largest load")
    left.set(xlabel="axial stress [MPa]", ylabel=r"relative density $\Phi$", xlim=(0, 1.1 * RANGE))
    right.set(xlabel=r"relative density $\Phi$", ylabel="coordination number $Z$", ylim=(0, None))
    left.legend(loc="lower right")
    return figure


def main(out, named):
    runs = {name: softgrain.Run(Path(path)) for name, path in (word.split("=", 1) for word in named)}
    with style():
        save(draw(runs), Path(out) / "models.png", list(runs.values()))
    table = {name: facts(run) for name, run in runs.items()}
    with open(Path(out) / "models.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["", *runs])
        for key in next(iter(table.values())):
            writer.writerow([key, *(f"{row[key]:.4g}" for row in table.values())])


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
