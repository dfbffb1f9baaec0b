#!/usr/bin/env python3
"""Twenty elastic grains to a packing fraction above 0.98: friction, Poisson's ratio, cells, implicit against explicit.

    study.py runs -o DIR [--program PATH]   eighteen runs -> results/runs.csv, agreement.csv, curves.csv
    study.py rate|step|cells|tolerance|poisson -o DIR [--program PATH]
                                            three samples of each setting (rate: and one of 300 grains)
                                            -> results/rate.csv, ..., rate.png, ..., law.csv, law.png
    study.py plot -o DIR                    results/packings.png (four stages, mu = 0 and 0.5), results/curves.png

Pictures need Debian's python3-matplotlib and python3-h5py.

Runs that are already finished in DIR are not run again.
"""
import argparse
import math
import pathlib
import statistics
import sys

HERE = pathlib.Path(__file__).parent
RESULTS = HERE / "results"
sys.path.insert(0, str(HERE.parent))
import packing_series

WINDOWS = ((0.20, 0.28), (0.28, 0.36), (0.36, 0.44))  # strains over which Phi and stress are averaged
PHI_WINDOWS = ((0.82, 0.86), (0.86, 0.90), (0.90, 0.94), (0.94, 0.98))  # of the series
# integrator, cells, friction, Poisson's ratio, implicit time step [us] (0: the stable explicit one)
CASES = [("implicit", 8, 0, 0.45, 5), ("explicit", 8, 0, 0.45, 0), ("implicit", 8, 0.5, 0.45, 5), ("explicit", 8, 0.5, 0.45, 0),
         ("implicit", 16, 0, 0.45, 5), ("explicit", 16, 0, 0.45, 0), ("implicit", 16, 0.5, 0.45, 5),
         ("explicit", 16, 0.5, 0.45, 0), ("implicit", 8, 0, 0.3, 5), ("implicit", 8, 0, 0.3, 1), ("explicit", 8, 0, 0.3, 0),
         ("implicit", 16, 0, 0.3, 5), ("explicit", 16, 0, 0.3, 0), ("implicit", 8, 0, 0.49, 5), ("implicit", 8, 0, 0.49, 2),
         ("explicit", 8, 0, 0.49, 0), ("implicit", 16, 0, 0.49, 5), ("explicit", 16, 0, 0.49, 0)]


def name_of(integrator, cells, friction, poisson, step):
    return f"{integrator}_{cells}_mu{friction:g}_nu{poisson:g}" + (f"_dt{step}" if step not in (0, 5) else "")


def run_case(program, out, integrator, cells, friction, poisson, step):
    settings = {"mpm.integrator": f'"{integrator}"', "mpm.cells": cells, "contact.friction": friction,
                "mpm.poisson_ratio": poisson, "time.step": f'"{step} us"'}
    return packing_series.run(program, HERE / "case.toml", out / name_of(integrator, cells, friction, poisson, step), settings)


def window(rows, low, high):
    """Mean Phi and vertical stress [MPa] (mean of top and bottom) between two strains."""
    inside = [r for r in rows[1:] if low <= r["strain"] < high]
    return (statistics.mean(r["phi"] for r in inside),
            statistics.mean(map(packing_series.stress, inside)))


def summary(rows, info):
    last, body = rows[-1], rows[1:]
    work = last["wall_work"]
    steps = [r["step"] - q["step"] for q, r in zip(rows, body)]
    mean = lambda key: sum(r[key] * n for r, n in zip(body, steps)) / sum(steps)
    return {"state": info["state"], "steps": int(last["step"]), "strain_end": last["strain"],
            "phi_end": last["phi"], "stress_end_MPa": packing_series.stress(last),
            "z_end": last["z"], "least_J": last["least_J"], "iterations": mean("iterations"), "sweeps_per_step": mean("sweeps"),
            "rejected_steps": int(last["rejected_steps"]), "penetration_over_R": max(r["overlap_max"] for r in body),
            "energy_error_over_work": last.get("energy_error", math.nan) / work,
            "dissipation_contact_over_work": last.get("dissipation_contact", math.nan) / work,
            "dissipation_integration_over_work": last.get("dissipation_integration", math.nan) / work,
            "kinetic_over_work": last["kinetic_energy"] / work, "elastic_over_work": last["elastic_energy"] / work,
            "cpu_s": float(info.get("cpu_seconds", "nan"))}


