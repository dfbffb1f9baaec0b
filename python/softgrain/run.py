"""A run's directory as Python objects: the case, the provenance, the series and the snapshots. SI units."""

import itertools
import json
import tomllib
from dataclasses import dataclass, field
from functools import cached_property
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from . import voronoi


class NotRecorded(LookupError):
    """The run lacks what was asked of it."""


class NotARun(ValueError):
    """The directory holds no run of softgrain."""


@dataclass(frozen=True, repr=False)
class Snapshot:
    """The state at one time: what can be drawn. Arrays are indexed by particle, by contact or by wall.

    `contacts["pair"]` counts particles, then walls; of elastic grains, whose particles are material points, grains, then walls."""

    step: int
    time: float  # [s]
    particles: dict  # position (n, 2) [m], radius (n,) [m], and any field by particle
    contacts: dict = field(default_factory=dict)  # pair (m, 2), force (m,), tangential_force (m,) [N/m];
    #                                               of elastic grains total_force, normal, position (m, 2) instead of the last
    walls: np.ndarray = field(default_factory=lambda: np.empty((0, 4)))  # x0 y0 x1 y1 [m], or edges of a periodic cell
    outlines: dict = field(default_factory=dict)  # position (v, 2) [m], grain (v,): counter-clockwise polygons
    surface: dict = field(default_factory=dict)  # in space: quad (q, 4) of the outlines' vertices, grain (q,), pressure (q,) [Pa];
    #                                              walls (w, 12): four corners each [m]
    cell: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))  # lattice vectors of a periodic cell, one a row [m]

    @property
    def contacts_of_grains(self) -> bool:
        """Whether contacts are between grains instead of between particles."""
        return "position" in self.contacts

    def __repr__(self) -> str:
        """Names and sizes, no arrays."""
        parts = [f"{name}: {', '.join(arrays)} ({len(next(iter(arrays.values())))})" for name, arrays in
                 (("particles", self.particles), ("contacts", self.contacts), ("outlines", self.outlines)) if arrays]
        return f"<Snapshot of step {self.step}, {self.time:.6g} s; {'; '.join([*parts, f'walls: {len(self.walls)}'])}>"

    def contact_table(self) -> dict[str, np.ndarray]:
        """Columns a, b, wall, grain_a, grain_b, normal_x, normal_y, x, y [m], normal_force, tangential_force [N/m], in space [N]:
        `pandas.DataFrame(snapshot.contact_table())`; what they mean: softgrain.export.contacts."""
        from .export.contacts import contact_table

        return contact_table(self)

    def voronoi(self, points: int | None = None) -> "voronoi.Cells":
        """Set-Voronoi cells of the grains: volumes, local packing fractions, neighbours (softgrain.voronoi). Needs SciPy."""
        from .voronoi import cells

        return cells.cells_of(self, points or cells.POINTS)

    def images(self) -> np.ndarray:
        """(m, 2) or (m, 3) [m]: from what is shown to its next images across the edges of a periodic cell, the first of all itself."""
        steps = [(0, 1, -1) if np.any(vector) else (0,) for vector in self.cell]
        return np.array([np.array(n) @ self.cell for n in itertools.product(*steps)]) if steps else np.zeros_like(self.particles["position"][:1])

    def bodies(self) -> np.ndarray:
        """Where what `contacts["pair"]` counts lies, walls left out (n, 2) [m]: particles, or the centres of elastic grains."""
        position = self.particles["position"]
        if not self.contacts_of_grains:
            return position
        grain, area = self.particles["grain"], self.particles["radius"] ** 2
        sums = [np.bincount(grain, area * x) for x in position.T]
        return np.column_stack(sums) / np.bincount(grain, area)[:, None]

    def body_radii(self) -> np.ndarray:
        """Radii of bodies() [m]; of an elastic grain that of a disk of its present area."""
        radius = self.particles["radius"]
        return np.sqrt(np.bincount(self.particles["grain"], radius**2)) if self.contacts_of_grains else radius

    @classmethod
    def read(cls, path: str | Path) -> "Snapshot":
        """Reads one snapshot file. Raises OSError if it is damaged or missing."""
        with _open_hdf5(path) as file:
            if "scene/particles/position" not in file:
                raise OSError(f"{path}: no snapshot: it has no /scene/particles/position")
            scene = file["scene"]
            walls = scene["walls"][()] if "walls" in scene else ()
            contacts = _arrays(scene, "contacts")
            if "checkpoint/contact_impulse" in file and "force" in contacts:
                contacts |= _tangential_force(contacts["force"], file["checkpoint/contact_impulse"][()])
            return cls(
                step=int(file.attrs.get("step", 0)),
                time=float(file.attrs.get("time", 0)),
                particles=_arrays(scene, "particles"),
                contacts=contacts,
                walls=np.asarray(walls, float).reshape(-1, 4),
                outlines=_arrays(scene, "outlines"),
                surface=_arrays(scene, "surface"),
                cell=scene["cell"][()] if "cell" in scene else np.empty((0, 2)),
            )


