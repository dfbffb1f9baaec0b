"""Which runs each figure needs, at which scale."""

import shlex
from dataclasses import dataclass, replace

FIGURES = ("fig1", "fig2", "fig3", "fig4")
MODELS, FRICTIONS = ("bpm", "mpm"), (0.0, 0.5)
START_PACKING_FRACTION = 0.7  # of the paper's samples
# Ways of compaction, and how the names of their runs begin.
FAST = "packing"  # the paper's recipe
SLOW = "slow"  # a quasi-static wall
NODES = "nodes"  # contact on the nodes of the paper's lattice
EARLY = "early"  # contact on outlines that are larger by half of the gap at which nodes feel each other
HOOKE = "hooke"  # the law of small strain
ATTRACTIONS = ((1, 0.0), (3, 0.0), (7, 0.3), (2, 0.3))  # (gamma, inner friction) that are tried besides the paper's (7, 0)
NODES_CELLS = 6  # of the smallest grain: the lattice's cell is 0.116 of the mean radius, twice the paper's; 12 cost ten times as much
NODE_GAP = 1.10 * 0.058  # at which two grains meet on nodes, over R: 1.10 cells in the mean of directions and places
PAPER_SPEED = "5 m/s"
SLOW_BONDED_SPEED = "1 m/s"  # a bonded step lasts as long at any speed; 0.5 m/s changes Z by less than its scatter
SLOW_BONDED_END = 1.005  # Phi_0: the exponent is fitted up to 1, and nothing else is read off beyond


@dataclass(frozen=True)
class PlannedRun:
    """A run of `softgrain`: a template and the values that differ from it."""

    name: str  # of its directory
    template: str
    values: dict
    packing: tuple | None = None  # (way, model, friction); None: a single grain

    @property
    def command_values(self):
        return [f"--set={key}={value}" for key, value in self.values.items()]

    @property
    def words(self):
        """The two commands that make the run, as one would type them."""
        values = " ".join(f"--set {shlex.quote(f'{key}={value}')}" for key, value in self.values.items())
        return (f"softgrain new {self.name} --template {self.template} && "
                f"softgrain run {self.name}/case.toml -o out/{self.name} {values}")


@dataclass(frozen=True)
class Scale:
    """How large the experiments are."""

    grains: int  # in a box
    seeds: dict  # (way, model, friction) -> seeds of the samples
    cells: int  # mpm.cells of the grains in a box, at the paper's speed
    slow_cells: int  # ... of a quasi-static wall
    grain_cells: int  # ... of the single grain
    primaries: int  # of the single grain
    grain_seeds: tuple  # of the single bonded grain
    grain_primaries: int  # of the bonded grains in a box
    slow_grains: int  # bonded, of the slow wall
    slow_speed: tuple  # (speed, step) of the slow wall of elastic grains
    attractions: tuple  # of ATTRACTIONS, those that are tried
    nodes_grains: int  # of the lattice
    last_packing_fraction: float  # Phi_0 where the elastic packings end
    snapshots: int

    def with_seeds(self, count):
        """The same with seeds 1 .. count everywhere."""
        every = tuple(range(1, count + 1))
        return replace(self, seeds={key: every if some else () for key, some in self.seeds.items()}, grain_seeds=every)


def _both(way, model, count):
    """Without and with friction, seeds 1 .. count."""
    return {(way, model, friction): tuple(range(1, count + 1)) for friction in FRICTIONS}


# quick: below a minute on two idle cores. Of 60 elastic grains, a slow wall of 0.5 m/s (I = 6e-3) has Z within 0.2 and, from
# Phi = 0.84 on, the stress within 11 % of I = 1e-3, for a third of the sweeps. What shows a cause at paper size is tried, no more.
# Seeds stand in the order in which runs begin: what takes long comes first, so that two cores end together.
SCALES = {
    "quick": Scale(grains=60, cells=5, slow_cells=5, grain_cells=8, primaries=500, grain_seeds=(1, 2), grain_primaries=100,
                   slow_grains=60, slow_speed=("0.5 m/s", "30 us"), attractions=((2, 0.3),), nodes_grains=16,
                   last_packing_fraction=1.04, snapshots=12,
                   seeds={(SLOW, "bpm", 0.0): (1,)} | _both(FAST, "bpm", 1) | _both(SLOW, "mpm", 1) | _both(FAST, "mpm", 3)
                   | _both(EARLY, "mpm", 3) | _both(HOOKE, "mpm", 1)),
    "paper": Scale(grains=300, cells=8, slow_cells=6, grain_cells=16, primaries=1750, grain_seeds=(1, 2, 3), grain_primaries=200,
                   slow_grains=60, slow_speed=("quasi-static", "auto"), attractions=ATTRACTIONS, nodes_grains=300,
                   last_packing_fraction=1.04, snapshots=12,
                   seeds=_both(FAST, "bpm", 3) | {(SLOW, "bpm", 0.0): (1, 2)} | _both(SLOW, "mpm", 5) | _both(NODES, "mpm", 1)
                   | _both(FAST, "mpm", 5) | _both(EARLY, "mpm", 5) | _both(HOOKE, "mpm", 1)),
}


