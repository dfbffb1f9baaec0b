#!/usr/bin/env python3
"""Twenty elastic grains to a packing fraction above 0.98: friction, Poisson's ratio, cells, implicit against explicit.

    study.py runs -o DIR [--program PATH]   eighteen runs -> results/runs.csv, agreement.csv, curves.csv
    study.py plot -o DIR [--program PATH]   results/packings.png (four stages, mu = 0 and 0.5), results/curves.png;
                                            needs Debian's python3-matplotlib and python3-h5py

Runs that are already finished in DIR are not run again.
"""
import argparse
import csv
import json
import math
import pathlib
import statistics
import subprocess

HERE = pathlib.Path(__file__).parent
RESULTS = HERE / "results"
WINDOWS = ((0.20, 0.28), (0.28, 0.36), (0.36, 0.44))  # strains over which Phi and stress are averaged
# integrator, cells, friction, Poisson's ratio, implicit time step [us] (0: the stable explicit one)
CASES = [("implicit", 8, 0, 0.45, 5), ("explicit", 8, 0, 0.45, 0), ("implicit", 8, 0.5, 0.45, 5), ("explicit", 8, 0.5, 0.45, 0),
         ("implicit", 16, 0, 0.45, 5), ("explicit", 16, 0, 0.45, 0), ("implicit", 16, 0.5, 0.45, 5),
         ("explicit", 16, 0.5, 0.45, 0), ("implicit", 8, 0, 0.3, 5), ("implicit", 8, 0, 0.3, 1), ("explicit", 8, 0, 0.3, 0),
         ("implicit", 16, 0, 0.3, 5), ("explicit", 16, 0, 0.3, 0), ("implicit", 8, 0, 0.49, 5), ("implicit", 8, 0, 0.49, 2),
         ("explicit", 8, 0, 0.49, 0), ("implicit", 16, 0, 0.49, 5), ("explicit", 16, 0, 0.49, 0)]


def name_of(integrator, cells, friction, poisson, step):
    return f"{integrator}_{cells}_mu{friction:g}_nu{poisson:g}" + (f"_dt{step}" if step not in (0, 5) else "")


def run(program, directory, settings):
    """Runs the case with the settings, unless it is done, and returns its rows and its record. A run may give up on the way."""
    info = directory / "run.json"
    if not (info.exists() and json.loads(info.read_text())["state"] in ("done", "failed")):
        command = [program, "run", str(HERE / "case.toml"), "-o", str(directory), "--force", "--quiet", "-j", "1",
                   "--set",
                   "output.vtk=false", "--set", "output.report=false"]
        for key, value in settings.items():
            command += ["--set", f"{key}={value}"]
        if subprocess.run(command, stdout=subprocess.DEVNULL).returncode not in (0, 3):
            raise SystemExit(f"{directory}: the run failed")
    with open(directory / "series.csv", newline="") as file:
        rows = [{key.split("[")[0]: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    return rows, json.loads(info.read_text())


def run_case(program, out, integrator, cells, friction, poisson, step):
    settings = {"mpm.integrator": f'"{integrator}"', "mpm.cells": cells, "contact.friction": friction,
                "mpm.poisson_ratio": poisson, "mpm.time_step": f'"{step} us"'}
    return run(program, out / name_of(integrator, cells, friction, poisson, step), settings)


def window(rows, low, high):
    """Mean Phi and vertical stress [MPa] (mean of lid and bottom) between two strains."""
    inside = [r for r in rows[1:] if low <= r["strain"] < high]
    return (statistics.mean(r["phi"] for r in inside),
            statistics.mean((r["stress_bottom"] + r["stress_top"]) / 2e6 for r in inside))


def write(name, records):
    with open(RESULTS / name, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(records[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows({k: f"{v:.4g}" if isinstance(v, float) else v for k, v in record.items()} for record in records)


def summary(rows, info):
    last, body = rows[-1], rows[1:]
    work = last["wall_work"]
    steps = [r["step"] - q["step"] for q, r in zip(rows, body)]
    mean = lambda key: sum(r[key] * n for r, n in zip(body, steps)) / sum(steps)
    return {"state": info["state"], "steps": int(last["step"]), "strain_end": last["strain"],
            "phi_end": last["phi"], "stress_end_MPa": (last["stress_bottom"] + last["stress_top"]) / 2e6,
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
        curves += [{**keys, "strain": r["strain"], "phi": r["phi"], "stress_MPa": (r["stress_bottom"] + r["stress_top"]) / 2e6,
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
    write("runs.csv", records)
    write("agreement.csv", agreement)
    write("curves.csv", curves)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", choices=("runs", "plot"))
    parser.add_argument("-o", "--out", type=pathlib.Path, required=True)
    parser.add_argument("--program", default="softgrain")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    RESULTS.mkdir(exist_ok=True)
    if arguments.study == "plot":
        import plot_study
        plot_study.draw(arguments.out)
    else:
        runs(arguments.program, arguments.out)


if __name__ == "__main__":
    main()
