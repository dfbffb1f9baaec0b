"""The paragraph of a paper, in words and numbers of one run."""

import re

from ..run import Run
from .facts import Facts

# name of the law: (in words, its parameters beside E and nu, whom to cite)
LAWS = {
    "neo_hookean": ("compressible neo-Hookean", (), ()),
    "neo_hookean_quadratic": ("compressible neo-Hookean (quadratic volumetric energy)", (), ()),
    "hencky": ("Hencky", (), ()),
    "corotated": ("corotated linear elastic", (), ()),
    "small_strain_hooke": ("linear elastic (small strains)", (), ()),
    "st_venant_kirchhoff": ("St. Venant-Kirchhoff", (), ()),
    "yeoh": ("Yeoh", ("c20", "c30"), ()),
    "von_mises": ("elastic-plastic (von Mises)", ("yield_stress", "hardening_modulus", "saturation_stress", "saturation_rate",
                                                  "viscosity", "kinematic_modulus"), ()),
    "mooney_rivlin": ("Mooney-Rivlin", ("c01",), ()),
    "ogden": ("Ogden", ("ogden_exponent_1", "ogden_exponent_2", "ogden_exponent_3", "ogden_share_2", "ogden_share_3"),
              ("ogden1972",)),
    "norton": ("creeping (Norton)", ("creep_rate", "creep_stress", "creep_exponent"), ()),
    "prony": ("viscoelastic (Prony series)", tuple(f"relaxation_{what}_{k}" for k in (1, 2, 3, 4) for what in ("share", "time")),
              ("reese1998",)),
}
STRESSES = ("modulus", "stress", "c20", "c30", "c01")
LOADINGS = {
    "diametral": "squeezed between two rigid walls, the upper one moving at {speed}",
    "compaction": "compacted in a box of rigid walls by the upper wall, which moved at {speed}",
    "isotropic": "compacted isotropically by four rigid walls, those opposite coming together at {speed}",
    "triaxial": "compressed triaxially by rigid walls at {speed}, four side walls keeping {confining}",
    "biaxial": "compressed biaxially by rigid walls at {speed}, the side walls keeping {confining}",
    "shear": "sheared with a periodic cell that keeps {confining}",
    "die": "compacted in a die of rigid walls at {speed}",
    "relaxation": "compacted by rigid walls at {speed} and then held at rest",
    "stages": "loaded by rigid walls along the stages that the case file lists",
}
PREFIXES = (("G", 1e9), ("M", 1e6), ("k", 1e3), ("", 1), ("m", 1e-3), ("µ", 1e-6), ("n", 1e-9))


def paragraph(run: Run, facts: Facts) -> tuple[str, list[str]]:
    """(text with [key] where a work is cited, keys in the order of the text)."""
    case = run.case
    sentences = [
        _program(facts),
        _grains(case, facts) + ("" if facts.model == "bpm" else " " + _discretisation(case, facts)),
        _contact(case, facts),
        _loading(case, facts),
        _steps(case, facts),
        _quality(case, facts),
        f"The resolved case (SHA-256 {facts.case_hash[:16]}, seed {case['sample']['seed']}) reproduces the run with the same build on "
        f"any number of threads; the content hash of its last state is {facts.content_hash}.",
        *_doubts(run),
    ]
    text = " ".join(sentences)
    return text, list(dict.fromkeys(key for keys in re.findall(r"\[([a-z0-9, ]+)\]", text) for key in keys.split(", ")))


def quantity(value, unit) -> str:
    """Four digits with a prefix: 0.005, "m" -> "5 mm"."""
    prefix, factor = next(((p, f) for p, f in PREFIXES if abs(value) >= 0.9995 * f), PREFIXES[-1]) if value else ("", 1)
    return f"{value / factor:.4g} {prefix}{unit}".strip()


def latex(text) -> str:
    """The same text for LaTeX: citations as \\cite, and what LaTeX would take for a command escaped."""
    text = re.sub(r"([%&#_])", r"\\\1", text)
    text = re.sub(r"\[([a-z0-9, ]+)\]", lambda found: rf"\cite{{{found[1].replace(' ', '')}}}", text)
    for plain, mathematics in (("F0/<a0>", r"$F_0/\langle a_0\rangle$"), ("F0", "$F_0$"), ("kg/m^3", "kg/m$^3$"), ("µ", r"$\mu$"),
                               (" nu =", r" $\nu$ ="), (" E =", " $E$ =")):
        text = text.replace(plain, mathematics)
    return text


