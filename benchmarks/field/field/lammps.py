"""LAMMPS' runs: grains are points with a law of their overlap."""

import numpy as np

from .packings import coordination
from .work import cpu_seconds_of, first_line_of

PROGRAM = "lmp"
STEPS_PER_CONTACT = 20
SHARE_OF_CRITICAL = 0.3  # damping of a pair


def version():
    return first_line_of([PROGRAM, "-h"], "Large-scale").partition(" - ")[2]


def run(place, name, deck, variables):
    """CPU time [s] of a deck of ../lammps."""
    words = [word for key, value in variables.items() for word in ("-var", key, *str(value).split())]
    return cpu_seconds_of([PROGRAM, "-screen", "none", "-log", f"{name}.lammps.log", "-in",
                           place.decks.parent / "lammps" / deck, *words], place.folder, f"{name}.log")


def table(path):
    """Rows of fix ave/time, without the step."""
    return np.loadtxt(path, comments="#", ndmin=2)[:, 1:]


def write_start(path, start):
    """A data file of atom_style sphere: `start` has x, y, radius and kind of each grain and the cell's width and height."""
    kinds = int(start.kind.max())
    lines = ["grains", "", f"{len(start.x)} atoms", f"{kinds} atom types", "", f"0 {start.width:.12g} xlo xhi",
             f"0 {start.height:.12g} ylo yhi", "-0.5 0.5 zlo zhi", "", "Atoms", ""]
    lines += [f"{i + 1} {k} {2 * r:.12g} 1000 {x % start.width:.12g} {y % start.height:.12g} 0"
              for i, (x, y, r, k) in enumerate(zip(start.x, start.y, start.radius, start.kind))]
    path.write_text("\n".join(lines) + "\n")


def packing(place, name, start, stiffness, friction, density, strains, duration, rows=200):
    """Columns of a packing under strains (xx, yy) in `duration` [s]; `stiffness`: {(kind, kind): kn [N/m]}.

    Returns (columns, CPU time [s], time steps)."""
    place.folder.mkdir(parents=True, exist_ok=True)
    write_start(place.folder / f"{name}.data", start)
    lightest = density * np.pi * start.radius.min() ** 2 / 2  # of a pair of the smallest
    stiffest = max(stiffness.values())
    step = np.pi * np.sqrt(lightest / stiffest) / STEPS_PER_CONTACT
    every = max(1, round(duration / step / rows))
    steps = every * rows
    step = duration / steps
    pairs = [f"pair_coeff {a} {b} hooke {kn:.8g} {2 * SHARE_OF_CRITICAL * np.sqrt(kn / lightest):.8g} "
             f"tangential linear_history {2 / 7 * kn:.8g} 1.0 {friction:g} damping mass_velocity"
             for (a, b), kn in stiffness.items()]
    (place.folder / f"{name}.pairs_of_kinds").write_text("\n".join(pairs) + "\n")
    cpu = run(place, name, "packing.in", {
        "start": f"{name}.data", "out": name, "steps": steps, "every": every, "dt": f"{step:.10g}", "density": density,
        "rate_x": f"{strains[0] / duration:.10g}", "rate_y": f"{strains[1] / duration:.10g}", "pairs": f"{name}.pairs_of_kinds"})
    width, height, xx, yy, kinetic = table(place.folder / f"{name}.txt").T
    area = np.pi * (start.radius**2).sum()
    contacts = read_pairs(place.folder / f"{name}.pairs")
    z = np.array([coordination(len(start.x), pairs) for pairs in contacts])
    columns = {"phi_0": area / (width * height), "strain": np.log(height[0] / height), "stress_xx": xx, "stress_yy": yy,
               "z": z[:, 0], "z_no_rattlers": z[:, 1], "kinetic_energy": kinetic}
    return columns, cpu, steps


def read_pairs(path):
    """Pairs of grains in contact, 0-based, of each frame of a local dump."""
    frames, rows, reading = [], [], False
    for line in path.read_text().splitlines():
        if line.startswith("ITEM: ENTRIES"):
            reading, rows = True, []
            frames.append(rows)
        elif line.startswith("ITEM:"):
            reading = False
        elif reading:
            a, b = line.split()[:2]
            rows.append((int(float(a)) - 1, int(float(b)) - 1))
    return [np.array(rows, int).reshape(-1, 2) for rows in frames]
