"""What others read about the project agrees: versions, citations, templates."""

import json
import re
import runpy
import subprocess
import sys
import unittest
from pathlib import Path

import softgrain
from softgrain.methods.references import ENTRIES

ROOT = Path(__file__).resolve().parents[2]


def text(name):
    return (ROOT / name).read_text(encoding="utf-8")


class Files(unittest.TestCase):
    def test_all_files_tell_the_same_version(self):
        version = re.search(r"project\(softgrain[^)]*VERSION (\S+)", text("CMakeLists.txt"))[1]
        self.assertEqual(json.loads(text("codemeta.json"))["version"], version)
        self.assertEqual(re.search(r"^version: (\S+)", text("CITATION.cff"), re.M)[1], version)
        self.assertEqual(softgrain.__version__, version)
        self.assertEqual(re.search(r'^version = "(\S+)"', text("pyproject.toml"), re.M)[1], version)
        self.assertEqual(json.loads(text("viewer/package.json"))["version"], version)
        lock = json.loads(text("viewer/package-lock.json"))
        self.assertEqual([lock["version"], lock["packages"][""]["version"]], [version, version])
        self.assertEqual(set(re.findall(r"softgrain-(\d+\.\d+\.\d+)", text("docs/guide/install.md"))), {version})

    def test_the_changelog_is_cut_into_releases_and_the_last_one_is_the_version(self):
        titles = re.findall(r"^## (.*)", text("CHANGELOG.md"), re.M)
        self.assertEqual(titles[0], "Unreleased")
        releases = [re.fullmatch(r"(\d+\.\d+\.\d+) - (\d{4}-\d\d-\d\d)", title).groups() for title in titles[1:]]
        self.assertEqual(releases[0][0], softgrain.__version__)
        self.assertEqual(releases[0][1], re.search(r"^date-released: (\S+)", text("CITATION.cff"), re.M)[1])
        numbers = [tuple(map(int, number.split("."))) for number, _ in releases]
        self.assertEqual(numbers, sorted(numbers, reverse=True))
        self.assertEqual([date for _, date in releases], sorted((date for _, date in releases), reverse=True))

    def test_every_work_cited_in_the_paper_is_in_its_bibliography_and_no_other(self):
        cited = set(re.findall(r"@([a-z]+\d{4})", text("paper/paper.md")))
        self.assertEqual(cited, set(re.findall(r"^@\w+\{(\w+),", text("paper/paper.bib"), re.M)))
        self.assertEqual(text("paper/paper.bib").count("{"), text("paper/paper.bib").count("}"))

    def test_works_that_both_the_paper_and_methods_cite_have_the_same_title(self):
        title = re.compile(r"title\s*= \{(.*)\},")
        entries = re.findall(r"^@\w+\{(\w+),\n(.*?)^\}", text("paper/paper.bib"), re.M | re.S)
        both = {key: title.search(body)[1] for key, body in entries if key in ENTRIES}
        self.assertEqual(both, {key: title.search(ENTRIES[key])[1] for key in both})
        self.assertGreaterEqual(len(both), 3)

    def test_the_paper_has_the_sections_that_joss_asks_for_and_its_length(self):
        paper = text("paper/paper.md")
        wanted = ["Summary", "Statement of need", "State of the field", "Software design", "Research impact statement",
                  "AI usage disclosure", "Acknowledgements", "References"]
        self.assertEqual(re.findall(r"^# (.*)", paper, re.M), wanted)
        self.assertTrue(750 <= len(paper.split("---", 2)[2].split()) <= 1750)

    def test_the_gallery_has_the_page_of_its_table_and_a_small_picture_for_each_case(self):
        gallery = runpy.run_path(str(ROOT / "tools/gallery"))
        self.assertEqual(text("docs/gallery/README.md"), gallery["page"]())
        self.assertIn(f"| {len(gallery['CASES'])} cases, each by one command", text("docs/README.md"))
        sizes = {path.stem: path.stat().st_size for path in (ROOT / "docs/gallery").glob("*.png")}
        self.assertEqual(sizes.keys(), {case.name for case in gallery["CASES"]})
        self.assertLess(max(sizes.values()), gallery["LARGEST"])
        self.assertLess(sum(sizes.values()), gallery["LARGEST_ALL"])

    def test_the_readme_begins_with_a_small_moving_picture_and_the_commands_that_make_it(self):
        gallery = runpy.run_path(str(ROOT / "tools/gallery"))
        picture = gallery["FRONT_PICTURE"]
        beginning = re.sub(r"\\\n *", "", text("README.md").partition("## ")[0])
        self.assertIn(f"]({picture.relative_to(ROOT)})", beginning)
        for command in gallery["FRONT"]:
            self.assertIn(f"softgrain {command}\n", beginning)
        self.assertLess(picture.stat().st_size, gallery["LARGEST_ALL"])
        try:
            from PIL import Image
        except ModuleNotFoundError:
            self.skipTest("Pillow is not here")
        with Image.open(picture) as image:
            self.assertEqual(image.n_frames, 1 + int(re.search(r"output.snapshots=(\d+)", gallery["FRONT"][0])[1]))

    def test_templates_are_forms_with_a_name_and_fields(self):
        try:
            import yaml
        except ModuleNotFoundError:
            self.skipTest("PyYAML is not here")
        forms = sorted((ROOT / ".github/ISSUE_TEMPLATE").glob("*.yml"))
        self.assertEqual([form.stem for form in forms], ["bug", "config", "question", "wish"])
        for form in forms:
            content = yaml.safe_load(form.read_text())
            if form.stem != "config":
                self.assertTrue({"name", "description", "body"} <= content.keys())
                ids = [field["id"] for field in content["body"]]
                self.assertEqual(len(ids), len(set(ids)))
                self.assertTrue(all(field["attributes"]["label"] for field in content["body"]))

    def test_sources_on_both_sides_of_a_dash_come_into_different_joints(self):
        """A joint of io/ with readers of cases and of snapshots takes HDF5 into the Python module: then no wheel can be linked."""
        io = ROOT / "src/softgrain/io"
        cases, runs = ([str(path) for folder in folders for path in sorted((io / folder).glob("*.cpp"))]
                       for folders in (["case"], ["page", "run"]))
        mixed = [joint for joint in self.joints(cases + runs) if set(joint) & set(cases) and set(joint) & set(runs)]
        self.assertTrue(mixed)  # else the dash would be of no use
        for joint in self.joints([*cases, "--", *runs]):
            self.assertFalse(set(joint) & set(cases) and set(joint) & set(runs), joint)

    def joints(self, words):
        told = subprocess.run([sys.executable, ROOT / "tools/joint_sources.py", "1000", *words], capture_output=True, text=True, check=True)
        made = {}
        for line in told.stdout.splitlines():
            number, source = line.split(" ", 1)
            made.setdefault(number, []).append(source)
        self.assertEqual(sorted(sum(made.values(), [])), sorted(set(words) - {"--"}))
        return list(made.values())


if __name__ == "__main__":
    unittest.main()
