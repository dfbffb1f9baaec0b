"""One verdict for each statement of the paper: our number, its spread over seeds, agrees or differs, and why."""

import json
from dataclasses import asdict, dataclass

import numpy as np

from .. import measure, open_run
from .curves import compaction, coordination_law, curvature, onset
from .plan import FRICTIONS, MODELS, START_PACKING_FRACTION, packing_name
from .single_grain import linear_strain, slope_ratio


@dataclass(frozen=True)
class Verdict:
    figure: str
    statement: str  # of the paper, in our words
    ours: str
    agrees: bool
    why: str = ""


@dataclass(frozen=True)
class Spread:
    """Mean and standard deviation over seeds."""

    mean: float
    deviation: float
    count: int

    @classmethod
    def of(cls, values):
        values = [value for value in values if value is not None]
        if not values:
            return cls(float("nan"), 0.0, 0)
        return cls(float(np.mean(values)), float(np.std(values)), len(values))

    def text(self, digits=2):
        plus_minus = f" ± {self.deviation:.{digits}f}" if self.count > 1 else ""
        return f"{self.mean:.{digits}f}{plus_minus}"


@dataclass(frozen=True)
class Results:
    """The runs that were made: those of single grains by name, packings' curves by (model, friction)."""

    grains: dict
    packings: dict


def read_results(folder, figures, scale):
    """Opens the runs in a folder."""
    grains = {name: open_run(folder / name) for name in ("grain_bpm", "grain_mpm", "grain_mpm_hooke")
              if "fig1" in figures}
    packings = {(model, friction): [compaction(open_run(folder / packing_name(model, friction, seed)))
                                    for seed in scale.seeds]
                for model in MODELS for friction in FRICTIONS if set(figures) - {"fig1"}}
    return Results(grains, packings)


def verdicts(results, figures):
    judges = {"fig1": _single_grains, "fig2": _stress, "fig3": _coordination, "fig4": _power_law}
    return [verdict for figure in figures for verdict in judges[figure](results)]


def _single_grains(results):
    bonded = results.grains["grain_bpm"]
    strain, stress = measure.envelope(bonded.series["strain"], measure.vertical_stress(bonded.series))
    flat = measure.plateau(strain, stress)
    sigma_i = measure.characteristic_stress(bonded)
    linear = linear_strain(strain, stress)
    slopes = [u.slope / 1e6 for u in measure.unloadings(bonded.series["strain"],
                                                         measure.vertical_stress(bonded.series))]
    serration = flat.deviation / flat.mean
    clusters = bonded.series["clusters"].max()
    yield Verdict("1", "BPM: linear up to a strain of about 2 %", f"to {100 * linear:.1f} % (within 10 % of the line)",
                  0.01 <= linear <= 0.04)
    yield Verdict("1", "BPM: then plastic at a constant threshold",
                  f"{flat.mean / 1e6:.3f} MPa, serrations of {100 * serration:.0f} %", serration < 0.3)
    yield Verdict("1", "BPM: the threshold is almost equal to sigma_I = F0/<a0>",
                  f"{flat.mean / sigma_i:.2f} sigma_I", 0.7 < flat.mean / sigma_i < 1.3,
                  "a frictionless packing yields at about a fifth of its cohesive pressure; inner friction would raise "
                  "it (experiments/diametral_bpm)")
    yield Verdict("1", "BPM: unloading is linear, its slope grows slightly with strain",
                  " then ".join(f"{slope:.1f}" for slope in slopes) + " MPa",
                  len(slopes) > 1 and 1 <= slopes[1] / slopes[0] < 1.5,
                  "slopes scatter by half from aggregate to aggregate (experiments/diametral_bpm)")
    yield Verdict("1", "BPM: the grain does not break", f"{clusters:.0f} piece", clusters == 1)
    for name, law in (("grain_mpm_hooke", "small-strain Hooke"), ("grain_mpm", "neo-Hookean")):
        run = results.grains[name]
        growth = slope_ratio(*measure.envelope(run.series["strain"], measure.vertical_stress(run.series)))
        yield Verdict("1", "MPM: elastic, with a lower slope at large strain",
                      f"{law}: the slope beyond 25 % is {growth:.2f} of that between 10 and 20 %", growth < 1,
                      "" if growth < 1 else "at finite strain an elastic grain stiffens; only the small-strain law gives "
                      "the paper's shape")


def _stress(results):
    for (model, friction), curves in results.packings.items():
        bend = Spread.of([curvature(c) for c in curves])
        sigma0 = Spread.of([c.reference_stress / 1e3 for c in curves])
        linear = abs(bend.mean) < 0.1
        expected = "linear" if model == "mpm" else "convex"
        yield Verdict("2", f"{model.upper()}, mu = {friction:g}: sigma/sigma0 over eps' is {expected}",
                      f"half-way {bend.text()} of the rise below the chord; sigma0 = {sigma0.text(0)} kPa",
                      linear if model == "mpm" else bend.mean > 0.1,
                      "" if model == "bpm" else "stress grows without bound towards Phi = 1, so no line fits to the end")
    for model in MODELS:
        ratio = Spread.of([_stress_ratio(a, b) for a, b in
                           zip(results.packings[model, 0.5], results.packings[model, 0.0])])
        yield Verdict("2", f"{model.upper()}: friction has little effect on the stress",
                      f"mu = 0.5 over mu = 0: {ratio.text()} in the mean", abs(ratio.mean - 1) < 0.15)