ON_NODES = {"mpm.formulation": "updated_lagrangian", "mpm.shape_functions": "bilinear", "mpm.contact_on": "grid_nodes",
            "time.step": "auto"}
PAPER_STEP = {"mpm.lattice_integrator": "implicit", "mpm.law": "small_strain_hooke", "time.step": "5 us"}  # of a packing on nodes


def packing_name(way, model, friction, seed):
    return f"{way}_{model}_mu{friction:g}_seed{seed}"


def attraction_name(exponent, friction):
    return f"attraction_gamma{exponent}_mu{friction:g}"


def planned_runs(figures, scale, speed=PAPER_SPEED, extra=None):
    """The runs that the figures need, the long ones first. `extra` values hold for all of them."""
    runs = []
    if set(figures) - {"fig1"}:
        runs += [_packing(*kind, seed, scale, speed) for kind, seeds in scale.seeds.items() for seed in seeds]
    if "fig1" in figures:
        runs += _single_grains(scale)
    return [replace(run, values=run.values | (extra or {})) for run in runs]


def _packing(way, model, friction, seed, scale, speed):
    values = {"sample.grains": scale.grains, "sample.seed": seed, "contact.friction": friction,
              "loading.wall_velocity": speed, "output.snapshots": scale.snapshots, "output.samples": 300,
              "output.vtk": "false", "output.report": "false"}
    if model == "bpm":
        values |= {"time.step": "0.1 us", "bpm.primaries": scale.grain_primaries}
    else:
        values |= {"mpm.cells": scale.cells, "time.step": "5 us" if speed == PAPER_SPEED else "auto", "loading.max_strain": 1,
                   "loading.max_packing_fraction": scale.last_packing_fraction}
    if way == SLOW and model == "bpm":
        values |= {"sample.grains": scale.slow_grains, "loading.wall_velocity": SLOW_BONDED_SPEED, "time.step": "0.2 us",
                   "loading.max_packing_fraction": SLOW_BONDED_END, "loading.max_stress": 0}
    elif way == SLOW:
        slow, step = scale.slow_speed
        values |= {"mpm.cells": scale.slow_cells, "loading.wall_velocity": slow, "time.step": step}
    elif way == NODES:
        values |= {"sample.grains": scale.nodes_grains, **ON_NODES, **PAPER_STEP, "mpm.cells": NODES_CELLS,
                   "loading.max_packing_fraction": 0, "loading.max_strain": 0.3}
    elif way == EARLY:
        values |= {"sample.packing_fraction": round(START_PACKING_FRACTION * (1 + NODE_GAP / 2) ** 2, 4),
                   "mpm.cells": scale.slow_cells, "loading.max_packing_fraction": round((1 + NODE_GAP / 2) ** 2, 4)}
    elif way == HOOKE:
        values |= {"mpm.law": "small_strain_hooke", "mpm.cells": scale.slow_cells}
    return PlannedRun(packing_name(way, model, friction, seed), f"compaction-{model}", values, (way, model, friction))


def _single_grains(scale):
    elastic = {"mpm.cells": scale.grain_cells, "loading.max_strain": 0.4, "output.vtk": "false", "output.report": "false"}
    bonded = {"bpm.primaries": scale.primaries, "output.vtk": "false", "output.report": "false"}
    if scale.primaries < 1000:
        bonded["time.step"] = "0.5 us"
    other = bonded | {"bpm.primaries": 300, "time.step": "0.5 us", "loading.unload_at": "[]",
                      "loading.max_strain": 0.2}
    return [
        PlannedRun("grain_mpm_nodes", "diametral-mpm", elastic | ON_NODES | {"mpm.cells": 16, "loading.wall_velocity": "1 m/s"}),
        *(PlannedRun(f"grain_bpm_seed{seed}", "diametral-bpm", bonded | {"sample.seed": seed}) for seed in scale.grain_seeds),
        *(PlannedRun(attraction_name(*law), "diametral-bpm", other | {"bpm.exponent": law[0], "bpm.inner_friction": law[1]})
          for law in scale.attractions),
        PlannedRun("grain_mpm", "diametral-mpm", elastic),
        PlannedRun("grain_mpm_hooke", "diametral-mpm", elastic | {"mpm.law": "small_strain_hooke"}),
    ]
