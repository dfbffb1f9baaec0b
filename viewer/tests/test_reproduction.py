"""The page that `softgrain reproduce` writes, in a headless Chromium. Usage: test_reproduction.py

Exit code 77, for CTest's "skipped", where there is no Chromium or no Matplotlib."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
from browser import BrowserTest, require_browser  # noqa: E402

try:
    from matplotlib.figure import Figure
except ImportError as error:
    print(f"skipped: {error}; tools/install_dependencies.sh installs it")
    sys.exit(77)
require_browser()

from softgrain.reproduce import causes, page  # noqa: E402
from softgrain.reproduce.verdict import Verdict  # noqa: E402

FOUND = [Verdict("1", "a statement", "5.4", True), Verdict("3", "a < b & c", "0.14", False, causes.CONTACT_RULE, "0.09", "softgrain run x"),
         Verdict("4", "another", "1.0", False, causes.OPEN, "tried")]


class ReproductionPage(BrowserTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        picture = cls.folder / "fig1.png"
        Figure().savefig(picture)
        cls.page = page.write(FOUND, [picture], cls.folder, {"program": "softgrain 0"})

    def test_everything_is_there_and_nothing_is_asked_of_the_network(self):
        self.browser.open(self.page)
        self.assertEqual(self.browser.run("document.querySelectorAll('tbody tr').length"), len(FOUND))
        self.assertEqual(self.browser.run("document.querySelector('tbody tr:nth-child(2) td:nth-child(2)').textContent"), "a < b & c")
        self.assertGreater(self.browser.run("document.querySelector('img').naturalWidth"), 100)
        self.assertTrue(self.browser.run("[...document.querySelectorAll('td a')].every(a => document.querySelector(a.getAttribute('href')))"))
        self.assertEqual([url for url in self.browser.requests if not url.startswith(("file:", "data:"))], [])
        self.assertEqual(self.browser.errors, [])

    def test_on_a_phone_only_the_table_scrolls_sideways(self):
        self.browser.resize(390, 800, phone=True)
        self.browser.open(self.page)
        self.assertEqual(self.browser.run("document.documentElement.scrollWidth"), 390)


if __name__ == "__main__":
    unittest.main()
