"""A run's directory as Python objects: the case, the provenance, the series and the snapshots. SI units."""

import json
import tomllib
from dataclasses import dataclass
from functools import cached_property
from html import escape
from pathlib import Path

import numpy as np

from .snapshot import Snapshot, open_hdf5


class NotRecorded(LookupError):
    """The run lacks what was asked of it."""


class NotARun(ValueError):
    """The directory holds no run of softgrain."""


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
    with open_hdf5(path) as file:
        return float(file.attrs.get("time", 0))


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
