"""The paper's 29 statements, each with our number by the paper's recipe and, where that differs, by one changed ingredient."""

import numpy as np

from .. import measure
from . import causes
from .curves import coordination_law, curvature, difference, onset, ratio
from .geometry import coordination_of_inner, coordination_of_load, coordination_within
from .plan import ATTRACTIONS, EARLY, FAST, FRICTIONS, HOOKE, MODELS, NODES, SLOW, START_PACKING_FRACTION, attraction_name
from .single_grain import linear_strain, slope_ratio
from .verdict import Changed, Spread, Verdict, judge

JAMMING_STRAIN, JAMMING_SPREAD = 0.08, 0.02  # the paper's, and what still agrees, besides the deviation over samples
LINEAR = 0.1  # curvature below which a curve is a line
SIDES = (5.2, 5.8)  # what agrees with 5.5
EXPONENT = (0.4, 0.6)  # ... with 0.5
ELASTIC_GRAINS = {"grain_mpm": ("", ""), "grain_mpm_nodes": (causes.CONTACT_RULE, "with points on a lattice and contact on its nodes"),
                  "grain_mpm_hooke": (causes.LAW, "with small-strain Hooke")}
LITTLE = 0.15  # of a ratio of stresses that is "little effect"


def verdicts(results, figures):
    judges = {"fig1": _single_grains, "fig2": _stress, "fig3": _coordination, "fig4": _power_law}
    return [verdict for figure in figures for verdict in judges[figure](results)]


def _kinds(results):
    """(model, friction) of which there are packings by the paper's recipe; all four, unless runs are missing."""
    return [(model, friction) for model in MODELS for friction in FRICTIONS if results.curves(FAST, model, friction)]


def _models(results):
    """Models of which there are packings without and with friction."""
    return [model for model in MODELS if all((model, friction) in _kinds(results) for friction in FRICTIONS)]


def _loading(run):
    return measure.envelope(run.series["strain"], measure.vertical_stress(run.series))


def _single_grains(results):
    runs = results.grains["grain_bpm"]
    plateaus = [measure.plateau(*_loading(run)) for run in runs]
    linear = Spread.of([100 * linear_strain(*_loading(run)) for run in runs])
    serration = Spread.of([100 * flat.deviation / flat.mean for flat in map(_smooth_plateau, runs)])
    threshold = Spread.of([flat.mean / measure.characteristic_stress(run) for flat, run in zip(plateaus, runs)])
    pieces = max(run.series["clusters"].max() for run in runs)
    yield judge("1", "BPM: linear up to a strain of about 2 %", f"to {linear.text(1)} % (within 10 % of the line)",
                1 <= linear.mean <= 4)
    yield judge("1", "BPM: then plastic at a constant threshold",
                f"{Spread.of([flat.mean / 1e6 for flat in plateaus]).text(3)} MPa, serrations of {serration.text(0)} % (of means over 1 %)",
                serration.mean < 30)
    yield judge("1", "BPM: the threshold is almost equal to sigma_I = F0/<a0>", f"{threshold.text()} sigma_I",
                _is_threshold(threshold.mean), _attractions(results))
    yield _unloading(runs)
    yield judge("1", "BPM: the grain does not break", f"{pieces:.0f} piece", pieces == 1)
    yield from _elastic_grain(results)


def _smooth_plateau(run):
    strain, stress = _loading(run)
    return measure.plateau(strain, measure.moving_mean(strain, stress))


def _is_threshold(share):
    return 0.7 < share < 1.3


def _attractions(results):
    """Other exponents of the attraction, and friction between primaries, nearest to sigma_I first."""
    found = []
    for gamma, friction in ATTRACTIONS:
        name = attraction_name(gamma, friction)
        for run in results.grains.get(name, []):
            share = measure.plateau(*_loading(run)).mean / measure.characteristic_stress(run)
            words = f"{share:.2f} sigma_I with gamma = {gamma}" + (f", inner friction {friction:g}" if friction else "")
            found.append((abs(share - 1), Changed(causes.LAW, words, _is_threshold(share), results.command(name))))
    return [changed for _, changed in sorted(found, key=lambda pair: pair[0])]


