"""One small run of each model, in the plane and in space, by the program itself; made once for all tests of a file."""

import functools
import tempfile
from pathlib import Path

import softgrain

FOLDER = tempfile.TemporaryDirectory()
OUTPUT = {"snapshots": 6, "samples": 60, "report": False, "vtk": False}
CASES = {
    "bonded": {"bpm": {"primaries": 60}, "loading": {"wall_velocity": "2 m/s", "max_strain": 0.1, "unload_at": [0.05]}},
    "elastic": {"experiment": {"model": "mpm"}, "mpm": {"cells": 4}, "loading": {"max_strain": 0.2, "unload_at": []}},
    "packing": {"experiment": {"model": "mpm", "loading": "compaction"}, "mpm": {"cells": 4}, "contact": {"friction": 0.3},
                "sample": {"grains": 6, "packing_fraction": 0.6}, "loading": {"wall_velocity": "5 m/s", "max_strain": 0.4}},
}
IN_SPACE = {
    "bonded_spheres": {"experiment": {"model": "bpm", "loading": "isotropic", "dimension": 3}, "bpm": {"primaries": 20, "library": 1},
                       "sample": {"grains": 4, "packing_fraction": 0.3}, "loading": {"wall_velocity": "10 m/s", "max_strain": 0.35, "unload_at": []}},
}


@functools.cache
def small_run(name) -> softgrain.Run:
    """The run of CASES[name] or IN_SPACE[name]."""
    return softgrain.run_case(softgrain.Case({**(CASES | IN_SPACE)[name], "output": OUTPUT}), Path(FOLDER.name) / name)
