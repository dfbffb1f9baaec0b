"""The paragraph for a paper: each number held against the case, the program's own verdict or a closed form."""

import contextlib
import io
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
import synthetic
from small_runs import CASES, small_run

import softgrain
from softgrain.methods import bibtex, facts_of, latex, paragraph
from softgrain.methods.__main__ import main
from softgrain.methods.grains import LAWS
from softgrain.methods.quantity import quantity
from softgrain.methods.text import LOADINGS


def methods(*words):
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = main([*map(str, words)])
    return code, out.getvalue(), err.getvalue()


def text_of(name):
    return paragraph(small_run(name), facts_of(small_run(name)))[0]


class Numbers(unittest.TestCase):
    def test_model_law_and_numbers_of_grains_and_particles_are_those_of_the_case(self):
        self.assertRegex(text_of("bonded"), r"one disk of a radius of 5 mm .* aggregates of 60 rigid primary disks, .* F0 = 100 N/m")
        self.assertIn("unloaded at 0.05, up to a strain of 0.1.", text_of("bonded"))
        case = small_run("elastic").path / "case.toml"
        told = subprocess.run([os.environ["SOFTGRAIN_PROGRAM"], "check", "--json", case], capture_output=True, check=True)
        text = text_of("elastic")
        self.assertIn("neo-Hookean material with E = 10 MPa, nu = 0.45.", text)
        points = int(re.search(r"(\d+) material points,", text)[1])
        self.assertEqual(points % 4, 0)  # four in each cell
        self.assertLess(abs(points / json.loads(told.stdout)["estimate"]["particles"] - 1), 0.2)
        self.assertRegex(text_of("packing"), r"6 disks of diameters between 1.4 mm and 2.4 mm .* coefficient 0.3 between grains and 0 at")
        self.assertIn("upper wall, which moved at 5 m/s", text_of("packing"))

    def test_steps_balance_and_residual_are_those_of_the_verdict(self):
        for name in CASES:
            run, facts = small_run(name), facts_of(small_run(name))
            verdict = run.info["verdict"]
            self.assertIn(f"of {facts.steps:,} steps".replace(",", " "), verdict)
            self.assertIn(f"residual {facts.residual:.0e}", verdict)
            self.assertIn(f"balanced to {facts.energy_error:.0e}", verdict)
            low, high = facts.time_step
            self.assertTrue(low * 0.999 <= run.info["time"] / facts.steps <= high * 1.001)

    def test_the_inertial_number_of_one_grain_is_that_of_its_wall(self):
        """eps = -ln(1 - d/R) with 2 d the travel of the wall: d eps/dt = v exp(eps)/(2 R), so I = v exp(eps) sqrt(rho/sigma)."""
        run = small_run("elastic")
        strain, stress = run.series["strain"], (run.series["stress_top"] + run.series["stress_bottom"]) / 2
        loaded = stress > 0.01 * stress.max()
        expected = 0.2 * np.exp(strain[loaded]) * np.sqrt(990 / stress[loaded])
        np.testing.assert_allclose(facts_of(run).inertial_number, (np.median(expected), expected.max()), rtol=0.03)

    def test_hashes_are_those_that_other_programs_tell(self):
        run, facts = small_run("bonded"), facts_of(small_run("bonded"))
        told = subprocess.run(["sha256sum", run.path / "case.toml"], capture_output=True, text=True, check=True).stdout
        self.assertTrue(told.startswith(facts.case_hash))
        self.assertIn(facts.case_hash[:16], text_of("bonded"))
        info = subprocess.run([os.environ["SOFTGRAIN_PROGRAM"], "info", "--json", run.snapshots[-1]], capture_output=True, check=True)
        self.assertEqual(json.loads(info.stdout)["content_hash"], facts.content_hash)
        self.assertIn(facts.content_hash, text_of("bonded"))

    def test_quantities_have_prefixes(self):
        for value, unit, text in ((0.005, "m", "5 mm"), (1e7, "Pa", "10 MPa"), (0.2, "m/s", "200 mm/s"), (0, "Pa", "0 Pa"),
                                  (2.5e-7, "s", "250 ns"), (99999, "Pa", "100 kPa"), (999999, "Pa", "1 MPa"), (2e-12, "s", "0.002 ns")):
            self.assertEqual(quantity(value, unit), text)


