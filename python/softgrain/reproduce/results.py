"""The runs that were made, opened, and their curves."""

from dataclasses import dataclass, field, replace

from .. import open_run
from .curves import compaction
from .plan import EARLY, START_PACKING_FRACTION


@dataclass(frozen=True)
class Results:
    """Runs of single grains by name; curves and runs of packings by (way, model, friction), one for each seed."""

    grains: dict = field(default_factory=dict)
    packings: dict = field(default_factory=dict)
    runs: dict = field(default_factory=dict)
    commands: dict = field(default_factory=dict)  # the words that make a grain's run, and the first of each kind of packing

    def curves(self, way, model, friction=0.0):
        return self.packings.get((way, model, friction), [])

    def command(self, *kind):
        """Of (way, model, friction), or of the name of a grain's run."""
        return self.commands.get(kind if len(kind) > 1 else kind[0], "")


def read_results(folder, runs):
    """Opens planned runs in a folder."""
    results = Results()
    for run in runs:
        opened = open_run(folder / run.name)
        if run.packing is None:
            kind = run.name.partition("_seed")[0]
            results.grains.setdefault(kind, []).append(opened)
            results.commands.setdefault(kind, run.words)
            continue
        results.runs.setdefault(run.packing, []).append(opened)
        results.packings.setdefault(run.packing, []).append(_curve(opened, run.packing[0]))
        results.commands.setdefault(run.packing, run.words)
    return results


def _curve(run, way):
    """Of grains that were made larger, Phi is that of those they stand for."""
    curve = compaction(run)
    return replace(curve, phi=curve.phi * START_PACKING_FRACTION / curve.phi[0]) if way == EARLY else curve
