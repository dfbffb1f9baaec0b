#!/usr/bin/env python3
"""Total against updated Lagrangian, outlines against grid nodes: one grain between walls.

    study.py force -o DIR [--program PATH]   seven runs, about four minutes on one core -> results/force.csv
    study.py gap --tests PATH                distance at which a wall is first felt, from the verification tests
                                             -> results/gap.csv
    study.py plot                            results/formulations.png; needs Debian's python3-matplotlib

Runs that are already finished in DIR are not run again.
"""
import argparse
import csv
import json
import pathlib
import re
import statistics
import subprocess

HERE = pathlib.Path(__file__).parent
RESULTS = HERE / "results"
RADIUS, YOUNG, POISSON = 5e-3, 10e6, 0.45
# converged finite elements, 54 cells across: F/(E* R) at d/R
REFERENCE = {0.01: 0.00447, 0.02: 0.01028, 0.03: 0.01681, 0.05: 0.03168, 0.1: 0.07839, 0.2: 0.21604, 0.3: 0.43801}
WINDOW = 0.05  # rows within 5 % of d are averaged

UPDATED = [(shape, contact) for contact in ("outline", "grid_nodes") for shape in ("bilinear", "gimp", "bspline")]


def run(program, directory, settings):
    """Runs the case with the settings, unless it is done, and returns its rows and its record."""
    info = directory / "run.json"
    if not (info.exists() and json.loads(info.read_text())["state"] == "done"):
        command = [program, "run", str(HERE / "case.toml"), "-o", str(directory), "--force", "--quiet"]
        for key, value in settings.items():
            command += ["--set", f"{key}={value}"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    with open(directory / "series.csv", newline="") as file:
        rows = [{key.split("[")[0]: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    return rows, json.loads(info.read_text())


def force_at(rows, approach):
    """F/(E* R), mean over both walls and over the rows around d/R."""
    start = rows[0]["wall_height"]
    near = [row for row in rows[1:]
            if abs((start - row["wall_height"]) / (2 * RADIUS) - approach) < WINDOW * approach]
    force = statistics.mean((row["force_bottom"] + row["force_top"]) / 2 for row in near)
    return force * (1 - POISSON ** 2) / (YOUNG * RADIUS)


def write(path, records):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(records[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows({k: f"{v:.4g}" if isinstance(v, float) else v for k, v in record.items()} for record in records)


def force(program, out):
    cases = [("total_lagrangian", "fitted", "outline", {})]
    cases += [("updated_lagrangian", shape, contact, {
        "mpm.formulation": '"updated_lagrangian"', "mpm.shape_functions": f'"{shape}"', "mpm.contact_on": f'"{contact}"',
        "time.step": '"0 us"'}) for shape, contact in UPDATED]
    records = []
    for formulation, shape, contact, settings in cases:
        rows, info = run(program, out / f"{formulation}_{shape}_{contact}", settings)
        for approach, reference in REFERENCE.items():
            value = force_at(rows, approach)
            records.append({"formulation": formulation, "shape_functions": shape, "contact_on": contact,
                            "d_over_R": approach, "F_over_EsR": value, "error_percent": 100 * (value / reference - 1),
                            "cpu_s": float(info.get("cpu_seconds", "nan"))})
    write(RESULTS / "force.csv", records)


def gap(tests):
    output = subprocess.run([tests, "--test-case=the force of a wall begins at the outline*", "--success=false"],
                            capture_output=True, text=True, check=True).stdout
    found = re.findall(r"first force: (\w+) (\w+) (\S+) (\S+)", output)
    write(RESULTS / "gap.csv", [{"shape_functions": shape, "contact_on": contact, "least_cells": round(float(least), 3),
                                 "largest_cells": round(float(largest), 3)} for shape, contact, least, largest in found])


def plot():
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams.update({"font.size": 8, "axes.linewidth": 0.6})
    colours = {"fitted": "#000000", "bilinear": "#0072B2", "gimp": "#D55E00", "bspline": "#009E73"}
    names = {"fitted": "total Lagrangian", "bilinear": "bilinear", "gimp": "uGIMP", "bspline": "B-spline"}
    with open(RESULTS / "force.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    figure, axes = plt.subplots(figsize=(3.6, 2.8), layout="constrained")
    axes.axhline(0, color="0.7", linewidth=0.6)
    for shape, contact in [("fitted", "outline"), *UPDATED]:
        line = [row for row in rows if (row["shape_functions"], row["contact_on"]) == (shape, contact)]
        axes.plot([float(row["d_over_R"]) for row in line], [float(row["error_percent"]) for row in line],
                  "o-" if contact == "outline" else "s--", color=colours[shape], markersize=3, linewidth=0.9,
                  label=names[shape] + ("" if contact == "outline" else ", grid nodes"))
    axes.set_xscale("log")
    axes.set_xticks([0.01, 0.03, 0.1, 0.3], ["0.01", "0.03", "0.1", "0.3"])
    axes.set_xlabel("approach $d/R$")
    axes.set_ylabel("error of the force [%]")
    axes.legend(fontsize=6, frameon=False)
    figure.savefig(RESULTS / "formulations.png", dpi=200, metadata={"Software": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", choices=("force", "gap", "plot"))
    parser.add_argument("-o", "--out", type=pathlib.Path)
    parser.add_argument("--program", default="softgrain")
    parser.add_argument("--tests", default="test_verification")
    arguments = parser.parse_args()
    if arguments.study == "force":
        if arguments.out is None:
            parser.error("force needs -o DIR")
        arguments.out.mkdir(parents=True, exist_ok=True)
        force(arguments.program, arguments.out)
    elif arguments.study == "gap":
        gap(arguments.tests)
    else:
        plot()


if __name__ == "__main__":
    main()