def _unloading(runs):
    """The paper reads one grain: it agrees if a slight growth, of 1 to 1.5, is within the spread of our aggregates."""
    slopes = [[u.slope / 1e6 for u in measure.unloadings(run.series["strain"], measure.vertical_stress(run.series))] for run in runs]
    growth = Spread.of([pair[1] / pair[0] for pair in slopes if len(pair) > 1])
    first, second = (Spread.of([pair[k] for pair in slopes if len(pair) > 1]) for k in (0, 1))
    return judge("1", "BPM: unloading is linear, its slope grows slightly with strain",
                 f"{first.text(1)} MPa from 10 %, {second.text(1)} from 30 %: times {growth.text(1)}",
                 growth.mean + growth.deviation >= 1 and growth.mean - growth.deviation < 1.5,
                 remark="slopes scatter from aggregate to aggregate as much as they grow")


def _elastic_grain(results):
    growth = {name: slope_ratio(*_loading(runs[0])) for name, runs in results.grains.items() if name in ELASTIC_GRAINS}
    statement, words = "MPM: elastic, with a lower slope at large strain", "the slope beyond 25 % is {:.2f} of that between 10 and 20 %"
    hooke, neo_hooke = growth["grain_mpm_hooke"], growth["grain_mpm"]
    yield judge("1", statement, "small-strain Hooke: " + words.format(hooke), hooke < 1)
    changed = [Changed(cause, f"{growth[name]:.2f} {label}", growth[name] < 1, results.command(name))
               for name, (cause, label) in ELASTIC_GRAINS.items() if cause and name in growth]
    yield judge("1", statement, "neo-Hookean: " + words.format(neo_hooke), neo_hooke < 1, changed,
                "at finite strain an elastic grain stiffens")


def _stress(results):
    for model, friction in _kinds(results):
        yield _shape_of_stress(results, model, friction)
    yield from (_friction(results, model) for model in _models(results))


def _friction(results, model):
    """sigma/sigma0 with friction over that without, as Fig. 2 shows it; sigma itself; the same with a slow wall."""
    changed = []
    plain = _friction_on_stress(results, FAST, model, scaled=False)
    changed.append(Changed(causes.DEFINITION, f"sigma itself: {plain.text()}", _is_little(plain)))
    slow = _friction_on_stress(results, SLOW, model)
    if slow.count:
        changed.append(Changed(causes.SLOW_WALL, f"slow wall: {slow.text()}", _is_little(slow), results.command(SLOW, model)))
    scaled = _friction_on_stress(results, FAST, model)
    return judge("2", f"{model.upper()}: friction has little effect on the stress",
                 f"sigma/sigma0 with mu = 0.5 over mu = 0: {scaled.text()} (sigma: {plain.text()})", _is_little(scaled), changed)


def _is_little(spread):
    return abs(spread.mean - 1) < LITTLE


def _friction_on_stress(results, way, model, scaled=True):
    return Spread.of([ratio(rough, smooth, "stress", scaled=scaled)
                      for rough, smooth in zip(results.curves(way, model, 0.5), results.curves(way, model))])


def _shape_of_stress(results, model, friction):
    curves = results.curves(FAST, model, friction)
    bend = Spread.of([curvature(c) for c in curves])
    sigma0 = Spread.of([c.reference_stress / 1e3 for c in curves])
    statement = f"{model.upper()}, mu = {friction:g}: sigma/sigma0 over eps' is {'linear' if model == 'mpm' else 'convex'}"
    ours = f"half-way {bend.text()} of the rise below the chord; sigma0 = {sigma0.text(0)} kPa"
    if model == "bpm":
        return judge("2", statement, ours, bend.mean > LINEAR)
    changed = []
    for way, cause, words in ((NODES, causes.CONTACT_RULE, "points on the paper's lattice, contact on its nodes"),
                              (EARLY, causes.CONTACT_RULE, "outlines that meet 1.1 cells early"),
                              (HOOKE, causes.LAW, "small-strain Hooke"), (SLOW, causes.SLOW_WALL, "slow wall")):
        other = Spread.of([curvature(c) for c in results.curves(way, model, friction)])
        if other.count:
            changed.append(Changed(cause, f"{words}: {other.text()}", abs(other.mean) < LINEAR, results.command(way, model, friction)))
    return judge("2", statement, ours, abs(bend.mean) < LINEAR, changed)


