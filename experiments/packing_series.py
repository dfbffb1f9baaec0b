"""What the series of runs have in common: one setting varied, their means over windows of packing
fraction and over seeds, a CSV file and a picture of it. Needs only Python's standard library, and Matplotlib to draw."""
import csv
import json
import statistics
import subprocess

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999999")


def run(program, case, directory, settings):
    """Runs the case with the settings, unless it is done; returns its rows and its record. A run may give up on the way."""
    info = directory / "run.json"
    if not (info.exists() and json.loads(info.read_text())["state"] in ("done", "failed")):
        command = [program, "run", str(case), "-o", str(directory), "--force", "--quiet", "-j", "1",
                   "--set", "output.vtk=false", "--set", "output.report=false"]
        for key, value in settings.items():
            command += ["--set", f"{key}={value}"]
        if subprocess.run(command, stdout=subprocess.DEVNULL).returncode not in (0, 3):
            raise SystemExit(f"{directory}: the run failed")
    with open(directory / "series.csv", newline="") as file:
        rows = [{key.split("[")[0]: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    return rows, json.loads(info.read_text())


def write(path, records):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(records[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows({k: f"{v:.4g}" if isinstance(v, float) else v for k, v in record.items()} for record in records)


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def stress(row):
    """Vertical stress [MPa], mean of top and bottom."""
    return (row["stress_bottom"] + row["stress_top"]) / 2e6


def window(rows, phi, low, high):
    """Means over the rows with low <= phi < high; None where the run has none."""
    inside = [row for row in rows[1:] if low <= row[phi] < high]
    if not inside:
        return None
    mean = lambda key: statistics.mean(row[key] for row in inside)
    vertical = statistics.mean(map(stress, inside))
    return {"stress_MPa": vertical, "side_over_vertical": mean("stress_side") / 1e6 / vertical, "z": mean("z"),
            "bottom_over_top": mean("stress_bottom") / mean("stress_top"), "inertial_number": mean("inertial_number"),
            "sweeps": mean("sweeps"), "overlap_mean": mean("overlap_mean"),
            "overlap_max": max(row["overlap_max"] for row in inside)}


def name_of(labels):
    """Of the runs of a variant, but for their seeds."""
    return "_".join(f"{key}{value:g}" for key, value in labels.items())


def series(program, case, out, variants, seeds, phi, windows):
    """One record for each variant and window: means over the seeds, with the standard deviation of stress and Z.

    A variant is (what its record and the name of its runs say, its settings, the number of seeds or None for all)."""
    records = []
    for labels, settings, count in variants:
        chosen = seeds[:count]
        done = [run(program, case, out / f"{name_of(labels)}_seed{seed}", {**settings, "sample.seed": seed}) for seed in chosen]
        reports = [info["report"] for _, info in done]
        whole = {"steps": statistics.mean(report["steps"] for report in reports),
                 "converged_percent": statistics.mean(100 * report["steps_converged"] / report["steps"] for report in reports),
                 "overlap_worst": max(report["overlap_max"] for report in reports),
                 "memory_MB": max(info["machine"]["peak_memory_bytes"] for _, info in done) / 1e6,
                 "cpu_s": statistics.mean(float(info["cpu_seconds"]) for _, info in done)}
        for low, high in windows:
            found = [w for w in (window(rows, phi, low, high) for rows, _ in done) if w]
            if len(found) < len(done):
                continue
            means = {key: statistics.mean(w[key] for w in found) for key in found[0]}
            means["overlap_max"] = max(w["overlap_max"] for w in found)
            spread = {f"{key}_deviation": statistics.stdev(w[key] for w in found) if len(found) > 1 else float("nan")
                      for key in ("stress_MPa", "z")}
            records.append({**labels, "seeds": len(chosen), f"{phi}_from": low, f"{phi}_to": high, **means, **spread, **whole})
    return records


def draw(path, records, label, phi, axis):
    """Stress and Z over the packing fraction, a line for each variant; bars: standard deviation over the seeds."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.ticker import LogLocator, NullLocator
    plt.rcParams.update({"font.size": 8, "axes.linewidth": 0.6})
    figure, panels = plt.subplots(1, 2, figsize=(7.8, 2.7), layout="constrained")
    names = list(dict.fromkeys(label(record) for record in records))
    for number, (colour, name) in enumerate(zip(COLOURS, names)):
        line = [record for record in records if label(record) == name]
        shift = 0.0015 * (number - (len(names) - 1) / 2)  # so that bars do not hide one another
        x = [(float(r[f"{phi}_from"]) + float(r[f"{phi}_to"])) / 2 + shift for r in line]
        for axes, key in zip(panels, ("stress_MPa", "z")):
            bars = [float(r[f"{key}_deviation"]) for r in line] if int(line[0]["seeds"]) > 1 else None
            axes.errorbar(x, [float(r[key]) for r in line], bars, color=colour, linewidth=0.9, elinewidth=0.6, capsize=1.5,
                          marker="o", markersize=2.5, label=name)
    panels[0].set(xlabel=axis, ylabel="vertical stress $\\sigma$ [MPa]", yscale="log")
    panels[0].yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    panels[0].yaxis.set_major_formatter("{x:g}")
    panels[0].yaxis.set_minor_locator(NullLocator())
    panels[1].set(xlabel=axis, ylabel="coordination number $Z$")
    panels[1].legend(fontsize=6.5, frameon=False, loc="upper left", bbox_to_anchor=(1.01, 1))
    figure.savefig(path, dpi=160, metadata={"Software": None})
