#!/usr/bin/env python3
"""Four metals by case.toml: forces, recovery and slope of unloading against finite elements.

    study.py PROGRAM OUT      runs what OUT does not hold yet; writes results/unloading.csv and results/curves.png
"""
import csv
import pathlib
import subprocess
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1] / "python"))
import softgrain  # noqa: E402

YIELD, RADIUS, NU = 1e5, 1e-3, 0.3
# E and H over the yield stress; how much slower than the case; of finite elements d/R and F/(sigma_y R), then at the
# turns d/R = .1 and .3 the recovery over R and the first slope over E/(1 - nu^2)
METALS = {
    "soft": (100, 0, 1, [(.02, .677), (.05, 1.003), (.1, 1.197), (.2, 1.585), (.3, 2.168)],
             [(.01044, 1.255), (.00736, 2.928)]),
    "stiff": (1000, 0, 4, [(.02, .891), (.05, 1.077), (.1, 1.262), (.2, 1.602), (.3, 2.190)],
              [(.001035, 1.325), (.000740, 2.917)]),
    "soft, hardening": (100, 1, 1, [(.02, .687), (.05, 1.033), (.1, 1.306), (.2, 1.9615), (.3, 2.786)],
                        [(.01150, 1.21), (.01069, 2.75)]),
    "stiff, hardening": (1000, 10, 4, [(.02, 1.044), (.05, 1.541), (.1, 2.446), (.2, 5.060), (.3, 9.00)],
                         [(.002122, 1.15), (.00367, 2.55)]),
}
SPEEDS = {"press": .08, "let go": -.016, "press on": .08, "let go again": -.016}


def case_text(slower, stiff):
    text = (HERE / "case.toml").read_text()
    for speed in (".08", ".016"):
        value = float(speed) / slower / (5 if stiff and speed == ".016" else 1)
        text = text.replace(f"0{speed} m/s", f"{value:g} m/s")
    return text.replace('step = "20 us"', f'step = "{20 * slower:g} us"')


def run(program, out, name, young, hardening, slower):
    path = out / name.replace(", ", "_")
    if not (path / "run.json").exists():
        case = out / f"{path.name}.toml"
        case.write_text(case_text(slower, young > 100))
        subprocess.run([program, "run", case, "-o", path, "--force", "--set", f"mpm.young_modulus={young * YIELD}",
                        "--set", f"mpm.hardening_modulus={hardening * YIELD}", "--set", f"mpm.tolerance={1e-3 / young:g}"],
                       check=True)
    return softgrain.open(path)


def curve(series):
    """d/R, F/(sigma_y R), leg."""
    approach = 1 - np.exp(-series["strain"])
    return approach, (series["force_top"] + series["force_bottom"]) / (2 * YIELD * RADIUS), series["leg"].astype(int)


def unloading(approach, force, leg, which):
    """(recovery over R, slope at once [yield stress]) of a leg in which the walls go back."""
    turn = np.flatnonzero(leg < which)[-1]
    back = slice(turn, np.flatnonzero(leg == which)[-1] + 1)
    d, f = approach[back], force[back]
    bears = f > 0.02 * f[0]
    last = np.flatnonzero(bears)[-1]
    recovery = d[0] - (d[last] - f[last] * (d[last - 1] - d[last]) / (f[last - 1] - f[last]))
    early = (f < 0.98 * f[0]) & (f > 0.8 * f[0])  # the turn itself sends a wave through the grain
    slope = np.polyfit(d[early], f[early], 1)[0]
    return recovery, slope


def main(program, out):
    out = pathlib.Path(out)
    out.mkdir(parents=True, exist_ok=True)
    plt.rcParams.update({"font.size": 8, "axes.linewidth": 0.6})
    figure, axes = plt.subplots(1, 2, figsize=(6.6, 2.8), layout="constrained")
    rows = []
    for (name, (young, hardening, slower, forces, turns)), colour in zip(METALS.items(), ("C0", "C1", "C2", "C3")):
        series = run(program, out, name, young, hardening, slower).series
        approach, force, leg = curve(series)
        where = axes[1 if hardening and young > 100 else 0]
        where.plot(approach, force, color=colour, linewidth=0.9, label=f"{name}: E = {young}, H = {hardening}")
        where.plot(*zip(*forces), "o", color=colour, markersize=3)
        up = (leg == 0) | (leg == 2)
        for d, reference in forces:
            first = np.flatnonzero(up & (approach >= d - 2e-4))[0]
            value = force[max(0, first - 2): first + 3].mean() if d not in (.1, .3) else force[first]
            rows.append((name, f"F at d/R = {d}", value, reference))
        for which, d, (recovery, slope) in zip((1, 3), (.1, .3), turns):
            found = unloading(approach, force, leg, which)
            rows.append((name, f"recovery/R from {d}", found[0], recovery))
            rows.append((name, f"first slope/E* from {d}", found[1] / young * (1 - NU * NU), slope))
        work = series["wall_work"][-1]
        rows.append((name, "energy missing over work", np.abs(series["energy_error"]).max() / work, 0))
    for panel in axes:
        panel.set(xlabel="$d/R$", ylabel=r"$F/(\sigma_y R)$", xlim=(0, None), ylim=(0, None))
        panel.legend(frameon=False)
    results = HERE / "results"
    results.mkdir(exist_ok=True)
    figure.savefig(results / "curves.png", dpi=130, metadata={"Software": None})
    with open(results / "unloading.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["metal", "what", "softgrain", "finite elements", "difference [%]"])
        for name, what, value, reference in rows:
            writer.writerow([name, what, f"{value:.4g}", reference or "",
                             f"{100 * (value / reference - 1):.1f}" if reference else ""])


if __name__ == "__main__":
    main(*sys.argv[1:])
