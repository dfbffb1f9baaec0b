"""What must hold whatever a case says, tried on random cases.

    random_cases.py PROGRAM [--first 0] [--count 100] [--keep DIR]

Case n is the same on every machine. Even n are tame: every number is sensible beside the others, so that the run must
reach its end and be trusted. Odd n are wild: one to four keys lie anywhere in their documented range, so that the run
may be refused or break down, but must say so. Exit status 1 if a property fails; the case is then printed.
"""

import argparse
import contextlib
import csv
import json
import math
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

DONE, REFUSED, BROKE_DOWN, DOUBTFUL, STOPPED = 0, 2, 3, 5, 75
LAWS = ["neo_hookean", "neo_hookean_quadratic", "hencky", "corotated", "small_strain_hooke", "st_venant_kirchhoff"]
LAWS_OF_MORE = ["yeoh", "mooney_rivlin", "ogden", "von_mises", "norton", "prony"]  # that take more than E and nu
REMEMBER = ["von_mises", "norton", "prony"]  # whose points cannot move through a lattice
SOFTENING = ["small_strain_hooke", "st_venant_kirchhoff"]
OFTEN = 0.4  # share of LAWS_OF_MORE
SHAPED = 0.2  # share of elastic grains that are no disks
LONGEST = 4.0 if "SOFTGRAIN_TORTURE" in os.environ else 1.0  # seconds of one thread that a case may take by `check`
TIME_LIMIT = "8 s"  # at which a run is asked to stop


class Broken(Exception):
    """A property that does not hold."""


def ensure(holds, sentence):
    if not holds:
        raise Broken(sentence)


def log_uniform(draw, low, high):
    return math.exp(draw.uniform(math.log(low), math.log(high)))


def text_of(value):
    return json.dumps(value) if not isinstance(value, float) else repr(value)


def case_text(keys):
    tables = {}
    for name, value in keys.items():
        table, key = name.split(".")
        tables.setdefault(table, []).append(f"{key} = {text_of(value)}\n")
    return "".join(f"[{table}]\n" + "".join(lines) for table, lines in tables.items())


# ---------------------------------------------------------------------------------------------------- the cases


def tame_case(draw):
    """Lengths, moduli, densities and speeds over decades, but in proportion."""
    model = draw.choice(["mpm", "mpm", "bpm"])
    loading = draw.choice(["diametral", "compaction", "isotropic"])
    box = loading != "diametral"
    radius, density = log_uniform(draw, 1e-5, 1e-1), log_uniform(draw, 300, 9000)
    keys = {"experiment.model": model, "experiment.loading": loading, "grain.density": density,
            "sample.seed": draw.randrange(10**6), "contact.wall_friction": draw.choice([0.0, draw.uniform(0, 1)]),
            "output.samples": draw.randrange(5, 60), "output.snapshots": draw.randrange(3, 6),
            "output.vtk": draw.random() < 0.2, "output.report": False}
    if box:
        grains = draw.randrange(1, 13)
        filled = draw.uniform(0.3, 0.5 if grains < 8 else 0.65)  # two equal disks fill at most 0.539 of a square
        compaction = math.log(draw.uniform(0.72, 0.8 if model == "bpm" else 0.95) / filled)
        keys |= {"sample.grains": grains, "sample.packing_fraction": filled,
                 "sample.aspect": log_uniform(draw, 0.7, 1.5), "sample.smallest_diameter": 1.6 * radius,
                 "sample.largest_diameter": 2 * radius,
                 "loading.max_strain": compaction / (2 if loading == "isotropic" else 1),
                 "contact.friction": draw.choice([0.0, draw.uniform(0, 1)])}
        side = math.sqrt(grains * math.pi * 0.81 / filled)  # of a square box, in the largest radius
        if side * math.sqrt(min(keys["sample.aspect"], 1 / keys["sample.aspect"])) > 5.5 and draw.random() < 0.6:
            keys |= {"box.x": "periodic", "box.y": draw.choice(["periodic", "periodic", "walls"])}
    else:
        keys |= {"grain.radius": radius, "loading.max_strain": log_uniform(draw, 1e-3, 0.25)}
    (tame_elastic if model == "mpm" else tame_bonded)(draw, keys, box, radius, density)
    if model == "mpm":
        keys |= tame_shape(random.Random(repr(density)), keys, box)
    last = keys["loading.max_strain"]
    if draw.random() < 0.4:
        keys |= {"loading.unload_at": sorted(draw.uniform(0.5, 0.95) * last for _ in range(draw.randrange(1, 4))),
                 "loading.unload_by": draw.uniform(0.02, 0.4) * last}
    if box and keys.get("box.y") != "periodic" and draw.random() < 0.3:
        keys |= {"box.gravity_y": -log_uniform(draw, 1, 1e3), "box.gravity_x": draw.choice([0.0, draw.uniform(-9, 9)])}
    return keys


