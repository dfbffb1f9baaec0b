#!/usr/bin/env python3
"""Twenty bonded grains: how much do rate, time step, primaries, tolerance and sweeps matter? Three samples of each.

    study.py rate|primaries|solver -o DIR [--program PATH]   the runs -> results/rate.csv, primaries.csv, solver.csv
    study.py plot                                            results/rate.png, ... from the CSV files; needs
                                                             Debian's python3-matplotlib

Runs that are already finished in DIR are not run again.
"""
import argparse
import pathlib
import sys

HERE = pathlib.Path(__file__).parent
RESULTS = HERE / "results"
sys.path.insert(0, str(HERE.parent))
import packing_series

SEEDS = (1, 2, 3)
PHI = "phi_0"  # of undeformed grains: outlines of coarse aggregates do not compare
WINDOWS = ((0.80, 0.84), (0.84, 0.88), (0.88, 0.92), (0.92, 0.96), (0.96, 1.00), (1.00, 1.02))


def rate_variant(friction, velocity, step):
    settings = {"contact.friction": friction, "loading.wall_velocity": f'"{velocity} m/s"', "time.step": f'"{step} us"'}
    return {"mu": friction, "velocity": velocity, "step_us": step}, settings, None


def solver_variant(tolerance, least, most):
    settings = {"solver.tolerance": tolerance, "solver.min_sweeps": least, "solver.max_sweeps": most}
    return {"tolerance": tolerance, "min_sweeps": least, "max_sweeps": most}, settings, None


VARIANTS = {
    "rate": [rate_variant(*v) for v in ((0, 5, 0.1), (0, 1.5, 0.2), (0, 0.5, 0.2), (0, 0.5, 1), (0.5, 5, 0.1), (0.5, 0.5, 0.2))],
    "primaries": [({"primaries": n}, {"bpm.primaries": n}, None) for n in (100, 200, 400)],
    "solver": [solver_variant(*v) for v in ((1e-3, 1, 50), (1e-4, 1, 50), (1e-5, 1, 50), (1e-5, 10, 50), (1e-5, 10, 200),
                                            (1e-6, 10, 200), (1e-5, 10, 10))],
}
LABELS = {
    "rate": lambda r: f"{r['velocity']} m/s, {r['step_us']} $\\mu$s, $\\mu$ = {r['mu']}",
    "primaries": lambda r: f"{r['primaries']} primaries",
    "solver": lambda r: f"{r['tolerance']}, {r['min_sweeps']} to {r['max_sweeps']} sweeps",
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", choices=(*VARIANTS, "plot"))
    parser.add_argument("-o", "--out", type=pathlib.Path)
    parser.add_argument("--program", default="softgrain")
    arguments = parser.parse_args()
    if arguments.study == "plot":
        for name, label in LABELS.items():
            packing_series.draw(RESULTS / f"{name}.png", packing_series.read(RESULTS / f"{name}.csv"), label, PHI,
                                "packing fraction $\\Phi_0$ of undeformed grains")
        return
    if arguments.out is None:
        parser.error(f"{arguments.study} needs -o DIR")
    records = packing_series.series(arguments.program, HERE / "case.toml", arguments.out, VARIANTS[arguments.study], SEEDS, PHI,
                                    WINDOWS)
    packing_series.write(RESULTS / f"{arguments.study}.csv", records)


if __name__ == "__main__":
    main()
