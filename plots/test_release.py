# SPDX-License-Identifier: GPL-3.0-or-later
"""The version, its date and the papers are the same in all files of a release."""
import json
import os
import re
import subprocess
import unittest

from report_content import PAPERS
from testing import FOLDER

ROOT = os.path.dirname(FOLDER)


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def found(pattern, path):
    match = re.search(pattern, read(path), re.MULTILINE)
    assert match, f"{path} has no {pattern}"
    return match[1]


class Release(unittest.TestCase):
    def test_the_version_is_the_same_everywhere(self):
        version = found(r"^project\(esfem VERSION ([\d.]+)", "CMakeLists.txt")
        others = {"CITATION.cff": found(r"^version: (.*)", "CITATION.cff"), "CHANGELOG.md": found(r"^## ([\d.]+), ", "CHANGELOG.md"),
                  ".zenodo.json": json.loads(read(".zenodo.json"))["version"], "codemeta.json": json.loads(read("codemeta.json"))["version"],
                  "docs/artifact.md": found(r"version ([\d.]+\d)", "docs/artifact.md")}
        self.assertEqual(others, dict.fromkeys(others, version))
        self.assertTrue(version.startswith(found(r"find_package\(esfem ([\d.]+)", "tests/consumer/CMakeLists.txt")))

    def test_so_is_its_date(self):
        date = found(r"^date-released: (.*)", "CITATION.cff")
        self.assertEqual(date, found(r"^## [\d.]+, (.*)", "CHANGELOG.md"))
        self.assertEqual(date, json.loads(read(".zenodo.json"))["publication_date"])
        self.assertEqual(date, json.loads(read("codemeta.json"))["datePublished"])

    def test_papers_have_their_doi_in_each_file(self):
        for paper in PAPERS:
            for path in ("CITATION.cff", ".zenodo.json", "codemeta.json", "paper.bib"):
                self.assertIn(paper.doi, read(path), path)

    def test_the_paper_cites_what_its_bibliography_has(self):
        self.assertEqual(set(re.findall(r"@(\w+)", read("paper.md"))), set(re.findall(r"^@\w+\{(\w+)", read("paper.bib"), re.MULTILINE)))

    def test_make_help(self):
        environment = {name: value for name, value in os.environ.items() if not name.startswith(("MAKE", "MFLAGS"))}
        done = subprocess.run(["make", "-s", "-C", ROOT, "help"], capture_output=True, text=True, check=False, env=environment)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for target in ("figures", "check", "report", "findings", "gallery", "docs", "site"):
            self.assertRegex(done.stdout, rf"(?m)^make [\w |]*\b{target}\b")

    def test_the_container_has_the_packages_of_the_lists(self):
        self.assertIn("packages.txt packages-tests.txt | xargs apt-get install", read("Containerfile"))


if __name__ == "__main__":
    unittest.main()
