"""A run's directory with made-up results: a hexagonal grain that is squeezed, unloaded once, squeezed."""

import json
from pathlib import Path

import h5py
import numpy as np

F0 = 100.0  # [N/m]
RADIUS = 0.1e-3  # of every primary [m]; <a0> = 0.2 mm, so sigma_I = 0.5 MPa
PLATEAU = 0.08e6  # [Pa]
STIFFNESS, UNLOADING_STIFFNESS = 4e6, 10e6  # d sigma / d eps [Pa]

COLUMNS = ("step", "time[s]", "strain", "stress_bottom[Pa]", "stress_top[Pa]", "kinetic_energy[J/m]",
           "attraction_energy[J/m]", "wall_work[J/m]", "sweeps", "overlap_mean", "overlap_max")


def strain_path():
    """Up to 0.10, back to 0.088, on to 0.20."""
    return np.concatenate([np.arange(0, 100), np.arange(100, 88, -1), np.arange(88, 201)]) * 1e-3


def stress_path(strain):
    """Elastic, then perfectly plastic, elastic in unloading."""
    stress = np.zeros_like(strain)
    for i in range(1, strain.size):
        on_envelope = strain[i] > strain[:i].max()
        slope = STIFFNESS if on_envelope else UNLOADING_STIFFNESS
        stress[i] = np.clip(stress[i - 1] + slope * (strain[i] - strain[i - 1]), 0, PLATEAU)
    return stress


def hexagonal_grain(rows=11):
    """Positions (n, 2) and neighbours (m, 2) of touching disks in a round patch of a triangular lattice."""
    i, j = np.meshgrid(np.arange(-rows, rows + 1), np.arange(-rows, rows + 1))
    position = 2 * RADIUS * np.c_[(i + 0.5 * j).ravel(), (np.sqrt(0.75) * j).ravel()]
    position = position[np.hypot(*position.T) < rows * RADIUS]
    distance = np.hypot(*(position[:, None] - position[None]).T)
    return position, np.argwhere(np.triu(distance < 2.01 * RADIUS, 1))


def write_series(folder, columns=COLUMNS):
    strain = strain_path()
    stress, step = stress_path(strain), 100.0 * np.arange(strain.size)
    one = np.ones_like(step)
    known = dict(zip(COLUMNS, (step, 1e-5 * step, strain, 0.98 * stress, 1.02 * stress, 1e-6 * one,
                               -3 * one, strain * 2, 20 + step % 7, 1e-5 * one, 1e-3 * one)))
    rows = np.column_stack([known.get(name, one) for name in columns])
    lines = [",".join(columns), *(",".join(f"{value:.9g}" for value in row) for row in rows)]
    (Path(folder) / "series.csv").write_text("\n".join(lines) + "\n")


def write_snapshot(folder, step, time, strain, force=F0, fields=("pressure",), contacts=True):
    position, pair = hexagonal_grain()
    position = position * (np.exp(strain), np.exp(-strain))
    top = position[:, 1].max() + RADIUS
    with h5py.File(Path(folder) / "snap" / f"s{step:06d}.h5", "w") as file:
        file.attrs["step"], file.attrs["time"] = step, time
        file["scene/particles/position"] = position
        file["scene/particles/radius"] = np.full((len(position), 1), RADIUS)
        for name in fields:
            file[f"scene/particles/{name}"] = np.linspace(-0.5e6, 1e6, len(position))
        if contacts:
            file["scene/contacts/pair"] = pair
            file["scene/contacts/force"] = force * (1 + np.arange(len(pair)) % 5)
        file["scene/walls"] = [[-3e-3, -top, 3e-3, -top], [-3e-3, top, 3e-3, top]]


def write_run(folder, snapshots=7, columns=COLUMNS, **scene):
    """The whole directory; `scene` goes to write_snapshot."""
    folder = Path(folder)
    (folder / "snap").mkdir(parents=True)
    (folder / "case.toml").write_text(f"[bpm]\nattraction = {F0}  # N/m\n")
    (folder / "run.json").write_text(json.dumps({"program": {"version": "9.8.7", "commit": "abc123"}}))
    write_series(folder, columns)
    strain = strain_path()
    for sample in np.linspace(0, strain.size - 1, snapshots).astype(int):
        write_snapshot(folder, 100 * sample, 1e-3 * sample, strain[sample], **scene)
    return folder
