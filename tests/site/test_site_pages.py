# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of the site, of a small tree of sources. Where markdown is not installed, a line says that it was not tested."""
import os
import sys
import tempfile
import unittest

from matplotlib.figure import Figure

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../plots"))
import site_pages as site
import style

try:
    import markdown
except ImportError:
    markdown = None

README = """# Title

See [own](docs/own.md#a-b), [code](solver/x.hpp), [folder](reference), [claims](reference/a.json), <https://example.org>.
[problems](docs/own_problems.md), [flows](docs/flows.md)

| a | b |
|---|---|
| 1 | `x|y` |
"""


class Links(unittest.TestCase):
    def test_anchors_are_those_of_github(self):
        self.assertEqual(site.slug("In one table"), "in-one-table")
        self.assertEqual(site.slug("What `evolve` calls, them!"), "what-evolve-calls-them")

    def test_dead_links_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "index.html"), "w", encoding="utf-8") as file:
                file.write('<a href="#there">a</a><a id="there" href="none.html">b</a><a href="#none">c</a><a href="https://x.org/">d</a>')
            self.assertEqual(site.dead_links(folder), ["index.html: #none", "index.html: none.html"])


@unittest.skipIf(markdown is None, "python3-markdown is not installed")
class Pages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.write("README.md", README)
        self.write("docs/README.md", "# Docs\n\n[home](../README.md)\n")
        self.write("docs/own.md", "# Own\n\n## A b\n\n[back](../README.md)\n\n| verdict | statement |\n|---|---|\n| holds | a |\n")
        for name in ("docs/own_problems.md", "docs/flows.md", "solver/x.hpp", "reference/a.json"):
            self.write(name, "# x\n")
        figure = Figure(figsize=(2, 1))
        figure.add_subplot().plot([0, 1])
        style.save(figure, os.path.join(self.folder, "figures/kll19/fig13_1"))

    def write(self, name, words):
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(words)

    def build(self):
        self.output = os.path.join(self.folder, "out")
        return site.build(self.folder, self.output, os.path.join(self.folder, "report"), os.path.join(self.folder, "figures"), "none")

    def read(self, name):
        with open(os.path.join(self.output, name), encoding="utf-8") as file:
            return file.read()

    def test_pages_and_what_they_link_to(self):
        missing, dead = self.build()
        self.assertEqual(missing, ["report (make report)", "api (make docs)"])
        self.assertEqual(dead, [])
        page = self.read("index.html")
        for link in ('href="docs/own.html#a-b"', 'href="solver/x.hpp.txt"', 'href="reference/index.html"', 'href="reference/a.json"'):
            self.assertIn(link, page)
        self.assertIn('<div class="scroll"><table>', page)
        self.assertIn('<table class="stacked">', self.read("docs/own.html"))
        self.assertIn('<td class="code"><code>', page)
        self.assertNotIn("report/index.html", page, "what is not there has no link")
        self.assertIn("figures/kll19/fig13_1.pdf", self.read("gallery.html"))
        self.assertIn('href="../index.html"', self.read("docs/own.html"))

    def test_a_link_that_leads_nowhere_is_found(self):
        self.write("docs/own.md", "# Own\n\n[gone](gone.md)\n")
        _, dead = self.build()
        self.assertEqual(sorted(dead), ["docs/own.html: gone.md", "index.html: docs/own.html#a-b"])

    def test_the_report_is_a_part_of_it(self):
        self.write("report/index.html", "<p>report</p>")
        missing, _ = self.build()
        self.assertEqual(missing, ["api (make docs)"])
        self.assertIn("report/index.html", self.read("index.html"))


if __name__ == "__main__":
    unittest.main()
