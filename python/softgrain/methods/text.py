"""The paragraph of a paper, in words and numbers of one run."""

import re

from ..run import Run
from .facts import Facts
from .grains import discretisation_of, sample_of
from .quantity import quantity

LOADINGS = {
    "diametral": "squeezed between two rigid walls, the upper one moving at {speed}",
    "compaction": "compacted in a box of rigid walls by the upper wall, which moved at {speed}",
    "isotropic": "compacted isotropically by rigid walls, those opposite coming together at {speed}",
    "triaxial": "compressed triaxially by rigid walls at {speed}, four side walls keeping {confining}",
    "biaxial": "compressed biaxially by rigid walls at {speed}, the side walls keeping {confining}",
    "shear": "sheared with a periodic cell that keeps {confining}",
    "die": "compacted in a die of rigid walls at {speed}",
    "relaxation": "compacted by rigid walls at {speed} and then held at rest",
    "stages": "loaded by rigid walls along the stages that the case file lists",
}


def paragraph(run: Run, facts: Facts) -> tuple[str, list[str]]:
    """(text with [key] where a work is cited, keys in the order of the text)."""
    case = run.case
    sentences = [
        _program(facts),
        sample_of(case, facts),
        discretisation_of(case, facts),
        _contact(case, facts),
        _loading(case, facts),
        _steps(case, facts),
        _quality(case, facts),
        f"The resolved case (SHA-256 {facts.case_hash[:16]}, seed {case['sample']['seed']}) reproduces the run with the same build on "
        f"any number of threads; the content hash of its last state is {facts.content_hash}.",
        *_doubts(run),
    ]
    text = " ".join(filter(None, sentences))
    return text, list(dict.fromkeys(key for keys in re.findall(r"\[([a-z0-9, ]+)\]", text) for key in keys.split(", ")))


def latex(text) -> str:
    """The same text for LaTeX: citations as \\cite, and what LaTeX would take for a command escaped."""
    text = re.sub(r"([%&#_])", r"\\\1", text)
    text = re.sub(r"\[([a-z0-9, ]+)\]", lambda found: rf"\cite{{{found[1].replace(' ', '')}}}", text)
    for plain, mathematics in (("F0/<a0>", r"$F_0/\langle a_0\rangle$"), ("F0", "$F_0$"), ("kg/m^3", "kg/m$^3$"), ("µ", r"$\mu$"),
                               (" nu =", r" $\nu$ ="), (" E =", " $E$ =")):
        text = text.replace(plain, mathematics)
    return text


def _program(facts):
    dimensions = "three dimensions" if facts.in_space else "two dimensions (plane strain)"
    return (f"The simulations were carried out with softgrain {facts.version} (commit {facts.commit}) [softgrain], in {dimensions}, "
            "by nonsmooth contact dynamics [moreau1988, jean1999].")


def _contact(case, facts):
    contact = case["contact"]
    grains = "" if facts.grains == 1 else f"{contact['friction']:.4g} between grains and "
    pairs = " (pairs of kinds have the values of the case file)" if case.get("pair") else ""
    mean = f" and their mean {case['solver']['tolerance']:.4g}" if facts.model == "bpm" else ""
    return (f"Contact is unilateral (Signorini) with Coulomb friction, coefficient {grains}{contact['wall_friction']:.4g} at walls{pairs}, "
            f"and restitution {contact['restitution']:.4g}, solved by nonlinear Gauss-Seidel; a step counts as converged when no "
            f"residual of the law of contact exceeds {facts.residual_limit:.4g}{mean}.")


def _loading(case, facts):
    loading = case["loading"]
    words = LOADINGS[case["experiment"]["loading"]].format(speed=quantity(loading["wall_velocity"], "m/s"),
                                                           confining=quantity(loading["confining_stress"], "Pa"))
    box = case["box"]
    if box.get("y") == "periodic" and case["experiment"]["loading"] != "shear":
        words = f"loaded by a cell that is periodic along x and y and follows the path {case['experiment']['loading']} of the case file"
    elif box.get("x") == "periodic" and box.get("y") != "periodic":
        words += " (the box is periodic along x)"
    turns = f", unloaded at {', '.join(f'{eps:.4g}' for eps in loading['unload_at'])}," if loading["unload_at"] else ""
    who = "The grain was" if facts.grains == 1 else "They were"
    return f"{who} {words}{turns} up to a strain of {facts.strain:.3g}."


def _steps(case, facts):
    low, high = facts.time_step
    step = quantity(high, "s") if low > 0.99 * high else f"between {quantity(low, 's')} and {quantity(high, 's')} (means between rows)"
    text = f"The run took {facts.steps} steps of {step}."
    if facts.inertial_number is None:
        return text
    median, most = facts.inertial_number
    which = "of the grain, with its diameter and the vertical stress, " if case["experiment"]["loading"] == "diametral" else ""
    return f"{text} The inertial number {which}was {median:.1e} in the median under load, {most:.1e} at most."


def _quality(case, facts):
    return (f"{facts.steps_converged} of the {facts.steps} steps converged; relative to the mean radius of "
            f"{'a primary' if facts.model == 'bpm' else 'a grain'}, the largest residual was {facts.residual:.1e} and the largest overlap "
            f"{facts.overlap:.1e}; the energy balance closed to {facts.energy_error:.1e} of the largest energy.")


def _doubts(run):
    """What must not be left out."""
    notes = []
    if run.info.get("state") != "done":
        notes.append(f"the run is not done (state: {run.info.get('state', 'unknown')})")
    if run.info["program"]["commit"].endswith("-dirty"):
        notes.append("the program was built from sources that differ from its commit")
    return [f"NOTE: {note}." for note in (*notes, *(f"the program doubts this run: {doubt}" for doubt in run.doubts))]