def runs(program, out):
    done, records, curves = {}, [], []
    for case in CASES:
        rows, info = run_case(program, out, *case)
        done[case] = rows
        keys = dict(zip(("integrator", "cells", "friction", "poisson_ratio", "step_us"), case))
        records.append({**keys, **summary(rows, info)})
        curves += [{**keys, "strain": r["strain"], "phi": r["phi"], "stress_MPa": packing_series.stress(r),
                    "z": r["z"]} for r in rows[1::4]]
    agreement = []
    for case, rows in done.items():
        other = ("explicit", *case[1:4], 0)
        if case[0] != "implicit" or other not in done:
            continue
        for low, high in WINDOWS:
            if min(rows[-1]["strain"], done[other][-1]["strain"]) < high - 0.005:
                continue
            (phi, stress), (phi_explicit, stress_explicit) = window(rows, low, high), window(done[other], low, high)
            agreement.append({"cells": case[1], "friction": case[2], "poisson_ratio": case[3], "step_us": case[4], "from": low, "to": high,
                              "phi": phi, "phi_difference": phi_explicit - phi, "stress_MPa": stress,
                              "stress_difference_percent": 100 * (stress_explicit / stress - 1)})
    for name, table in (("runs", records), ("agreement", agreement), ("curves", curves)):
        packing_series.write(RESULTS / f"{name}.csv", table)


def variant(grains=20, cells=8, friction=0, velocity=5, step=5, tolerance=1e-4, poisson=0.45, last=0.44):
    """Its labels, its settings and the number of seeds, as packing_series wants them."""
    settings = {"sample.grains": grains, "mpm.cells": cells, "contact.friction": friction, "mpm.tolerance": tolerance,
                "mpm.poisson_ratio": poisson, "loading.max_strain": last, "loading.wall_velocity": f'"{velocity} m/s"',
                "time.step": f'"{step} us"'}
    labels = {"grains": grains, "cells": cells, "mu": friction, "velocity": velocity, "step_us": step, "tolerance": tolerance,
              "nu": poisson}
    return labels, settings, 1 if grains > 20 else None


SERIES = {
    "rate": [variant(friction=mu, velocity=v, step=dt) for mu in (0, 0.5) for v, dt in ((5, 5), (1.5, 10), (0.5, 10))] +
            [variant(grains=300, velocity=v, step=dt) for v, dt in ((5, 5), (0.5, 10))],
    "step": [variant(velocity=v, step=dt) for v, steps in ((5, (10, 5, 2.5)), (0.5, (20, 10, 5))) for dt in steps],
    "cells": [variant(cells=c, velocity=v, step=dt)
              for v, dt, cells in ((5, 5, (8, 16, 32)), (0.5, 10, (8, 16))) for c in cells],
    "tolerance": [variant(friction=mu, tolerance=t) for mu in (0, 0.5) for t in (1e-3, 1e-4, 1e-5)],
    "poisson": [variant(velocity=0.5, step=10, poisson=nu, last=eps) for nu, eps in ((0.3, 0.56), (0.45, 0.44), (0.49, 0.36))],
}
LABELS = {
    "rate": lambda r: f"{r['grains']} grains, $\\mu$ = {r['mu']}, {r['velocity']} m/s",
    "step": lambda r: f"{r['velocity']} m/s, {r['step_us']} $\\mu$s",
    "cells": lambda r: f"{r['cells']} cells, {r['velocity']} m/s",
    "tolerance": lambda r: f"{r['tolerance']}, $\\mu$ = {r['mu']}",
    "poisson": lambda r: f"$\\nu$ = {r['nu']}",
}


def series(name, program, out):
    table = RESULTS / f"{name}.csv"
    records = packing_series.series(program, HERE / "case.toml", out, SERIES[name], (1, 2, 3), "phi", PHI_WINDOWS)
    packing_series.write(table, records)
    packing_series.draw(RESULTS / f"{name}.png", packing_series.read(table), LABELS[name], "phi", "packing fraction $\\Phi$")
    if name == "rate":
        import plot_study
        plot_study.law({labels["velocity"]: out / f"{packing_series.name_of(labels)}_seed1" for labels, *_ in SERIES["rate"]
                        if labels["grains"] == 300})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", choices=("runs", *SERIES, "plot"))
    parser.add_argument("-o", "--out", type=pathlib.Path, required=True)
    parser.add_argument("--program", default="softgrain")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    RESULTS.mkdir(exist_ok=True)
    if arguments.study == "plot":
        import plot_study
        plot_study.draw(arguments.out)
    elif arguments.study in SERIES:
        series(arguments.study, arguments.program, arguments.out)
    else:
        runs(arguments.program, arguments.out)


if __name__ == "__main__":
    main()
