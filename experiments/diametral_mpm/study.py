#!/usr/bin/env python3
"""The elastic grain between walls: how near to Johnson and to converged finite elements, and on what does it depend?

    study.py small  -o DIR [--program PATH]   slow, to d/R = 0.06, 8 to 64 cells      -> results/small.csv
    study.py large  -o DIR [--program PATH]   laws and cells, to d/R = 0.345          -> large.csv, convergence.csv, stress.csv,
                                              curves.csv
    study.py step   -o DIR [--program PATH]   the same curve with steps x1, x4, x16   -> step.csv
    study.py motion --tests PATH              collision of two disks, bar on a wall, from the verification tests
                                              -> collision.csv, bar.csv

Needs only Python's standard library. Runs that are already finished in DIR are not run again.
"""
import argparse
import csv
import math
import pathlib
import re
import statistics
import subprocess
import sys

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE.parent))
import packing_series

RESULTS = HERE / "results"
RADIUS, YOUNG, POISSON = 5e-3, 10e6, 0.45
PLANE_STRAIN = YOUNG / (1 - POISSON ** 2)  # E*
# converged finite elements, neo-Hookean, 54 cells across: F/(E* R) at d/R
REFERENCE = {0.01: 0.00447, 0.02: 0.01028, 0.03: 0.01681, 0.05: 0.03168, 0.1: 0.07839, 0.2: 0.21604, 0.3: 0.43801,
             0.345: 0.57999}
STRAINS = (0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4)


def run(program, directory, settings):
    return packing_series.run(program, HERE / "case.toml", directory, {"output.snapshots": 1, **settings})


def curve(rows):
    """(d/R, F/(E* R)) of each row, mean of both walls."""
    start = rows[0]["wall_height"]
    return [((start - row["wall_height"]) / (2 * RADIUS),
             (row["force_bottom"] + row["force_top"]) / 2 / (PLANE_STRAIN * RADIUS)) for row in rows[1:]]


def at(points, x):
    """Linear between the two points around x; nan beyond the last."""
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if x0 <= x <= x1 * (1 + 1e-9):
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return math.nan


def johnson(approach):
    """x = F/(E* R) with d/R = x/pi (ln(4 pi/x) - 1), by bisection."""
    low, high = 0.0, 1.0
    for _ in range(60):
        x = (low + high) / 2
        low, high = (x, high) if x / math.pi * (math.log(4 * math.pi / x) - 1) < approach else (low, x)
    return low