def _stress_ratio(rough, smooth):
    """Mean ratio of the stresses at equal Phi, beyond the reference state."""
    phi = np.linspace(0.82, min(rough.phi.max(), smooth.phi.max()) - 0.01, 40)
    return float(np.mean(np.interp(phi, rough.phi, rough.stress) / np.interp(phi, smooth.phi, smooth.stress)))


def _coordination(results):
    worst = max(abs(c.phi / (START_PACKING_FRACTION * np.exp(c.strain)) - 1).max()
                for curves in results.packings.values() for c in curves)
    yield Verdict("3", "Phi = 0.7 exp(eps) while grains keep their area", f"Phi_0 to {worst:.0e}", worst < 1e-3,
                  "exact for undeformed areas; deformed grains lose up to "
                  f"{100 * (1 - min((c.phi_deformed / c.phi).min() for c in results.packings['mpm', 0.0])):.0f} % (MPM)")
    for (model, friction), curves in results.packings.items():
        starts = [onset(c) for c in curves]
        eps, phi = Spread.of([s and s[0] for s in starts]), Spread.of([s and s[1] for s in starts])
        yield Verdict("3", f"{model.upper()}, mu = {friction:g}: jams at eps = 0.08, Phi = 0.75, with Z = 3",
                      f"Z = 3 at eps = {eps.text()}, Phi_0 = {phi.text()}", 0.70 <= phi.mean <= 0.80,
                      "a pair counts only while it carries force; a wall ten times slower changes nothing (experiments/compaction_mpm)")
    for (model, friction), curves in results.packings.items():
        most = Spread.of([c.z.max() for c in curves])
        yield Verdict("3", f"{model.upper()}, mu = {friction:g}: Z reaches 5.5", f"{most.text()}",
                      5.2 <= most.mean <= 5.8, "walls hold grains but do not count: few grains have a lower Z")
    for model, words in (("mpm", "little"), ("bpm", "no")):
        change = Spread.of([_mean_z_change(a, b) for a, b in
                            zip(results.packings[model, 0.5], results.packings[model, 0.0])])
        yield Verdict("3", f"{model.upper()}: friction has {words} effect on Z",
                      f"mean change of Z at equal Phi {change.text()}", abs(change.mean) < 0.3)
    ends = [min(0.4, c.strain.max()) for c in results.packings["bpm", 0.0]]
    phi = Spread.of([np.interp(end, c.strain, c.phi_deformed) for end, c in zip(ends, results.packings["bpm", 0.0])])
    yield Verdict("3", "BPM: Phi = 0.93 at a strain of 40 %",
                  f"deformed outlines fill {phi.text()} at eps = {Spread.of(ends).text()}", abs(phi.mean - 0.93) < 0.02, "0.7 exp(0.4) = 1.04; Phi = 0.93 is eps = 0.28 if grains keep their area")


def _mean_z_change(rough, smooth):
    """Mean difference of Z at equal Phi, beyond the reference state."""
    phi = np.linspace(0.82, min(rough.phi.max(), smooth.phi.max()) - 0.01, 40)
    return float(np.mean(np.interp(phi, rough.phi, rough.z) - np.interp(phi, smooth.phi, smooth.z)))


def _power_law(results):
    for (model, friction), curves in results.packings.items():
        laws = [law for law in map(coordination_law, curves) if law]
        exponent = Spread.of([law.exponent for law in laws])
        half = np.mean([law.half_width for law in laws]) if laws else float("nan")
        yield Verdict("4", f"{model.upper()}, mu = {friction:g}: Z - Z0 ~ (Phi - Phi0)^0.5 from Phi0 = 0.8",
                      f"exponent {exponent.text()} (fit's 95 %: ± {half:.2f})", 0.4 <= exponent.mean <= 0.6,
                      "at 5 m/s the packing is not yet homogeneous at Phi = 0.8, where the law starts; 300 elastic grains at "
                      "0.5 m/s: 0.58 ± 0.06 (experiments/compaction_mpm)")


def write(found, results, folder, scale_name, program):
    """verdicts.md and verdicts.json."""
    (folder / "verdicts.json").write_text(json.dumps([asdict(v) for v in found], indent=1, default=bool) + "\n")
    seeds = max((len(curves) for curves in results.packings.values()), default=1)
    lines = ["# The paper's statements, held against these runs", "",
             f"Scale `{scale_name}`, {seeds} seed{'s' if seeds > 1 else ''} for each packing; ± is the standard deviation over seeds. "
             f"{program}. Nothing was tuned to agree.", "",
             "| Fig. | the paper | here | | why |", "|---|---|---|---|---|"]
    lines += [f"| {v.figure} | {v.statement} | {v.ours} | {'agrees' if v.agrees else 'differs'} | "
              f"{v.why if not v.agrees or v.statement.startswith('Phi') else ''} |" for v in found]
    (folder / "verdicts.md").write_text("\n".join(lines) + "\n")
