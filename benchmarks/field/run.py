#!/usr/bin/python3
"""The soft-grain benchmark set: runs cases by the codes that are here, and writes tables, figures and a page.

    run.py [CASE...] [--codes softgrain,lammps] [--samples 3] [--program PATH] [-o DIR] [--keep] [--page]

Without cases all of them. Runs go to DIR (out/field); tables to results/*.csv, of which rows of codes that run now are
replaced and others stay; RESULTS.md shows them all. --keep takes softgrain's runs that are there. --page only writes the
page. CPU times are those of the programs and their children; one run measures all codes of a case one after the other."""

import argparse
import datetime
import platform
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "python")]

from field import lammps, liggghts, page, softgrain, yade  # noqa: E402
from field.cases import CASES  # noqa: E402
from field.work import CodeFailed, Place  # noqa: E402


def versions(program):
    """{code: version}, of those that are here."""
    found = {"reference": "", "softgrain": softgrain.version(program), "lammps": lammps.version(), "liggghts": liggghts.version(),
             "yade": yade.version()}
    return {code: words for code, words in found.items() if words or code == "reference"}


def processor():
    lines = [line for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name")]
    return lines[0].partition(":")[2].strip() if lines else platform.processor()


def measure(case, codes, options):
    """Curves of each code that has the case; a code that fails says so and is left out."""
    curves = {}
    for code, how in case.codes.items():
        if code not in codes:
            if options.codes is None:
                print(f"{case.name}: {code} is not here", file=sys.stderr)
            continue
        place = Place(Path(options.output).resolve() / case.name / code, options.program, HERE / case.name, options.samples, not options.keep)
        try:
            curves[code] = how(place)
        except CodeFailed as error:
            print(f"{case.name}, {code}: {error}", file=sys.stderr)
    return curves


def keep(case, curves, codes):
    """Tables of what was measured now."""
    rows = [row for code, some in curves.items() for row in page.rows_of(case, code, codes[code], some)]
    page.update(page.RESULTS / f"{case.name}.csv", page.header(case), rows, lambda row: row[0] in curves)
    spent = {code: np.mean([curve.cpu_seconds for curve in some]) for code, some in curves.items()}
    costs = []
    for code, some in curves.items():
        for variant in dict.fromkeys(curve.variant for curve in some):
            seconds = np.array([curve.cpu_seconds for curve in some if curve.variant == variant])
            ours = [curve.cpu_seconds for curve in curves.get("softgrain", []) if curve.variant == variant] or [spent.get("softgrain", 0)]
            ratio = f"{seconds.mean() / np.mean(ours):.3g}" if np.mean(ours) > 0 else ""
            if seconds.any():
                costs.append((case.name, code, codes[code], variant, len(seconds), f"{seconds.mean():.3g}", f"{seconds.std():.2g}", ratio,
                              processor(), datetime.date.today().isoformat()))
                print(f"{case.name:11} {code:10} {variant:22} {seconds.mean():8.2f} s  {ratio:>7} of softgrain's")
    page.update(page.RESULTS / "cost.csv", page.COST, costs, lambda row: row[0] == case.name and row[1] in curves)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="CASE", help=", ".join(case.name for case in CASES))
    parser.add_argument("--codes", help="with commas between them; left out: all that are here")
    parser.add_argument("--samples", type=int, default=3, help="of each packing")
    parser.add_argument("--program", default="softgrain", help="path of softgrain")
    parser.add_argument("-o", "--output", default="out/field", help="folder of the runs")
    parser.add_argument("--keep", action="store_true", help="take softgrain's runs that are there")
    parser.add_argument("--page", action="store_true", help="only write the page")
    options = parser.parse_args()
    chosen = [case for case in CASES if not options.cases or case.name in options.cases]
    unknown = set(options.cases) - {case.name for case in CASES}
    if unknown:
        parser.error(f"no such case: {', '.join(sorted(unknown))}")
    if "/" in options.program:
        options.program = str(Path(options.program).resolve())
    if not options.page:
        codes = versions(options.program)
        if options.codes:
            codes = {code: words for code, words in codes.items() if code in options.codes.split(",")}
        for case in chosen:
            curves = measure(case, codes, options)
            if curves:
                keep(case, curves, codes)
    print(page.write(CASES))


if __name__ == "__main__":
    main()
