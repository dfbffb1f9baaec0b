"""python3 -m softgrain.compare RUN CURVE: how far a measured curve and a run's are apart."""

import sys
from pathlib import Path

import softgrain

from .. import plot
from ..verb import carry_out
from . import compare, draw_comparison, read_measured

FORMATS = (".png", ".svg", ".pdf")


def report(comparison, name) -> str:
    """What is printed: values in SI, and as shares of the largest measured one."""
    most = abs(comparison.measured).max() or 1
    where, difference = comparison.largest
    return (f"quantity             {name}\n"
            f"common range         strain {comparison.strain[0]:.4g} to {comparison.strain[-1]:.4g}, {len(comparison.strain)} points\n"
            f"rms difference       {comparison.rms:.4g}, {100 * comparison.rms / most:.2f} % of the largest measured\n"
            f"largest difference   {difference:+.4g}, {100 * difference / most:+.2f} % of the largest measured, at strain {where:.4g}")


def draw(options):
    run = softgrain.open(options.run)
    path = Path(options.output) if options.output else run.path / "figures" / "compare.png"
    if path.suffix not in FORMATS:
        raise ValueError(f"--output {path}: the name must end in one of {', '.join(FORMATS)}")
    curve = read_measured(options.curve)
    comparison = compare(run, curve)
    path.parent.mkdir(parents=True, exist_ok=True)
    with plot.style():
        plot.save(draw_comparison(comparison, curve.name, run.name), path, [run])
    print(report(comparison, curve.name), path, sep="\n")


def main(arguments=None):
    return carry_out("compare", arguments, draw)


if __name__ == "__main__":
    sys.exit(main())
