"""Particles as text: extended XYZ and LAMMPS dumps (several frames, for OVITO), CSV (one frame)."""

import numpy as np

from .. import solids

UNITS = {"position": "m", "radius": "m", "pressure": "Pa", "stress": "Pa", "velocity": "m/s"}
AXES = {2: ("x", "y"), 3: ("x", "y", "z"), 4: ("xx", "xy", "yx", "yy")}


def write_xyz(snapshots, file):
    """Extended XYZ: species X (ASE's name of what is no element), x y z [m], then radius, grain, pressure as far as they are recorded.

    An elastic or rigid grain in space is one particle: the ellipsoid that has its volume and its gyration tensor, as OVITO draws it:
    aspherical_shape (three semi-axes [m]), orientation (quaternion x y z w)."""
    for snapshot in snapshots:
        marks, solid = _marks(snapshot), _ellipsoids(snapshot)
        names = {name: f"{_kind(values)}:1" for name, values in marks.items()} | {name: f"R:{len(values)}" for name, values in solid.items()}
        columns = {"species": ["X"] * _count(snapshot), **_place(snapshot), **marks}
        columns |= {f"{name}_{k}": column for name, values in solid.items() for k, column in enumerate(values)}
        kinds = "species:S:1:pos:R:3" + "".join(f":{name}:{kind}" for name, kind in names.items())
        file.write(f'{_count(snapshot)}\n{_lattice(snapshot)} Properties={kinds} Time={snapshot.time:.9g} '
                   f"Step={snapshot.step}\n")
        file.writelines(" ".join(row) + "\n" for row in _rows(columns))


def _lattice(snapshot):
    """Of a periodic cell its own vectors, and which of them repeat."""
    (x0, x1), (y0, y1), (z0, z1) = box(snapshot)
    vectors, origin, repeats = np.diag([x1 - x0, y1 - y0, z1 - z0]), np.array([x0, y0, z0]), [False] * 3
    for k, vector in enumerate(snapshot.cell):
        if vector.any():
            vectors[k, :len(vector)], origin[k], repeats[k] = vector, 0, True
    pbc = " ".join("FT"[along] for along in repeats)
    return (f'Lattice="{" ".join(f"{x:.9g}" for x in vectors.ravel())}" '
            f'Origin="{" ".join(f"{x:.9g}" for x in origin)}" pbc="{pbc}"')


def write_lammps(snapshots, file):
    """LAMMPS' text dump: id type x y z [m] radius [m] mol (the grain, from 1) pressure [Pa]."""
    for snapshot in snapshots:
        marks = _marks(snapshot)
        if "grain" in marks:
            marks["mol"] = marks.pop("grain") + 1  # 0 means no molecule
        count = _count(snapshot)
        columns = {"id": np.arange(1, count + 1), "type": np.ones(count, int), **_place(snapshot), **marks}
        bounds = "".join(f"{low:.9g} {high:.9g}\n" for low, high in box(snapshot))
        along = " ".join("pp" if k < len(snapshot.cell) and solids.in_space(snapshot) and snapshot.cell[k].any() else "ff" for k in range(3))
        file.write(f"ITEM: TIMESTEP\n{snapshot.step}\nITEM: NUMBER OF ATOMS\n{count}\n"
                   f"ITEM: BOX BOUNDS {along}\n{bounds}ITEM: ATOMS {' '.join(columns)}\n")
        file.writelines(" ".join(row) + "\n" for row in _rows(columns))


def write_csv(snapshot, file):
    """One line per particle with all its fields; the header names columns and units as in series.csv."""
    columns = {}
    for name, values in sorted(snapshot.particles.items(), key=lambda item: item[0] != "position"):
        unit = f"[{UNITS[name]}]" if name in UNITS else ""
        if values.ndim == 1:
            columns[name + unit] = values
            continue
        prefix = "" if name == "position" else f"{name}_"
        axes = AXES.get(values.shape[1], range(values.shape[1]))
        columns.update({f"{prefix}{axis}{unit}": column for axis, column in zip(axes, values.T)})
    file.write(",".join(columns) + "\n")
    file.writelines(",".join(row) + "\n" for row in _rows(columns))


def box(snapshot):
    """((x0, x1), (y0, y1), (z0, z1)) [m] around walls and particles; in the plane as thick as the thickest particle.

    In space that of the faces, which hold all surfaces, or reach over those of grains that stick out of a cell."""
    if solids.in_space(snapshot):
        faces = snapshot.surface["walls"].reshape(-1, 3)
        corners = faces if len(snapshot.cell) else np.concatenate([faces, snapshot.outlines["position"]])
        return [*zip(corners.min(axis=0), corners.max(axis=0))]
    radius = snapshot.particles["radius"][:, None]
    position = snapshot.particles["position"]
    corners = np.concatenate([position - radius, position + radius, snapshot.walls.reshape(-1, 2)])
    thickness = radius.max()
    return [*zip(corners.min(axis=0), corners.max(axis=0)), (-thickness, thickness)]


def _count(snapshot):
    return len(snapshot.particles["radius"])


def _place(snapshot):
    x, y, *z = snapshot.particles["position"].T
    return {"x": x, "y": y, "z": z[0] if z else np.zeros_like(x)}


def _marks(snapshot):
    marks = {name: snapshot.particles[name] for name in ("radius", "grain", "kind", "pressure") if name in snapshot.particles}
    if solids.of_grains(snapshot) and "pressure" in snapshot.surface:
        marks["pressure"] = solids.pressures(snapshot)
    return marks


def _ellipsoids(snapshot):
    """Columns of the three semi-axes and of the quaternion; {} in the plane, and of primaries."""
    if not solids.of_grains(snapshot):
        return {}
    axes, quaternion = solids.ellipsoids(snapshot)
    return {"aspherical_shape": axes.T, "orientation": quaternion.T}


def _kind(values):
    return "I" if np.issubdtype(values.dtype, np.integer) else "R"


def _rows(columns):
    """Each particle's cells as text; reals with the digits of a float32 and some more."""
    return zip(*([f"{value:.9g}" if isinstance(value, float) else str(value) for value in np.asarray(column).tolist()]
                 for column in columns.values()))