@dataclass(frozen=True, repr=False)
class Run:
    """A run's directory. `run[i]` reads snapshot i; `len(run)` counts them; the rest is read when asked."""

    path: Path

    @property
    def name(self) -> str:
        return self.path.resolve().name

    @property
    def plot(self) -> "Plots":
        """The figures of this run: `run.plot.curve()`, `.grain()`, `.packing()`, `.diagnostics()`."""
        return Plots(self)

    @cached_property
    def case(self) -> dict:
        """The resolved case, SI."""
        return tomllib.loads((self.path / "case.toml").read_text())

    @property
    def elastic(self) -> bool:
        """Whether the grains are elastic (mpm), not bonded (bpm)."""
        return self.case.get("experiment", {}).get("model") == "mpm"

    @property
    def in_space(self) -> bool:
        """Whether the run has three dimensions."""
        return self.case.get("experiment", {}).get("dimension", 2) == 3

    @cached_property
    def info(self) -> dict:
        """The provenance (run.json); empty if the run never wrote it."""
        path = self.path / "run.json"
        return json.loads(path.read_text()) if path.exists() else {}

    @property
    def doubts(self) -> list[str]:
        """Why a run that is done is not to be trusted, and what of its case it did not reach; [] if all is well."""
        return self.info.get("doubts", [])

    @property
    def series(self) -> dict[str, np.ndarray]:
        """Column name (without unit) -> array over the samples."""
        return self._table[0]

    @property
    def units(self) -> dict[str, str]:
        """Column name -> unit, "" for a pure number."""
        return self._table[1]

    @cached_property
    def snapshots(self) -> list[Path]:
        """Paths of the snapshots, oldest first: `s000123.h5` is of step 123, whatever the width of the number."""
        return [path for _, path in sorted(_numbered(self.path / "snap", "s", ".h5").items())]

    @cached_property
    def times(self) -> np.ndarray:
        """Of the snapshots [s]."""
        return np.array([_time(path) for path in self.snapshots])

    def vtk_files(self, kind: str) -> dict[int, Path]:
        """Step -> `vtk/KIND_000123.vtp`, as far as they are there; kind: particles, contacts or walls."""
        return _numbered(self.path / "vtk", f"{kind}_", ".vtp")

    @cached_property
    def _table(self):
        return _read_series(self.path / "series.csv")

    def __len__(self) -> int:
        return len(self.snapshots)

    def __getitem__(self, index: int) -> Snapshot:
        return Snapshot.read(self.snapshots[index])

    def __repr__(self) -> str:
        state = self.info.get("state", "not begun")
        rows = len(next(iter(self.series.values()), ()))
        return f"<Run '{self.path}': {state}, {rows} rows, {len(self)} snapshots>"

    def _repr_html_(self) -> str:
        """What a notebook shows: state, verdict and the last row."""
        last = {name: f"{values[-1]:.6g} {self.units[name]}" for name, values in self.series.items()}
        facts = {"state": self.info.get("state", "not begun"), "verdict": self.info.get("verdict", ""),
                 "snapshots": len(self), **last}
        return html_table(self.name, facts)


