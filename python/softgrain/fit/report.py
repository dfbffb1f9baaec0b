"""What a fit found, in words, as JSON and as a page: values only where the curve gives them."""

import math
import shlex

import numpy as np

from .estimate import CONFIDENCE, DETERMINED

ELASTIC_PAIR = ("mpm.young_modulus", "mpm.poisson_ratio")


def findings(problem, estimate) -> dict:
    """All numbers, SI; `value` is None where the curve does not determine a parameter."""
    values, low, high = problem.values(estimate.x), *_interval(problem, estimate)
    parameters = {key: dict(value=float(values[k]) if estimate.determined[k] else None, low=float(low[k]), high=float(high[k]),
                            determined=bool(estimate.determined[k]), at_bound=bool(estimate.at_bound[k]), start=float(problem.start[k]))
                  for k, key in enumerate(problem.free)}
    combinations = [dict(powers=dict(zip(problem.free, map(float, direction))), half_width=float(width),
                         determined=bool(width <= DETERMINED))
                    for direction, width in zip(estimate.directions, estimate.direction_half_widths)]
    return dict(parameters=parameters, combinations=combinations, plane_modulus=_plane_modulus(problem, estimate), confidence=CONFIDENCE,
                residual=float(estimate.noise), correlation=float(estimate.correlation), points=len(problem.within),
                strain=[float(problem.within[0]), float(problem.within[-1])], quantity=problem.curve.name, scale=problem.scale,
                converged=estimate.converged, runs=len(problem.runs), runs_made=problem.runs_made, cpu_seconds=problem.cpu_seconds,
                doubtful_runs=[str(path) for path in problem.doubtful])


def is_complete(found) -> bool:
    """Whether every free parameter has a value."""
    return found["converged"] and all(entry["determined"] for entry in found["parameters"].values())


def summary(found) -> str:
    """What is printed."""
    lines = [f"{'parameter':28}{'value (SI)':>14}   {100 * CONFIDENCE:.0f} % interval"]
    for key, entry in found["parameters"].items():
        value, note = (f"{entry['value']:.5g}", "") if entry["determined"] else ("-", f"   not determined to {100 * DETERMINED:.0f} %")
        note += " (at a bound)" if entry["at_bound"] else ""
        lines.append(f"{key:28}{value:>14}   {entry['low']:.4g} to {entry['high']:.4g}{note}")
    if found["plane_modulus"]:
        value, low, high = (found["plane_modulus"][name] for name in ("value", "low", "high"))
        lines.append(f"{'E/(1 - nu^2)':28}{value:14.5g}   {low:.4g} to {high:.4g}")
    if len(found["combinations"]) > 1:
        lines += ["", "combinations, from the singular values of the Jacobian in ln p:"]
        lines += [f"  {_product(entry['powers']):60} {_width(entry['half_width'])}" for entry in found["combinations"]]
    lines += ["", f"residuals: {100 * found['residual']:.2f} % of the largest measured value, {found['points']} points"]
    lines += [f"warning: {text}" for text in warnings_of(found)]
    return "\n".join(lines)


def warnings_of(found) -> list[str]:
    texts = []
    if not found["converged"]:
        texts.append("the search was not over after its last step: the values are those of its last place")
    if found["correlation"] > 1.5:
        texts.append(f"neighbouring residuals are alike (about {found['correlation']:.0f} points say one thing): the model does not "
                     "follow the curve within its noise; the intervals are widened for it, but they do not hold what the model lacks")
    idle = [key for key, entry in found["parameters"].items() if not entry["determined"]]
    if idle and len(found["parameters"]) > 1:
        texts.append(f"this curve does not determine {', '.join(idle)}: fix one of them from elsewhere (--set instead of --free), or "
                     "measure something else")
    if found["doubtful_runs"]:
        texts.append(f"{len(found['doubtful_runs'])} of {found['runs']} runs are doubtful; `softgrain info` tells why: "
                     f"{found['doubtful_runs'][0]}")
    return texts


def page(found, command, best) -> str:
    """fit.md; `best` is the directory of the run at the values found."""
    strain = " to ".join(f"{value:.4g}" for value in found["strain"])
    return (f"# Fit of {', '.join(found['parameters'])}\n\n```\n{shlex.join(command)}\n```\n\n"
            f"![Curve, fit and residuals](fit.png)\n\n```\n{summary(found)}\n```\n\n"
            f"The curve: {found['quantity']}, {found['points']} points at strains from {strain}. Least squares in the logarithms of the "
            f"parameters; residuals count alike, so errors of one size at all strains are assumed. The intervals are those of the problem "
            f"linearised at the end. A parameter counts as determined if its interval reaches at most {100 * DETERMINED:.0f} % to "
            f"either side. {found['runs']} runs, {found['runs_made']} of them made now, {found['cpu_seconds']:.0f} s of CPU time in all; that of the "
            f"values found: `{best}`.\n")


def _interval(problem, estimate):
    low = np.maximum(estimate.x - estimate.half_widths, problem.bounds[0])
    high = np.minimum(estimate.x + estimate.half_widths, problem.bounds[1])
    return problem.values(low), problem.values(high)


def _plane_modulus(problem, estimate):
    """E/(1 - nu^2), which a grain between walls follows at small strains (Hertz); d ln = d ln E + 2 nu^2/(1 - nu^2) d ln nu."""
    if not set(ELASTIC_PAIR) <= set(problem.free):
        return None
    values = dict(zip(problem.free, problem.values(estimate.x)))
    E, nu = (values[key] for key in ELASTIC_PAIR)
    weights = {ELASTIC_PAIR[0]: 1.0, ELASTIC_PAIR[1]: 2 * nu**2 / (1 - nu**2)}
    width = estimate.half_width_of([weights.get(key, 0.0) for key in problem.free])
    value = E / (1 - nu**2)
    return dict(value=value, low=value * math.exp(-width), high=value * math.exp(width), determined=width <= DETERMINED)


def _product(powers):
    """Each combination so that its largest power is positive."""
    turn = 1 if max(powers.values(), key=abs) > 0 else -1
    return " ".join(f"{key.rpartition('.')[2]}^{turn * power:.2f}" for key, power in powers.items())


def _width(half_width):
    if half_width > DETERMINED:
        return "not determined" + (f" (a factor of {math.exp(half_width):.1f} to either side)" if half_width < 5 else "")
    return f"determined to {100 * half_width:.2g} %"