def _coordination(results):
    yield _packing_fraction(results)
    yield from (_jamming(results, model, friction) for model, friction in _kinds(results))
    yield from (_largest(results, model, friction) for model, friction in _kinds(results))
    for model in reversed(_models(results)):
        words = "little" if model == "mpm" else "no"
        pairs = zip(results.curves(FAST, model, 0.5), results.curves(FAST, model))
        change = Spread.of([difference(rough, smooth, "z") for rough, smooth in pairs])
        yield judge("3", f"{model.upper()}: friction has {words} effect on Z", f"mean change of Z at equal Phi {change.text()}",
                    abs(change.mean) < 0.3)
    if ("bpm", 0.0) in _kinds(results):
        yield _closed_pores(results)


def _packing_fraction(results):
    worst = max(abs(c.phi / (START_PACKING_FRACTION * np.exp(c.strain)) - 1).max()
                for (way, _, _), curves in results.packings.items() if way == FAST for c in curves)
    lost = 100 * (1 - min((c.phi_deformed / c.phi).min() for (way, model, _), curves in results.packings.items()
                          if (way, model) == (FAST, "mpm") for c in curves))
    return judge("3", "Phi = 0.7 exp(eps) while grains keep their area", f"Phi_0 to {worst:.0e}", worst < 1e-3,
                 remark=f"exact for undeformed areas; deformed grains lose up to {lost:.0f} % (MPM)")


def _onset(results, way, model, friction):
    """(text, whether Z = 3 comes where the paper says) or None where there is no such run."""
    starts = [onset(c) for c in results.curves(way, model, friction)]
    if way == NODES:
        starts = [onset_of(run, coordination_of_load) for run in results.runs.get((way, model, friction), [])]
    return _words_of_onset(starts)


def _words_of_onset(starts):
    if not any(starts):
        return None
    eps, phi = Spread.of([s and s[0] for s in starts]), Spread.of([s and s[1] for s in starts])
    return (f"Z = 3 at eps = {eps.text(3)}, Phi_0 = {phi.text(3)}",
            abs(eps.mean - JAMMING_STRAIN) <= JAMMING_SPREAD + eps.deviation)


def onset_of(run, coordination, z=3.0, last=0.16):
    """(eps, Phi) where coordination(snapshot) first reaches `z` from one snapshot to the next, up to a strain of `last`; None
    if it does not."""
    times = run.times
    strain, phi = (np.interp(times, run.series["time"], run.series[name]) for name in ("strain", "phi_0"))
    below = None
    for k in np.flatnonzero(strain <= last):
        value = coordination(run[int(k)])
        if value >= z and below is not None:
            share = (z - below) / (value - below)
            return tuple(float(values[k - 1] + share * (values[k] - values[k - 1])) for values in (strain, phi))
        if value >= z:
            return float(strain[k]), float(phi[k])
        below = value
    return None


def _jamming(results, model, friction):
    ours, agrees = _onset(results, FAST, model, friction) or ("Z stays below 3", False)
    changed = []
    for way, cause, words in ((NODES, causes.CONTACT_RULE, "updated Lagrangian with contact on grid nodes"),
                              (EARLY, causes.CONTACT_RULE, "outlines that meet 1.1 cells early, as nodes do"),
                              (SLOW, causes.SLOW_WALL, "slow wall")):
        found = _onset(results, way, model, friction)
        if found:
            changed.append(Changed(cause, f"{words}: {found[0]}", found[1], results.command(way, model, friction)))
    if model == "bpm":
        changed += [_through_centres(results, friction), _listed(results, friction)]
    return judge("3", f"{model.upper()}, mu = {friction:g}: jams at eps = 0.08, Phi = 0.75, with Z = 3", ours, agrees, changed)


