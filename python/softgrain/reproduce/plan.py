"""Which runs each figure needs, at which scale."""

from dataclasses import dataclass

FIGURES = ("fig1", "fig2", "fig3", "fig4")
MODELS, FRICTIONS = ("bpm", "mpm"), (0.0, 0.5)
START_PACKING_FRACTION = 0.7  # of the paper's samples


@dataclass(frozen=True)
class PlannedRun:
    """A run of `softgrain`: a template and the values that differ from it."""

    name: str  # of its directory
    template: str
    values: dict

    @property
    def command_values(self):
        return [f"--set={key}={value}" for key, value in self.values.items()]


@dataclass(frozen=True)
class Scale:
    """How large the experiments are."""

    grains: int  # in a box
    seeds: tuple
    cells: int  # mpm.cells of the grains in a box
    grain_cells: int  # ... of the single grain
    primaries: int  # of the single grain
    bpm_step: str  # time.step of the packings
    last_packing_fraction: float  # Phi_0 where the elastic packings end
    snapshots: int


SCALES = {
    "quick": Scale(grains=20, seeds=(1, 2, 3), cells=5, grain_cells=8, primaries=300, bpm_step="0.1 us",
                   last_packing_fraction=1.0, snapshots=12),
    "paper": Scale(grains=300, seeds=(1,), cells=16, grain_cells=16, primaries=1750, bpm_step="0.1 us",
                   last_packing_fraction=1.04, snapshots=24),
}


def packing_name(model, friction, seed):
    return f"packing_{model}_mu{friction:g}_seed{seed}"


def planned_runs(figures, scale):
    """The runs that the figures need, the long ones first."""
    runs = []
    if set(figures) - {"fig1"}:
        runs += [_packing(model, friction, seed, scale)
                 for model in MODELS for friction in FRICTIONS for seed in scale.seeds]
    if "fig1" in figures:
        runs += _single_grains(scale)
    return runs


def _packing(model, friction, seed, scale):
    values = {"sample.grains": scale.grains, "sample.seed": seed, "contact.friction": friction,
              "output.snapshots": scale.snapshots, "output.samples": 300, "output.vtk": "false"}
    if model == "bpm":
        values |= {"time.step": scale.bpm_step}
    else:
        values |= {"mpm.cells": scale.cells, "time.step": "5 us", "loading.max_strain": 1,
                   "loading.max_packing_fraction": scale.last_packing_fraction}
    return PlannedRun(packing_name(model, friction, seed), f"compaction-{model}", values)


def _single_grains(scale):
    elastic = {"mpm.cells": scale.grain_cells, "loading.max_strain": 0.4, "output.vtk": "false"}
    bonded = {"bpm.primaries": scale.primaries, "output.vtk": "false"}
    if scale.primaries < 1000:
        bonded["time.step"] = "0.5 us"
    return [
        PlannedRun("grain_bpm", "diametral-bpm", bonded),
        PlannedRun("grain_mpm", "diametral-mpm", elastic),
        PlannedRun("grain_mpm_hooke", "diametral-mpm", elastic | {"mpm.law": "small_strain_hooke"}),
    ]
