"""What a paper says of the grains of a run: how many, of which shape and size, and what they are made of."""

from .quantity import quantity

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
NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine")


def sample_of(case, facts) -> str:
    """All grains in one sentence, or in one for each kind."""
    if "kind" not in case:
        return f"The sample consisted of {_of_one_kind(case, facts)}."
    kinds = case["kind"]
    count = NUMBERS[len(kinds)] if len(kinds) < len(NUMBERS) else len(kinds)
    return " ".join([f"The sample consisted of {facts.grains} grains of {count} kinds.",
                     *(f"The kind {kind['name']}: {_of_kind(kind, case, facts)}." for kind in kinds)])


def discretisation_of(case, facts) -> str:
    """Of what deforms by material points; empty where nothing does."""
    if facts.model == "bpm" or not _deforms(case):
        return ""
    mpm = case["mpm"]
    points = f"{facts.particles} material points" if "kind" in case else each(facts, "material points")
    grid = "a grid that fits the grain" if facts.grains == 1 else "grids that fit the grains"
    if mpm["formulation"] == "updated_lagrangian":
        integrated = "implicitly" if mpm.get("lattice_integrator") == "implicit" else "explicitly"
        return (f"It was discretised by the updated Lagrangian material point method [nezamabadi2017] with {points}; "
                f"time was integrated {integrated}.")
    elements = "eight-node finite elements" if facts.in_space else "four-node finite elements with mean dilatation"
    integrated = "explicitly" if mpm["integrator"] == "explicit" or facts.in_space else "implicitly"
    return (f"It was discretised by the total Lagrangian material point method with {points}, on {grid}, which equals "
            f"{elements}; time was integrated {integrated}.")


def each(facts, name):
    """"256 material points each (3072 in all)", or of one grain "256 material points"."""
    number = facts.particles / facts.grains
    about = "" if number.is_integer() else "about "
    return f"{facts.particles} {name}" if facts.grains == 1 else f"{about}{number:.0f} {name} each ({facts.particles} in all)"


def _deforms(case):
    models = [kind.get("model", case["experiment"]["model"]) for kind in case.get("kind", [{}])]
    return "mpm" in models


def _of_one_kind(case, facts):
    grain, bpm = case["grain"], case["bpm"]
    single = case["experiment"]["loading"] == "diametral"
    size = f"a radius of {quantity(grain['radius'], 'm')}" if single else _diameters(case["sample"])
    count = "one" if facts.grains == 1 else facts.grains
    rigid = "rigid " if facts.model == "rigid" else ""
    who = f"{count} {rigid}{_shape(grain, facts.grains, facts.in_space)} of {size} and a density of {grain['density']:.4g} kg/m^3"
    if facts.model == "rigid":
        return who
    if facts.model == "mpm":
        return f"{who}, made of {_material({**case['mpm'], 'name': case['mpm']['law']})}"
    force = f"a force F0 = {quantity(bpm['force'], 'N') if facts.in_space else quantity(bpm['attraction'], 'N/m')}"
    return f"{who}, {_bonded(bpm, each(facts, _primaries(facts)), force if single else _cohesive_pressure(bpm, facts))}"


def _primaries(facts):
    return f"rigid primary {'spheres' if facts.in_space else 'disks'}"


def _cohesive_pressure(bpm, facts):
    return f"an internal cohesive pressure F0/{'<a0>^2' if facts.in_space else '<a0>'} = {quantity(bpm['cohesive_pressure'], 'Pa')}"


def _bonded(bpm, primaries, force):
    return (f"by the bonded particle model [nezamabadi2017]: aggregates of {primaries}, with a ratio of diameters of "
            f"{bpm['size_ratio']:.4g}, that attract one another with {force}, which decays with the exponent "
            f"{bpm['exponent']:.4g}, and have a coefficient of friction of {bpm['inner_friction']:.4g}")


def _of_kind(kind, case, facts):
    number = f"{kind['number']}" if kind.get("number") else f"a share of {kind['share']:.4g} of the area, in"
    model = kind.get("model", case["experiment"]["model"])
    rigid = model == "rigid"
    diameter = kind["diameter"]
    size = "given places and sizes" if case["sample"]["placed"] else _diameters(
        {"placed": [], "sizes": diameter["distribution"], "diameters": diameter["values"], "smallest_diameter": diameter["smallest"],
         "largest_diameter": diameter["largest"]})
    who = (f"{number} {'rigid ' if rigid else ''}{_shape(kind, kind.get('number') or 2, facts.in_space)} of {size} and a density of "
           f"{kind['density']:.4g} kg/m^3")
    if model == "bpm":
        bpm, primaries = {**case["bpm"], **kind["law"]}, f"{kind['primaries']} {_primaries(facts)} each"
        return f"{who}, {_bonded(bpm, primaries, _cohesive_pressure(bpm, facts))}"
    return who if rigid else f"{who}, made of {_material(kind['law'])}"


def _shape(grain, count, in_space):
    shape = grain.get("shape", "disk")
    many = "" if count == 1 else "s"
    if shape == "surface":
        return f"grain{many} with a surface of {len(grain['surface'][1])} triangles"
    if in_space:
        return f"sphere{many}"
    if shape == "ellipse":
        return f"ellipse{many} of aspect ratio {grain['aspect']:.4g}"
    if shape == "polygon":
        return f"regular polygon{many} of {grain['sides']} sides"
    if shape == "outline":
        return f"grain{many} with an outline of {len(grain['outline'])} points"
    return f"disk{many}"


def _diameters(sample):
    if sample["placed"]:
        return "given places and sizes"
    if sample["sizes"] == "list":
        return "diameters " + ", ".join(quantity(d, "m") for d in sample["diameters"])
    law = "lognormal (cut off) " if sample["sizes"] == "lognormal" else ""
    return f"{law}diameters between {quantity(sample['smallest_diameter'], 'm')} and {quantity(sample['largest_diameter'], 'm')}"


def _material(law):
    name, keys, cited = LAWS[law["name"]]
    words = [f"E = {quantity(law['young_modulus'], 'Pa')}", f"nu = {law['poisson_ratio']:.4g}"]
    words += [f"{key.replace('_', ' ')} {_parameter(key, law[key])}" for key in keys if law[key]]
    cites = "".join(f" [{key}]" for key in cited)
    article = "an" if name[0] in "aeiouAEIOU" else "a"
    return f"{article} {name} material{cites} with {', '.join(words)}"


def _parameter(key, value):
    unit = ("Pa" if key.endswith(STRESSES) else "Pa s" if key == "viscosity" else "1/s" if key == "creep_rate" else
            "s" if "time" in key else "")
    return quantity(value, unit) if unit else f"{value:.4g}"