def tame_shape(draw, keys, box):
    """Some ellipses and polygons instead of disks, compacted further, since they fill the circles round them in part. What
    touches with a corner, or turns until it lies on a side, stores so little that the energy needs a smaller tolerance than
    the default."""
    if draw.random() > SHAPED or "mpm.formulation" in keys or keys["mpm.law"] in SOFTENING:
        return {}
    aspect, sides = draw.uniform(1.05, 3), draw.randrange(3, 9)
    if draw.random() < 0.5:
        shaped, filled = {"grain.shape": "ellipse", "grain.aspect": aspect}, 1 / aspect  # of the circle round it
    else:
        shaped = {"grain.shape": "polygon", "grain.sides": sides}
        filled = sides / (2 * math.pi) * math.sin(2 * math.pi / sides)
    if box:
        further = -0.5 * math.log(filled)  # half of it: few large grains are jammed by their corners
        shaped["loading.max_strain"] = keys["loading.max_strain"] + further / (
            2 if keys["experiment.loading"] == "isotropic" else 1)
    else:
        shaped["grain.angle"] = draw.uniform(0, math.pi)
    return shaped | ({"mpm.tolerance": 1e-6} if keys["mpm.integrator"] == "implicit" else {})


def tame_elastic(draw, keys, box, radius, density):
    modulus = log_uniform(draw, 1e5, 1e10)
    wave_speed = math.sqrt(modulus / density)
    integrator = draw.choice(["implicit", "implicit", "explicit"])
    law = draw.choice(LAWS_OF_MORE) if draw.random() < OFTEN else draw.choice(LAWS)
    speed = wave_speed * (log_uniform(draw, 1e-7, 1e-2) if integrator == "implicit" else log_uniform(draw, 2e-3, 2e-2))
    keys |= {"mpm.young_modulus": modulus, "mpm.poisson_ratio": draw.uniform(0, 0.495), "mpm.law": law,
             "mpm.cells": draw.randrange(2, 9), "mpm.integrator": integrator, "loading.wall_velocity": speed}
    if law in SOFTENING:  # they soften under compression, and invert soon
        keys["loading.max_strain"] *= 0.5 if box else 0.7
    keys |= tame_parameters(draw, law, modulus, keys["mpm.poisson_ratio"], speed, density, radius)
    if not box and integrator == "explicit" and law not in REMEMBER and draw.random() < 0.5:
        keys |= {"mpm.formulation": "updated_lagrangian", "mpm.shape_functions": draw.choice(["gimp", "bspline"]),
                 "mpm.contact_on": draw.choice(["outline", "grid_nodes"])}