def write(name, records):
    with open(RESULTS / name, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(records[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows({k: f"{v:.5g}" if isinstance(v, float) else v for k, v in record.items()} for record in records)


def percent(value, reference):
    return 100 * (value / reference - 1)


def small(program, out):
    records = []
    for cells in (8, 16, 32, 64):
        rows, info = run(program, out / f"small_{cells}", {
            "mpm.cells": cells, "loading.wall_velocity": '"0.02 m/s"', "loading.max_strain": 0.062,
            "time.step": '"100 us"'})
        points = curve(rows)
        for approach in (0.005, 0.0075, 0.01, 0.015, 0.02, 0.03, 0.04, 0.05):
            near = [percent(y, johnson(x)) for x, y in points if abs(x / approach - 1) < 0.1]
            value = at(points, approach)
            records.append({
                "cells": cells, "d_over_R": approach, "F_over_EsR": value, "johnson": johnson(approach),
                "error_johnson_percent": percent(value, johnson(approach)),
                "error_reference_percent": percent(value, REFERENCE[approach]) if approach in REFERENCE else math.nan,
                "error_johnson_least_within_10_percent": min(near), "error_johnson_most_within_10_percent": max(near),
                "cpu_s": float(info.get("cpu_seconds", "nan"))})
    write("small.csv", records)


def large(program, out):
    cases = [("neo_hookean", cells) for cells in (8, 12, 16, 24, 32, 48)]
    cases += [("small_strain_hooke", 8), ("small_strain_hooke", 16), ("small_strain_hooke", 32), ("st_venant_kirchhoff", 16)]
    forces, stresses, curves = [], [], []
    for law, cells in cases:
        rows, info = run(program, out / f"{law}_{cells}", {"mpm.law": f'"{law}"', "mpm.cells": cells})
        points = curve(rows)
        walls = max(abs(percent(r["force_top"], r["force_bottom"])) for r in rows[1:] if r["strain"] > 0.01)
        for approach, reference in REFERENCE.items():
            value = at(points, approach)
            forces.append({"law": law, "cells": cells, "d_over_R": approach, "F_over_EsR": value,
                           "error_percent": percent(value, reference) if law == "neo_hookean" else math.nan,
                           "top_against_bottom_percent": walls, "reached_strain": rows[-1]["strain"],
                           "cpu_s": float(info.get("cpu_seconds", "nan"))})
        sigma = [(r["strain"], (r["stress_bottom"] + r["stress_top"]) / 2e6) for r in rows[1:]]
        stresses.append({"law": law, "cells": cells, **{f"sigma_MPa_at_{eps:g}": at(sigma, eps) for eps in STRAINS}})
        if cells == 16:
            curves += [{"law": law, "strain": e, "sigma_MPa": s} for e, s in sigma[::4]]
    write("large.csv", forces)
    write("convergence.csv", convergence({cells: curve(run(program, out / f"neo_hookean_{cells}", {})[0])
                                          for law, cells in cases if law == "neo_hookean"}))
    write("stress.csv", stresses)
    write("curves.csv", curves)


def convergence(curves):
    """Difference of the force to that on the finest grid, at four places (mean over 5 % of d on both sides) and as root mean
    square, and the order p of |difference| ~ spacing^p by least squares of the logarithms."""
    finest = max(curves)
    exact = curves.pop(finest)
    records = []
    for place in (0.05, 0.1, 0.2, 0.3, "all"):
        line = []
        for cells, points in curves.items():
            low, high = (0.05, 0.345) if place == "all" else (0.95 * place, 1.05 * place)
            errors = [percent(y, at(exact, x)) for x, y in points if low <= x <= high]
            error = math.sqrt(statistics.mean(e * e for e in errors)) if place == "all" else statistics.mean(errors)
            line.append({"d_over_R": place, "cells": cells, "spacing_over_R": math.sqrt(math.pi / 14) / cells, "error_percent": error})
        order = statistics.linear_regression([math.log(r["spacing_over_R"]) for r in line],
                                             [math.log(abs(r["error_percent"])) for r in line]).slope
        records += [{**r, "order": order} for r in line]
    return records


def step(program, out):
    base = None
    records = []
    for factor in (1, 4, 16):
        rows, info = run(program, out / f"step_{factor}", {"time.step": f'"{15.625 * factor} us"'})
        points = curve(rows)
        base = base or points
        compared = [(x, percent(y, at(base, x))) for x, y in points if 0.02 <= x <= 0.345]
        tops = [(r["force_top"], r["force_bottom"]) for r, (x, _) in zip(rows[1:], points) if 0.02 <= x]
        records.append({"step_us": 15.625 * factor, "steps": len(points),
                        "worst_difference_percent": max(abs(c) for _, c in compared),
                        "worst_beyond_0.05_percent": max(abs(c) for x, c in compared if x > 0.05),
                        "worst_top_against_bottom_percent": max(abs(percent(a, b)) for a, b in tops),
                        "cpu_s": float(info.get("cpu_seconds", "nan"))})
    write("step.csv", records)


def motion(tests):
    output = subprocess.run([tests, "--test-case=two soft disks*,what backward Euler*,an elastic bar*", "--success=false"],
                            capture_output=True, text=True, check=True).stdout
    for name in ("collision", "bar"):
        records = [dict(pair.split("=") for pair in line.split()) for line in re.findall(rf"{name}: (.*)", output)]
        write(f"{name}.csv", records)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", choices=("small", "large", "step", "motion"))
    parser.add_argument("-o", "--out", type=pathlib.Path)
    parser.add_argument("--program", default="softgrain")
    parser.add_argument("--tests", default="test_verification")
    arguments = parser.parse_args()
    if arguments.study == "motion":
        motion(arguments.tests)
        return
    if arguments.out is None:
        parser.error(f"{arguments.study} needs -o DIR")
    arguments.out.mkdir(parents=True, exist_ok=True)
    RESULTS.mkdir(exist_ok=True)
    {"small": small, "large": large, "step": step}[arguments.study](arguments.program, arguments.out)


if __name__ == "__main__":
    main()