def _program(facts):
    return (f"The simulations were carried out with softgrain {facts.version} (commit {facts.commit}) [softgrain], in two dimensions "
            "(plane strain), by nonsmooth contact dynamics [moreau1988, jean1999].")


def _grains(case, facts):
    grain = case["grain"]
    single = case["experiment"]["loading"] == "diametral"
    if single:
        size = f"a radius of {quantity(grain['radius'], 'm')}"
    else:
        size = _diameters(case["sample"])
    who = f"{'one disk' if facts.grains == 1 else f'{facts.grains} disks'} of {size} and a density of {grain['density']:.4g} kg/m^3"
    if facts.model == "bpm":
        bpm = case["bpm"]
        force = (f"a force F0 = {quantity(bpm['attraction'], 'N/m')}" if single else
                 f"an internal cohesive pressure F0/<a0> = {quantity(bpm['cohesive_pressure'], 'Pa')}")
        return (f"The sample consisted of {who}, by the bonded particle model [nezamabadi2017]: "
                f"aggregates of {_each(facts, 'rigid primary disks')}, with a ratio of diameters of {bpm['size_ratio']:.4g}, that attract one another with {force}, which decays with the exponent "
                f"{bpm['exponent']:.4g}, and have a coefficient of friction of {bpm['inner_friction']:.4g}.")
    name, keys, cited = LAWS[case["mpm"]["law"]]
    words = [f"E = {quantity(case['mpm']['young_modulus'], 'Pa')}", f"nu = {case['mpm']['poisson_ratio']:.4g}"]
    words += [f"{key.replace('_', ' ')} {_parameter(key, case['mpm'][key])}" for key in keys if case["mpm"][key]]
    cites = "".join(f" [{key}]" for key in cited)
    article = "an" if name[0] in "aeiouAEIOU" else "a"
    return f"The sample consisted of {who}, made of {article} {name} material{cites} with {', '.join(words)}."


def _each(facts, name):
    """"256 material points each (3072 in all)", or of one grain "256 material points"."""
    each = facts.particles / facts.grains
    about = "" if each.is_integer() else "about "
    return f"{facts.particles} {name}" if facts.grains == 1 else f"{about}{each:.0f} {name} each ({facts.particles} in all)"


def _diameters(sample):
    if sample["placed"]:
        return "given places and sizes"
    if sample["sizes"] == "list":
        return "diameters " + ", ".join(quantity(d, "m") for d in sample["diameters"])
    law = "lognormal (cut off) " if sample["sizes"] == "lognormal" else ""
    return f"{law}diameters between {quantity(sample['smallest_diameter'], 'm')} and {quantity(sample['largest_diameter'], 'm')}"


def _parameter(key, value):
    unit = ("Pa" if key.endswith(STRESSES) else "Pa s" if key == "viscosity" else "1/s" if key == "creep_rate" else
            "s" if "time" in key else "")
    return quantity(value, unit) if unit else f"{value:.4g}"


def _discretisation(case, facts):
    mpm = case["mpm"]
    points = _each(facts, "material points")
    grid = "a grid that fits the grain" if facts.grains == 1 else "grids that fit the grains"
    integrated = "explicitly" if mpm["integrator"] == "explicit" else "implicitly"
    if mpm["formulation"] == "updated_lagrangian":
        return f"It was discretised by the updated Lagrangian material point method [nezamabadi2017] with {points}."
    return (f"It was discretised by the total Lagrangian material point method with {points}, on {grid}, which equals "
            f"four-node finite elements with mean dilatation; time was integrated {integrated}.")


def _contact(case, facts):
    contact = case["contact"]
    grains = "" if facts.grains == 1 else f"{contact['friction']:.4g} between grains and "
    mean = f" and their mean {case['solver']['tolerance']:.4g}" if facts.model == "bpm" else ""
    return (f"Contact is unilateral (Signorini) with Coulomb friction, coefficient {grains}{contact['wall_friction']:.4g} at walls, "
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