def tame_parameters(draw, law, modulus, poisson_ratio, speed, density, radius):
    """What the law takes beside E and nu; what flows is not struck by the walls."""
    shear = modulus / (2 * (1 + poisson_ratio))
    wave_modulus = modulus * (1 - poisson_ratio) / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio))
    blow = math.sqrt(density * wave_modulus) * speed  # [Pa]
    stress = max(modulus * log_uniform(draw, 3e-3, 1e-1), 20 * blow)
    time = 2 * radius / speed  # of the whole run, or so
    if law == "yeoh":
        return {"mpm.c20": -0.05 * shear * draw.random(), "mpm.c30": shear * log_uniform(draw, 0.02, 0.2)}
    if law == "mooney_rivlin":
        return {"mpm.c01": 0.5 * shear * draw.random()}
    if law == "ogden":
        return {"mpm.ogden_exponent_1": draw.uniform(1, 3), "mpm.ogden_exponent_3": draw.uniform(-4, -1),
                "mpm.ogden_share_2": draw.uniform(0, 0.3), "mpm.ogden_share_3": draw.uniform(0, 0.3)}
    if law == "von_mises":
        return {"mpm.yield_stress": stress, "mpm.hardening_modulus": draw.choice([0.0, stress * draw.uniform(0, 3)]),
                "mpm.kinematic_modulus": draw.choice([0.0, stress * draw.uniform(0.1, 3)]),
                "mpm.viscosity": draw.choice([0.0, stress * time * log_uniform(draw, 1e-3, 1e-1)])}
    if law == "norton":
        return {"mpm.creep_stress": stress, "mpm.creep_rate": log_uniform(draw, 0.1, 10) / time,
                "mpm.creep_exponent": draw.uniform(1, 8)}
    if law == "prony":
        return {"mpm.relaxation_share_1": draw.uniform(0.1, 0.5), "mpm.relaxation_share_2": draw.uniform(0.1, 0.4),
                "mpm.relaxation_time_1": time * log_uniform(draw, 1e-3, 1),
                "mpm.relaxation_time_2": time * log_uniform(draw, 1e-3, 10)}
    return {}


def tame_bonded(draw, keys, box, radius, density):
    primaries = draw.randrange(7, 60)
    cohesion = log_uniform(draw, 1e4, 1e7)
    keys |= {"bpm.primaries": primaries, "bpm.library": 1, "bpm.exponent": draw.uniform(3, 12),
             "loading.wall_velocity": math.sqrt(cohesion / density) * log_uniform(draw, 5e-3, 5e-2)}
    if box:
        keys |= {"bpm.cohesive_pressure": cohesion, "bpm.inner_friction": draw.choice([0.0, draw.uniform(0, 0.5)])}
    else:
        keys["bpm.attraction"] = cohesion * 2 * radius / math.sqrt(primaries)


def wild_value(draw, described):
    """Anything that a key's JSON Schema allows."""
    if "enum" in described:
        return draw.choice(described["enum"])
    kinds = described.get("type", [option.get("type") for option in described.get("oneOf", described.get("anyOf", []))])
    kinds = [kinds] if isinstance(kinds, str) else kinds
    if "boolean" in kinds:
        return draw.random() < 0.5
    for option in described.get("oneOf", described.get("anyOf", [])):
        if option.get("type") in ("number", "integer"):
            described = described | option
    low = described.get("minimum", described.get("exclusiveMinimum", 1e-9))
    high = described.get("maximum", described.get("exclusiveMaximum", 1e9))
    value = draw.choice([low, draw.uniform(low, high), log_uniform(draw, max(low, 1e-9), max(high, 1e-8))])
    if "exclusiveMinimum" in described and value <= low:
        value = low + 1e-3
    if "exclusiveMaximum" in described and value >= high:
        value = high - 1e-3 * abs(high)
    value = [value] if "array" in kinds else value
    return int(value) if kinds == ["integer"] else value


def wild_case(draw, schema):
    keys = tame_case(draw)
    names = [f"{table}.{key}" for table, described in schema["properties"].items()
             for key in described.get("properties", ()) if table not in ("experiment", "output")
             and key not in ("file", "placed")]  # tables of the long form have none; a file is not there
    for name in draw.sample(names, draw.randrange(1, 5)):
        table, key = name.split(".")
        keys[name] = wild_value(draw, schema["properties"][table]["properties"][key])
    return keys


# ----------------------------------------------------------------------------------------------- the properties


