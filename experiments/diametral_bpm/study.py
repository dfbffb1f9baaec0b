#!/usr/bin/env python3
"""The plastic grain under other conditions: does the plateau collapse on F0/<a0>, and what does it depend on?

    study.py collapse    -o DIR [--program PATH]   3 forces x 2 primary sizes x 4 aggregates -> collapse.csv, curves.csv
    study.py sensitivity -o DIR [--program PATH]   time step, sweeps, density, speed          -> sensitivity.csv

Needs only Python's standard library. Runs that are already finished in DIR are not run again.
"""
import argparse
import csv
import json
import math
import pathlib
import statistics
import subprocess

HERE = pathlib.Path(__file__).parent
PLATEAU = (0.05, 0.35)  # strains between which the plateau is averaged
WINDOW = 0.01           # strain


def run(program, directory, settings):
    """Runs the case with the settings, unless it is done, and returns its rows and its verdict."""
    info = directory / "run.json"
    if not (info.exists() and json.loads(info.read_text())["state"] == "done"):
        command = [program, "run", str(HERE / "case.toml"), "-o", str(directory), "--force", "--quiet"]
        for key, value in settings.items():
            command += ["--set", f"{key}={value}"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    with open(directory / "series.csv", newline="") as file:
        rows = [{key.split("[")[0]: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    return rows, json.loads(info.read_text())


def stress(row):
    return (row["stress_bottom"] + row["stress_top"]) / 2


def envelope(rows, low, high):
    """Rows on the way to a strain that was not reached before, between two strains: without unloading and reloading."""
    farthest, kept = 0, []
    for row in rows[1:]:
        if row["strain"] > farthest:
            farthest = row["strain"]
            if low <= row["strain"] < high:
                kept.append(row)
    return kept


def windows(rows, low, high):
    """Mean stress over windows of strain, along the envelope."""
    bins = {}
    for row in envelope(rows, low, high):
        bins.setdefault(math.floor(row["strain"] / WINDOW), []).append(stress(row))
    return {(k + 0.5) * WINDOW: statistics.mean(v) for k, v in sorted(bins.items())}


def slope(points):
    """Least squares slope of (strain, stress)."""
    x = [p[0] for p in points]
    y = [p[1] for p in points]
    mx, my = statistics.mean(x), statistics.mean(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


def unloading_slope(rows, leg):
    """Between the turn and the strain at which the stress has fallen to a tenth [Pa per unit strain]; nan if too few rows."""
    points = [(row["strain"], stress(row)) for row in rows if row["leg"] == leg]
    carried = [p for p in points if p[1] > 0.1 * points[0][1]] if points else []
    return slope(carried) if len(carried) >= 3 else math.nan


def summary(rows, info):
    loading = [stress(r) for r in envelope(rows, *PLATEAU)]
    start = [(r["strain"], stress(r)) for r in envelope(rows, 0, 0.025)]
    sigma_I = rows[-1]["sigma_I"]
    mean = statistics.mean(loading)
    return {
        "sigma_I_MPa": sigma_I / 1e6,
        "initial_slope_MPa": slope(start) / 1e6,
        "plateau_MPa": mean / 1e6,
        "plateau_over_sigma_I": mean / sigma_I,
        "serration": statistics.stdev(windows(rows, *PLATEAU).values()) / mean,
        "unloading_slope_10_MPa": unloading_slope(rows, 1) / 1e6,
        "unloading_slope_30_MPa": unloading_slope(rows, 3) / 1e6,
        "top_over_bottom": statistics.mean(r["force_top"] for r in rows[1:]) /
                           statistics.mean(r["force_bottom"] for r in rows[1:]),
        "clusters": max(int(r["clusters"]) for r in rows),
        "overlap_mean": statistics.mean(r["overlap_mean"] for r in rows[1:]),
        "overlap_max": max(r["overlap_max"] for r in rows[1:]),
        "sweeps": statistics.mean(r["sweeps"] for r in rows[1:]),
        "energy_error": abs(rows[-1]["energy_error"] / rows[-1]["wall_work"]),
        "cpu_s": info.get("cpu_seconds", math.nan),
    }


def write(path, records):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(records[0]), lineterminator="\n")
        writer.writeheader()
        for record in records:
            writer.writerow({k: f"{v:.5g}" if isinstance(v, float) else v for k, v in record.items()})


def collapse(program, out):
    """The time step follows the period of a bond, sqrt(m a0 / F0)."""
    records, curves = [], []
    for force, step in ((44, 0.35), (100, 0.25), (620, 0.1)):
        for primaries in (1750, 900):
            dt = step * math.sqrt(1750 / primaries)
            for seed in (1, 2, 3, 4):
                name = f"F{force}_N{primaries}_s{seed}"
                rows, info = run(program, out / name, {
                    "bpm.attraction": f'"{force} N/m"', "bpm.primaries": primaries, "sample.seed": seed,
                    "time.step": f'"{dt:.4g} us"', "output.snapshots": 2, "output.vtk": "false", "output.samples": 1500})
                records.append({"F0_N_per_m": force, "primaries": primaries, "seed": seed, **summary(rows, info)})
                curves += [{"F0_N_per_m": force, "primaries": primaries, "seed": seed, "strain": e,
                            "stress_over_sigma_I": s / rows[-1]["sigma_I"]} for e, s in windows(rows, 0, 0.35).items()]
    write(out / "collapse.csv", records)
    write(out / "curves.csv", curves)


def sensitivity(program, out):
    base = {"loading.unload_at": "[]", "loading.max_strain": 0.2, "output.snapshots": 2, "output.vtk": "false",
            "output.samples": 800}
    cases = [("reference", {})]
    cases += [(f"time.step {v} us", {"time.step": f'"{v} us"'}) for v in (0.1, 0.5, 1)]
    cases += [(f"sweeps {v} (fixed)", {"solver.min_sweeps": v, "solver.max_sweeps": v}) for v in (10, 40)]
    cases += [("tolerance 1e-4", {"solver.tolerance": "1e-4"})]
    cases += [("density 7800 kg/m3", {"grain.density": '"7800 kg/m^3"'})]
    cases += [(f"speed {v} m/s", {"loading.wall_velocity": f'"{v} m/s"'}) for v in (0.1, 1)]
    cases += [(f"push-out {v}", {"contact.push_out": v}) for v in (0, 0.2)]
    cases += [("wall friction 0.5", {"contact.wall_friction": 0.5}), ("inner friction 0.3", {"bpm.inner_friction": 0.3})]
    records = []
    for name, settings in cases:
        for seed in (1, 2):
            directory = out / "".join(c if c.isalnum() or c in ".-" else "_" for c in f"{name}_s{seed}")
            rows, info = run(program, directory, {**base, **settings, "sample.seed": seed})
            record = summary(rows, info)
            for key in ("unloading_slope_10_MPa", "unloading_slope_30_MPa"):
                del record[key]
            records.append({"case": name, "seed": seed, **record})
    write(out / "sensitivity.csv", records)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", choices=("collapse", "sensitivity"))
    parser.add_argument("-o", "--out", type=pathlib.Path, required=True)
    parser.add_argument("--program", default="softgrain")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    {"collapse": collapse, "sensitivity": sensitivity}[arguments.study](arguments.program, arguments.out)


if __name__ == "__main__":
    main()