def _through_centres(results, friction):
    """The same runs, R taken through the centres of the outermost primaries: they fill 0.82 of a grain, so that one has the
    radius a = R (0.82/N)^(1/2), and Phi is smaller by (1 + a/R)^2. The strain counts from where that Phi is 0.7."""
    starts = []
    for curve, run in zip(results.curves(FAST, "bpm", friction), results.runs[FAST, "bpm", friction]):
        phi, found = curve.phi / (1 + np.sqrt(0.82 / run.case["bpm"]["primaries"])) ** 2, onset(curve)
        if found:
            at = float(np.interp(found[0], curve.strain, phi))
            starts.append((float(np.log(at / START_PACKING_FRACTION)), at))
    words, agrees = _words_of_onset(starts) or ("Z stays below 3", False)
    return Changed(causes.DEFINITION, f"with R through the centres of the outermost primaries, from where that Phi is 0.7: {words}",
                   agrees, results.command(FAST, "bpm", friction))


def _listed(results, friction):
    """Where pairs count whose outlines are nearer than the cut-off of the attraction, delta = a0, touching or not."""
    runs = results.runs.get((FAST, "bpm", friction), [])
    starts = [onset_of(run, lambda s: coordination_within(s, 2 * s.particles["radius"].mean())) for run in runs]
    words, agrees = _words_of_onset(starts) or ("Z stays below 3", False)
    return Changed(causes.DEFINITION, f"counted within the cut-off of the attraction: {words}", agrees)


def _largest(results, model, friction):
    most = Spread.of([c.z.max() for c in results.curves(FAST, model, friction)])
    changed = []
    inner = Spread.of([coordination_of_inner(run[len(run) - 1]) for run in results.runs.get((FAST, model, friction), [])])
    sides = Spread.of([c.sides.max() for c in results.curves(FAST, model, friction)])
    for value, words in ((sides, "sides of a grain as a polygon, a wall being a side"), (inner, "neighbours of a grain that touches no wall")):
        changed.append(Changed(causes.DEFINITION, f"{value.text()} {words}", SIDES[0] <= value.mean <= SIDES[1]))
    return judge("3", f"{model.upper()}, mu = {friction:g}: Z reaches 5.5", most.text(), SIDES[0] <= most.mean <= SIDES[1], changed)


def _closed_pores(results):
    curves = results.curves(FAST, "bpm")
    ends = [min(0.4, c.strain.max()) for c in curves]
    phi = Spread.of([np.interp(end, c.strain, c.phi_deformed) for end, c in zip(ends, curves)])
    agrees = abs(phi.mean - 0.93) < 0.02
    arithmetic = "" if agrees else causes.ARITHMETIC
    return Verdict("3", "BPM: Phi = 0.93 at a strain of 40 %", f"outlines fill {phi.text()} at eps = {Spread.of(ends).text()}", agrees,
                   arithmetic or causes.AS_STATED,
                   "by the paper's own Phi = 0.7 exp(eps), 0.4 gives 1.04, and 0.93 is eps = 0.28; 0.7 (1 + eps) gives 0.98")


def _exponent(results, way, model, friction, name="z"):
    """(text, whether it is near 1/2) or None."""
    laws = [law for law in (coordination_law(c, name=name) for c in results.curves(way, model, friction)) if law]
    if not laws:
        return None
    exponent = Spread.of([law.exponent for law in laws])
    half = np.mean([law.half_width for law in laws])
    return f"{exponent.text()} (fit's 95 %: ± {half:.2f})", EXPONENT[0] <= exponent.mean <= EXPONENT[1]


def _power_law(results):
    for model, friction in _kinds(results):
        ours, agrees = _exponent(results, FAST, model, friction) or ("too few samples", False)
        changed = []
        for way, cause, words in ((EARLY, causes.CONTACT_RULE, "outlines that meet 1.1 cells early"), (SLOW, causes.SLOW_WALL, "slow wall")):
            rough = friction if results.curves(way, model, friction) or model == "mpm" else 0.0  # it does nothing to bonded grains
            found = _exponent(results, way, model, rough)
            if found:
                words += "" if rough == friction else f", mu = {rough:g}"
                changed.append(Changed(cause, f"{words}: exponent {found[0]}", found[1], results.command(way, model, rough)))
        yield judge("4", f"{model.upper()}, mu = {friction:g}: Z - Z0 ~ (Phi - Phi0)^0.5 from Phi0 = 0.8", f"exponent {ours}", agrees,
                    changed)