class Trial:
    """One case in a directory of its own."""

    def __init__(self, program, folder, keys, tame, seed):
        self.program, self.folder, self.tame, self.draw = program, folder, tame, random.Random(seed)
        self.keys = keys
        (folder / "case.toml").write_text(case_text(keys))

    def softgrain(self, *words, allowed=(DONE,)):
        done = subprocess.run([self.program, *words], cwd=self.folder, capture_output=True, text=True, check=False)
        said = f"softgrain {' '.join(words)}: exit code {done.returncode}\n{done.stdout[-600:]}\n{done.stderr[-1500:]}"
        ensure(done.returncode in allowed, said)
        for words_of_a_bug in ("this is a bug", "Traceback", "Sanitizer", "Assertion"):
            ensure(words_of_a_bug not in done.stdout + done.stderr, said)
        if done.returncode not in (DONE, STOPPED):
            ensure(done.stderr.strip() or done.stdout.strip(), said + "says nothing")
        return done

    def rows(self, run="run"):
        with (self.folder / run / "series.csv").open() as file:
            rows = list(csv.reader(file))
        names = [name.split("[")[0] for name in rows[0]]
        return [dict(zip(names, map(float, row))) for row in rows[1:]]

    def record(self, run="run"):
        return json.loads((self.folder / run / "run.json").read_text())

    def snapshots(self, run="run"):
        return sorted((self.folder / run / "snap").glob("s*.h5"), key=lambda path: int(path.stem[1:]))

    def hash(self, run="run"):
        described = self.softgrain("info", "--json", str(self.snapshots(run)[-1]))
        return json.loads(described.stdout)["content_hash"]


def run_ends_as_it_may(trial):
    """`check` and `run` agree on what is refused, and a sensible case is carried out and trusted."""
    checked = trial.softgrain("check", "case.toml", allowed=[DONE] if trial.tame else [DONE, REFUSED])
    allowed = [DONE, STOPPED] if trial.tame else [DONE, BROKE_DOWN, DOUBTFUL, STOPPED]
    if checked.returncode == REFUSED:
        allowed = [REFUSED]
    words = ["run", "case.toml", "-o", "run", "-j", "1", "--progress", "none", "--stop-after", TIME_LIMIT]
    done = trial.softgrain(*words, allowed=allowed)
    if done.returncode == REFUSED:
        ensure(not (trial.folder / "run").exists(), "a run that is refused leaves a directory behind")
    return done.returncode


def numbers_are_numbers(trial):
    for row in trial.rows():
        for name, value in row.items():
            ensure(math.isfinite(value), f"{name} is {value} in step {row['step']:.0f}")


def path_is_completed(trial):
    """The last strain is the one asked for, to a millionth of it."""
    asked, last = trial.keys["loading.max_strain"], trial.rows()[-1]["strain"]
    ensure(abs(last - asked) <= 1e-6 * asked, f"the last strain is {last}, not {asked}: {trial.record()['message']}")


def nothing_is_loaded_at_first(trial):
    first = trial.rows()[0]
    if "elastic_energy" in first:
        size = trial.keys["mpm.young_modulus"] * (trial.keys.get("grain.radius", 0) or
                                                  trial.keys.get("sample.largest_diameter", 0) / 2) ** 2
        ensure(abs(first["elastic_energy"]) <= 1e-12 * size, f"{first['elastic_energy']} J/m are stored at first")


def walls_do_not_pull(trial):
    rows = trial.rows()
    for name, end in (("stress_bottom", "box.y"), ("stress_top", "box.y"), ("stress_side", "box.x")):
        if name in rows[0] and trial.keys.get(end) != "periodic":  # what moves in a cell may pull at its images
            largest = max(abs(row[name]) for row in rows)
            least = min(row[name] for row in rows)
            ensure(least >= -1e-6 * largest, f"{name} goes down to {least} Pa, beside {largest} Pa")


