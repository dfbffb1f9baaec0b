#!/usr/bin/env python3
"""How the cost of a packing grows with its grains and with their resolution: CPU time of a step, sweeps, memory.

    packing_scaling.py [--quick]     -> results/packing_scaling.csv, a process for each row; needs the compiled Python module
    packing_scaling.py plot          -> results/packing_scaling.png from it; needs Matplotlib

Each row is the first steps of a uniaxial compaction at 5 m/s from Phi = 0.7, on one thread: what grains cost by themselves (inside bonded
grains all contacts are there from the start; elastic grains meet later, which adds a tenth to a third, see docs/performance.md)."""
import argparse
import csv
import json
import pathlib
import resource
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).parent
TABLE = HERE / "results" / "packing_scaling.csv"
GRAINS = (30, 100, 300, 1000, 3000)
COMMON = {"experiment.loading": "compaction", "loading.wall_velocity": "5 m/s"}
MODELS = {  # settings, the key of the resolution with its values, particles of a grain by it, steps
    "bpm": ({"experiment.model": "bpm", "time.step": "0.1 us", "bpm.library": 4}, "bpm.primaries", (100, 200, 400), lambda n: n, 100),
    "mpm implicit": ({"experiment.model": "mpm", "time.step": "5 us"}, "mpm.cells", (8, 16, 32), lambda n: 14 * n * n, 10),
    "mpm explicit": ({"experiment.model": "mpm", "mpm.integrator": "explicit"}, "mpm.cells", (8, 16, 32), lambda n: 14 * n * n, 100),
}


def measure(model, grains, resolution):
    """One row, in this process."""
    import softgrain
    settings, key, _, particles, steps = MODELS[model]
    softgrain.set_threads(1)
    begin = time.process_time()
    simulation = softgrain.Simulation({**COMMON, **settings, key: resolution, "sample.grains": grains})
    ready = time.process_time()
    for _ in range(steps // 5):  # the first steps find impulses from nothing
        simulation.step()
    settled, sweeps = time.process_time(), 0
    for _ in range(steps):
        sweeps += simulation.step().sweeps
    step = (time.process_time() - settled) / steps
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    return {"model": model, "grains": grains, "resolution": resolution, "particles": grains * particles(resolution),
            "preparation_s": ready - begin, "step_s": step, "us_per_grain_and_step": 1e6 * step / grains,
            "ns_per_particle_and_step": 1e9 * step / (grains * particles(resolution)), "sweeps_per_step": sweeps / steps,
            "memory_MB": memory / 1e6}


def rows(quick):
    for model, (_, _, resolutions, _, _) in MODELS.items():
        base = resolutions[1] if model == "bpm" else resolutions[0]
        plan = [(n, base) for n in GRAINS] + [(30, r) for r in resolutions if r != base]
        for grains, resolution in plan[:2] if quick else plan:
            command = [sys.executable, __file__, "one", model, str(grains), str(resolution)]
            yield json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)


def write(quick):
    commit = subprocess.run(["git", "-C", HERE, "describe", "--always", "--dirty", "--abbrev=12"], stdout=subprocess.PIPE, text=True).stdout.strip()
    done = []
    for row in rows(quick):
        done.append({"commit": commit} | {k: f"{v:.4g}" if isinstance(v, float) else v for k, v in row.items()})
        print(*done[-1].values(), sep="\t", flush=True)
    if quick:
        return
    with open(TABLE, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(done[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(done)


def plot():
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    with open(TABLE, newline="") as file:
        table = list(csv.DictReader(file))
    figure, (cost, memory) = plt.subplots(1, 2, figsize=(9, 3.6), constrained_layout=True)
    for (model, (_, _, resolutions, _, _)), colour in zip(MODELS.items(), ("#0072B2", "#D55E00", "#009E73")):
        base = resolutions[1] if model == "bpm" else resolutions[0]
        own = [r for r in table if r["model"] == model]
        series = [r for r in own if int(r["resolution"]) == base]
        grains = [int(r["grains"]) for r in series]
        unit = "primaries" if model == "bpm" else "points"
        label = f"{model}, {int(series[0]['particles']) // grains[0]} {unit}"
        cost.loglog(grains, [float(r["ns_per_particle_and_step"]) for r in series], "o-", color=colour, label=label)
        for r in own:
            if int(r["resolution"]) != base:
                cost.loglog(30, float(r["ns_per_particle_and_step"]), "x", color=colour)
        memory.loglog(grains, [float(r["memory_MB"]) for r in series], "o-", color=colour, label=label)
    cost.set(xlabel="grains", ylabel="CPU time per particle and step [ns]", title="crosses: other resolutions, 30 grains", ylim=(1, None))
    memory.set(xlabel="grains", ylabel="peak memory [MB]")
    cost.legend(frameon=False, fontsize=8)
    figure.savefig(TABLE.with_suffix(".png"), dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", nargs="*", help="plot")
    parser.add_argument("--quick", action="store_true", help="two rows of each model, printed only")
    arguments = parser.parse_args()
    if arguments.what[:1] == ["one"]:
        model, grains, resolution = arguments.what[1:]
        print(json.dumps(measure(model, int(grains), int(resolution))))
    elif arguments.what == ["plot"]:
        plot()
    else:
        write(arguments.quick)


if __name__ == "__main__":
    main()