@dataclass(frozen=True)
class Plots:
    """The figures of a run in the style of the package; each is a Matplotlib Figure. Needs Matplotlib."""

    run: Run

    def curve(self, normalise: bool = False):
        """Stress against strain."""
        return self._draw("draw_curve", [self.run], normalise=normalise)

    def grain(self):
        """The particles, or the surfaces in space, at the moments that matter."""
        return self._draw("draw_space" if self.run.in_space else "draw_grain", self.run)

    def packing(self):
        """Coordination number and packing fraction."""
        return self._draw("draw_packing", [self.run])

    def shear(self):
        """Stress ratio, packing fraction and coordination number of a periodic cell over shear strain."""
        return self._draw("draw_shear", [self.run])

    def diagnostics(self):
        """What the solver and the energies did."""
        return self._draw("draw_diagnostics", self.run)

    def die(self):
        """Stresses on the walls of a die and their ratios; elastic recovery."""
        return self._draw("draw_die", self.run)

    def profile(self):
        """Density, and stress and friction of the side walls, by height, at the largest load."""
        return self._draw("draw_profile", self.run)

    def voronoi(self):
        """Local packing fractions and numbers of neighbours, from set-Voronoi cells. Needs SciPy."""
        return self._draw("draw_voronoi", self.run)

    def heckel(self, window: tuple[float, float] | None = None):
        """Heckel's line and Panelli and Ambrozio's curve, over a window of pressures [Pa]."""
        return self._draw("draw_heckel", self.run, window)

    def kawakita(self, window: tuple[float, float] | None = None):
        """Kawakita's line, over a window of pressures [Pa]."""
        return self._draw("draw_kawakita", self.run, window)

    def _draw(self, name, *arguments, **options):
        from . import plot

        with plot.style():
            return getattr(plot, name)(*arguments, **options)


def open_run(path: str | Path) -> Run:
    """The run in directory `path`. Raises NotARun if there is none."""
    path = Path(path)
    if not (path / "case.toml").is_file():
        raise NotARun(f"'{path}' is not the directory of a run: it has no case.toml")
    return Run(path)


def html_table(caption: str, facts: dict) -> str:
    """Names and values for a notebook; text stays text."""
    rows = "".join(f"<tr><th>{escape(name)}</th><td>{escape(str(value))}</td></tr>" for name, value in facts.items())
    return f"<table><caption>{escape(caption)}</caption>{rows}</table>"


def _numbered(folder, prefix, suffix):
    """Step -> path of the files whose name is prefix, digits, suffix. The digits are as many as the last step of a run has."""
    numbers = ((path.name[len(prefix):-len(suffix)], path) for path in folder.glob(f"{prefix}*{suffix}"))
    return {int(number): path for number, path in numbers if number.isdigit()}


def _time(path):
    with _open_hdf5(path) as file:
        return float(file.attrs.get("time", 0))


def _open_hdf5(path):
    """To read, without a lock: snapshots never change, and not every file system has locks."""
    import h5py

    try:
        return h5py.File(path, "r", locking=False)
    except (TypeError, ValueError):  # h5py before 3.5, HDF5 before 1.10.7: the environment may say so
        return h5py.File(path, "r")


def _arrays(scene, name):
    if name not in scene:
        return {}
    arrays = {key: data[()] for key, data in scene[name].items()}
    # A scalar field may be stored as one column.
    return {key: a[:, 0] if a.ndim == 2 and a.shape[1] == 1 else a for key, a in arrays.items()}


def _tangential_force(force, impulse):
    """Of bonded grains, whose scene has the normal forces of the contacts that push, from all impulses (p_n, p_t)."""
    pushing = impulse[impulse[:, 0] > 0] if impulse.ndim == 2 and impulse.shape[1] == 2 else np.empty((0, 2))
    if len(pushing) != len(force):
        return {}
    return {"tangential_force": force * pushing[:, 1] / pushing[:, 0]}


def _read_series(path):
    """Columns and units of a table with the header `name[unit],...`; none before its first row.

    A last line without its newline is torn and left out. Raises ValueError for a row that is not as many numbers."""
    if not path.exists():
        return {}, {}
    complete_lines = path.read_text().split("\n")[:-1]
    header, *rows = [line.split(",") for line in complete_lines] or [[]]
    names = [cell.split("[")[0].strip() for cell in header]
    units = [cell.partition("[")[2].rstrip("] ") for cell in header]
    if any(len(row) != len(names) for row in rows):
        raise ValueError(f"'{path}' is damaged: a row has not {len(names)} numbers")
    columns = np.array(rows, float).T  # no row, no column
    return dict(zip(names, columns)), dict(zip(names, units))