class Words(unittest.TestCase):
    def test_every_law_and_every_loading_of_the_program_has_its_words(self):
        schema = json.loads(subprocess.run([os.environ["SOFTGRAIN_PROGRAM"], "schema"], capture_output=True, check=True).stdout)
        tables = {name: table.get("properties", {}) for name, table in schema["properties"].items()}
        self.assertEqual(set(LAWS), set(tables["mpm"]["law"]["enum"]))
        self.assertEqual(set(LOADINGS), set(tables["experiment"]["loading"]["enum"]))
        of_no_law = {"law", "young_modulus", "poisson_ratio", "cells", "integrator", "formulation", "lattice_integrator", "shape_functions",
                     "contact_on", "damping", "tolerance", "time_step"}
        self.assertEqual({key for _, keys, _ in LAWS.values() for key in keys}, set(tables["mpm"]) - of_no_law)

    def test_spheres_are_told_as_spheres(self):
        text = text_of("bonded_spheres")
        self.assertIn("in three dimensions, by", text)
        self.assertRegex(text, r"4 spheres of diameters .* aggregates of 20 rigid primary spheres each \(80 in all\), .* F0/<a0>\^2 = 500 kPa")

    def test_each_kind_is_told_with_its_shape_size_and_material(self):
        with tempfile.TemporaryDirectory() as folder:
            case = Path(folder) / "case.toml"
            case.write_text("""
[experiment]
model = "mpm"
loading = "compaction"
[[kind]]
name = "rubber"
number = 3
shape = "ellipse"
aspect = 1.5
cells = 4
law.young_modulus = "2 MPa"
diameter.smallest = "2 mm"
diameter.largest = "2.5 mm"
[[kind]]
name = "sand"
number = 2
model = "rigid"
shape = "polygon"
sides = 6
density = "2600 kg/m^3"
[loading]
wall_velocity = "5 m/s"
max_strain = 0.02
[output]
vtk = false
report = false
""")
            run = Path(folder) / "run"
            subprocess.run([os.environ["SOFTGRAIN_PROGRAM"], "run", case, "-o", run, "-q"], check=True)
            _, text, _ = methods(run)
        self.assertIn("consisted of 5 grains of two kinds.", text)
        self.assertRegex(text, r"rubber: 3 ellipses of aspect ratio 1.5 of diameters between 2 mm and 2.5 mm and a density of 990 kg/m\^3, "
                               r"made of a compressible neo-Hookean material with E = 2 MPa, nu = 0.45\.")
        self.assertRegex(text, r"sand: 2 rigid regular polygons of 6 sides of diameters .* a density of 2600 kg/m\^3\.")

    def test_a_law_is_told_with_its_own_parameters_in_their_units(self):
        run = small_run("elastic")
        run = softgrain.Run(run.path)
        run.case["mpm"] |= {"law": "von_mises", "yield_stress": 2e5, "viscosity": 50.0, "c20": 1.0}
        text, keys = paragraph(run, facts_of(run))
        self.assertIn("an elastic-plastic (von Mises) material with E = 10 MPa, nu = 0.45, yield stress 200 kPa, viscosity 50 Pa s.", text)
        self.assertNotIn(" c20", text)
        run.case["mpm"] |= {"law": "prony", "relaxation_share_1": 0.5, "relaxation_time_1": 2e-3}
        text, keys = paragraph(run, facts_of(run))
        self.assertIn("relaxation share 1 0.5, relaxation time 1 2 ms.", text)
        self.assertIn("reese1998", keys)


class Program(unittest.TestCase):
    def test_every_work_cited_has_its_entry_and_no_other_has(self):
        for name in CASES:
            for form, cited in (("text", r"\[([a-z0-9, ]+)\]"), ("latex", r"\\cite\{([a-z0-9,]+)\}")):
                _, out, _ = methods(small_run(name).path, "--format", form)
                text, _, entries = out.partition("\n\n")
                keys = {key.strip() for found in re.findall(cited, text) for key in found.split(",")}
                self.assertEqual(keys, set(re.findall(r"@\w+\{(\w+),", entries)))
                self.assertEqual(entries.count("{"), entries.count("}"))
                self.assertEqual("nezamabadi2017" in keys, name == "bonded")

    def test_latex_is_given_nothing_that_it_takes_for_a_command(self):
        text = latex("5 % of a_b, 990 kg/m^3, 250 µs, nu = 0.4 [jean1999, moreau1988]")
        self.assertEqual(text, r"5 \% of a\_b, 990 kg/m$^3$, 250 $\mu$s, $\nu$ = 0.4 \cite{jean1999,moreau1988}")

    def test_a_doubtful_or_unfinished_run_says_so_and_ends_with_5(self):
        with tempfile.TemporaryDirectory() as folder:
            copy = Path(folder) / "run"
            shutil.copytree(small_run("elastic").path, copy)
            info = json.loads((copy / "run.json").read_text())
            self.assertEqual(methods(copy)[0], 0)
            for change, words in (({"doubts": ["energy out of balance by 5 %"]}, "doubts this run: energy out of balance by 5 %."),
                                  ({"state": "stopped"}, "the run is not done (state: stopped)"),
                                  ({"program": {**info["program"], "commit": "abc-dirty"}}, "differ from its commit")):
                (copy / "run.json").write_text(json.dumps({**info, **change}))
                code, out, _ = methods(copy)
                self.assertEqual(code, 0 if "program" in change else 5)
                self.assertIn("NOTE: ", out)
                self.assertIn(words, out)

    def test_the_program_itself_has_the_verbs_of_talks_papers_and_curves(self):
        run, program = small_run("elastic"), os.environ["SOFTGRAIN_PROGRAM"]
        with tempfile.TemporaryDirectory() as folder:
            measured = Path(folder) / "measured.csv"
            measured.write_text("strain,stress[MPa]\n0,0\n0.05,0.2\n0.1,0.4\n")
            for words, code, printed in ((("methods", run.path), 0, text_of("elastic")), (("movie", run.path, "-o", f"{folder}/a.gif"), 0, "a.gif"),
                                         (("compare", run.path, measured), 0, "rms difference"), (("fit", run.path / "case.toml", measured), 2, "--free")):
                done = subprocess.run([program, *words], capture_output=True, text=True)
                self.assertEqual(done.returncode, code, done.stderr)
                self.assertIn(printed, done.stdout + done.stderr)

    def test_what_is_no_run_or_has_not_begun_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(methods(Path(folder) / "nothing")[0], 2)
            code, _, err = methods(synthetic.write_run(Path(folder) / "run"))
            self.assertEqual(code, 2)
            self.assertIn("run.json", err)


if __name__ == "__main__":
    unittest.main()