def energy_is_accounted_for(trial):
    """The budget closes to 2 % of the largest energy, and contact and integration make none."""
    rows = trial.rows()
    largest = trial.record()["report"]["energy_scale"]
    for row in rows:
        at = f"in step {row['step']:.0f}, beside {largest} J/m"
        ensure(abs(row["energy_error"]) <= 0.02 * largest, f"energy_error is {row['energy_error']} J/m {at}")
        ensure(row["dissipation"] >= -0.02 * largest, f"dissipation is {row['dissipation']} J/m {at}")


def resumes_to_the_same_bits(trial):
    kept = trial.draw.randrange(1, len(trial.snapshots()))
    shutil.copytree(trial.folder / "run", trial.folder / "part")
    for snapshot in trial.snapshots("part")[kept:]:
        snapshot.unlink()
    trial.softgrain("resume", "part", "-q", "-j", "2", allowed=[DONE, DOUBTFUL])
    ensure(trial.hash("part") == trial.hash(), f"resumed from snapshot {kept}, the run ends elsewhere")
    same = [{name: value for name, value in row.items() if name != "wall_seconds"} for row in trial.rows()]
    for ours, theirs in zip(same, trial.rows("part")):
        differing = [name for name in ours if ours[name] != theirs[name]]
        ensure(not differing, f"resumed from snapshot {kept}, row {ours['step']:.0f} differs in {differing}")


def everything_reads_it(trial):
    trial.softgrain("verify", "run")
    trial.softgrain("info", "--json", "run")
    if trial.draw.random() < 0.3:
        trial.softgrain("report", "run")
    if trial.draw.random() < 0.08:
        trial.softgrain("plot", "run")


def try_case(trial):
    outcome = run_ends_as_it_may(trial)
    if outcome in (DONE, DOUBTFUL):
        numbers_are_numbers(trial)
        if len(trial.snapshots()) > 1:
            resumes_to_the_same_bits(trial)
        everything_reads_it(trial)
    if outcome == DONE and trial.tame:
        for holds in (path_is_completed, nothing_is_loaded_at_first, walls_do_not_pull, energy_is_accounted_for):
            holds(trial)
    return outcome


def affordable_case(program, number, schema, folder):
    """The first random case of this number that is not estimated to take too long."""
    for again in range(1000):
        draw = random.Random(f"{number}/{again}")
        keys = tame_case(draw) if number % 2 == 0 else wild_case(draw, schema)
        (folder / "case.toml").write_text(case_text(keys))
        checked = subprocess.run([program, "check", "--json", "case.toml"], cwd=folder, capture_output=True, check=False)
        if checked.returncode != DONE or json.loads(checked.stdout)["estimate"]["hours"] * 3600 < LONGEST:
            return keys
    raise AssertionError("no case is short enough")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=100, help="20 times as many where SOFTGRAIN_TORTURE is set")
    parser.add_argument("--keep", type=Path, help="directory for the cases that fail")
    arguments = parser.parse_args()
    if "SOFTGRAIN_TORTURE" in os.environ:
        arguments.first, arguments.count = 20 * arguments.first, 20 * arguments.count
    program = str(arguments.program.resolve())
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    schema = json.loads(subprocess.run([program, "schema"], capture_output=True, check=True).stdout)
    outcomes, failed = {}, 0
    for number in range(arguments.first, arguments.first + arguments.count):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            keys = affordable_case(program, number, schema, folder)
            try:
                outcome = try_case(Trial(program, folder, keys, number % 2 == 0, number))
                outcomes[outcome] = outcomes.get(outcome, 0) + 1
            except Broken as broken:
                failed += 1
                print(f"case {number}: {broken}\n{case_text(keys)}", flush=True)
                if arguments.keep:
                    with contextlib.suppress(FileNotFoundError):
                        shutil.copytree(folder, arguments.keep / str(number), dirs_exist_ok=True)
    print("exit codes", ", ".join(f"{code}: {count}" for code, count in sorted(outcomes.items())))
    print(f"{arguments.count - failed} passed, {failed} failed")
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
