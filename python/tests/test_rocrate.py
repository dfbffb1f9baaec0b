"""Crates against what RO-Crate 1.1 and the profile Process Run Crate 0.5 demand, written out here from their texts."""

import contextlib
import io
import json
import re
import tempfile
import unittest
from pathlib import Path
from urllib.parse import unquote

import synthetic
from small_runs import small_run

import softgrain
from softgrain.export.__main__ import main

CRATE, PROFILE = "https://w3id.org/ro/crate/1.1", "https://w3id.org/ro/wfrun/process/0.5"
# RO-Crate 1.1, "Direct properties of the Root Data Entity": MUST have
ROOT_MUST = ("@type", "@id", "name", "description", "datePublished", "license")
# Process Run Crate 0.5, table "Requirements": MUST, and SHOULD as far as a run says it
APPLICATION_MUST, APPLICATION_SHOULD = ("@type", "@id"), ("name", "softwareVersion")
ACTION_MUST, ACTION_SHOULD = ("@type", "@id", "instrument"), ("name", "description", "endTime", "result")
ISO_DAY, ISO_TIME = r"\d{4}-\d\d-\d\d$", r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(Z|[+-]\d\d:\d\d)$"
STATUSES = ("http://schema.org/CompletedActionStatus", "http://schema.org/FailedActionStatus")


def types_of(entity):
    return entity["@type"] if isinstance(entity["@type"], list) else [entity["@type"]]


def links_of(value):
    return [item["@id"] for item in (value if isinstance(value, list) else [value])]


class Crates(unittest.TestCase):
    def crate(self, run, *words):
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(main([str(run.path), "--to=rocrate", *words]), 0)
        crate = json.loads((run.path / "ro-crate-metadata.json").read_text(encoding="utf-8"))
        self.graph = {entity["@id"]: entity for entity in crate["@graph"]}
        self.assertEqual(len(self.graph), len(crate["@graph"]))  # an @id stands for one thing
        self.assertEqual(crate["@context"], [f"{CRATE}/context", "https://w3id.org/ro/terms/workflow-run/context"])
        return self.graph

    def has(self, entity, *names):
        for name in names:
            self.assertTrue(entity.get(name), f"{entity['@id']} has no {name}")

    def of_type(self, name):
        return [entity for entity in self.graph.values() if name in types_of(entity)]

    def check(self, folder):
        """Every demand."""
        graph = self.graph
        descriptor = graph["ro-crate-metadata.json"]
        self.assertEqual(descriptor["@type"], "CreativeWork")
        self.assertEqual((descriptor["conformsTo"], descriptor["about"]), ({"@id": CRATE}, {"@id": "./"}))
        root = graph["./"]
        self.has(root, *ROOT_MUST)
        self.assertEqual(root["@type"], "Dataset")
        self.assertRegex(root["datePublished"], ISO_DAY)
        self.assertIn(PROFILE, links_of(root["conformsTo"]))
        self.assertEqual(graph[PROFILE]["@type"], "CreativeWork")
        (application,), (action,) = self.of_type("SoftwareApplication"), self.of_type("CreateAction")
        self.has(application, *APPLICATION_MUST, *APPLICATION_SHOULD)
        self.assertNotIn("version", application)  # not both
        self.has(action, *ACTION_MUST, *ACTION_SHOULD)
        self.assertEqual(links_of(action["instrument"]), [application["@id"]])
        self.assertEqual(links_of(root["mentions"]), [action["@id"]])
        self.assertRegex(action["@id"], r"urn:uuid:[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}$")
        for time in ("startTime", "endTime"):
            self.assertRegex(action[time], ISO_TIME)
        self.assertIn(action["actionStatus"], STATUSES)
        self.assertEqual("error" in action, action["actionStatus"] == STATUSES[1])
        data = [entity for entity in self.of_type("File") + self.of_type("Dataset") if entity is not root]
        self.assertEqual({entity["@id"] for entity in data}, set(links_of(root["hasPart"])))  # all linked from the root
        for entity in data:
            path = folder / unquote(entity["@id"])
            self.assertTrue(path.is_file() if "File" in types_of(entity) else path.is_dir() and entity["@id"].endswith("/"))
        for name in ("object", "result"):
            self.assertLessEqual(set(links_of(action[name])), {entity["@id"] for entity in data})
        for entity in graph.values():  # no reference into nothing
            for name, value in entity.items():
                if name not in ("@id", "@type") and isinstance(value, (dict, list)):
                    for link in links_of(value):
                        self.assertTrue(link in graph or (entity, link) == (descriptor, CRATE), link)
        return action

    def test_a_crate_of_a_run_has_all_that_the_specification_and_the_profile_demand(self):
        run = small_run("packing")
        self.crate(run)
        action = self.check(run.path)
        self.assertEqual(links_of(action["object"]), ["case.toml"])
        self.assertLessEqual({"series.csv", "run.json", "snap/"}, set(links_of(action["result"])))
        self.assertEqual(action["endTime"], run.info["updated"])
        self.assertEqual(self.of_type("SoftwareApplication")[0]["softwareVersion"], run.info["program"]["version"])
        first = action["@id"]
        self.crate(run)
        self.assertEqual(self.check(run.path)["@id"], first)  # the same run

    def test_a_licence_and_an_author_are_entities_of_their_own(self):
        run = small_run("bonded")
        address, person = "https://spdx.org/licenses/CC-BY-4.0", "https://orcid.org/0000-0002-1825-0097"
        graph = self.crate(run, f"--license={address}", f"--author={person}")
        action = self.check(run.path)
        self.assertEqual((graph["./"]["license"], action["agent"]), ({"@id": address}, {"@id": person}))
        self.has(graph[address], "name", "description")
        self.assertEqual(graph[person]["@type"], "Person")
        graph = self.crate(run, "--license=for readers of the thesis", "--author=A. Student")
        self.check(run.path)
        self.assertEqual(graph["./"]["license"], "for readers of the thesis")
        self.assertEqual(self.of_type("Person")[0]["name"], "A. Student")

    def test_a_run_that_failed_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            run = softgrain.open(synthetic.write_run(Path(folder) / "a run"))
            info = {"program": {"version": "1.2.3"}, "state": "failed", "message": "a grain turned inside out",
                    "command": ["softgrain", "run", "my case.toml"], "started": "2026-11-30T06:00:00Z",
                    "updated": "2026-11-30T06:01:00Z"}
            (run.path / "run.json").write_text(json.dumps(info))
            run = softgrain.open(run.path)
            self.crate(run)
            action = self.check(run.path)
            self.assertEqual(action["error"], "a grain turned inside out")
            self.assertIn("'my case.toml'", action["description"])

    def test_what_cannot_be_described_is_refused_with_its_remedy(self):
        run = small_run("packing")
        with tempfile.TemporaryDirectory() as folder:
            bare = synthetic.write_run(Path(folder) / "bare")
            (bare / "run.json").unlink()
            for words, reason in (([str(bare), "--to=rocrate"], "run.json"),
                                  ([str(run.path), "--to=rocrate", "-o", "x"], "takes no --output"),
                                  ([str(run.path), "--to=xyz", "--license=x"], "belong to --to rocrate")):
                errors = io.StringIO()
                with contextlib.redirect_stderr(errors):
                    self.assertEqual(main(words), 2)
                self.assertTrue(re.search(reason, errors.getvalue()), errors.getvalue())


if __name__ == "__main__":
    unittest.main()
