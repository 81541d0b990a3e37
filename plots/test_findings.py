# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of the pages in docs/: findings are those of the committed claims, numbers come from tables, links lead somewhere."""
import glob
import os
import re
import unittest

import findings
import gallery
from report_data import Results, Statement
from table import TableError
from test_report import CANNOT_BE_TOLD, claim
from testing import FOLDER

ROOT = os.path.dirname(FOLDER)
# What a result could contradict: orders, errors with exponents, counts, times.
NUMBERS = re.compile(r"\border(?:s)?(?: of)?(?: about)? -?\d+\.\d+|\b\d(?:\.\d+)?e-\d+\b|\b\d+ of \d+\b|"
                     r"\b\d+(?:\.\d+)? ?(?:ms|s|seconds|min|minutes|hours)\b|\d ± \d")
BLOCK = re.compile(r"<!-- (\w+): written by make gallery -->.*?<!-- end of \1 -->", re.DOTALL)
CODE = re.compile(r"```.*?```|`[^`\n]*`|\{\{[^}]*\}\}|\]\([^)]*\)", re.DOTALL)


def pages():
    """Paths of the pages whose text is typed, relative to the root."""
    found = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md"] + [f"docs/{os.path.basename(path)}" for path in glob.glob(f"{ROOT}/docs/*.md")]
    return found + [f"plots/findings/{os.path.basename(path)}" for path in glob.glob(f"{FOLDER}/findings/*.md")]


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def typed_numbers(words):
    """Numbers that results could contradict, each with the words around it, outside what a script writes, code and links."""
    words = " ".join(CODE.sub("", BLOCK.sub("", words)).split())
    return [words[max(0, match.start() - 60):match.end() + 20] for match in NUMBERS.finditer(words)]


class Pages(unittest.TestCase):
    def setUp(self):
        self.before = os.getcwd()
        os.chdir(ROOT)
        self.addCleanup(os.chdir, self.before)

    def test_findings_are_those_of_the_committed_claims(self):
        self.assertEqual(findings.outdated("docs"), [])

    def test_no_number_is_typed_that_a_result_could_contradict(self):
        words = findings.allowed_numbers()
        for page in pages():
            for around in typed_numbers(read(page)):
                self.assertTrue(any(what == "*" or what in around for what in words.get(page, [])),
                                f"{page}: {around}\nhas a number that no script writes: let one write it (plots/findings.py), or say in "
                                "plots/typed_numbers.txt why not")

    def test_the_numbers_that_are_allowed_are_there(self):
        for page, words in findings.allowed_numbers().items():
            for what in words:
                self.assertTrue(what == "*" or what in " ".join(CODE.sub("", read(page)).split()), f"typed_numbers.txt: {page} has no {what}")

    def test_such_numbers_are_found(self):
        for line in ("an order 2.9", "errors of 1.6e-3", "18 of 20 hold", "it takes 12 s", "3.09 ± 0.09"):
            self.assertEqual(typed_numbers(line), [line])
        for line in ("degree 2", "`1e-3`", "<!-- x: written by make gallery -->\n3 of 4\n<!-- end of x -->", "order {{a b .2f}}", "BDF2"):
            self.assertEqual(typed_numbers(line), [])

    def test_links_lead_somewhere(self):
        for page in [*pages(), *(f"docs/findings/{name}.md" for name in findings.names())]:
            if page.startswith("plots/"):
                continue
            for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"```.*?```", "", read(page), flags=re.DOTALL)):
                file, _, anchor = target.partition("#")
                if "://" in file:
                    continue
                path = os.path.normpath(os.path.join(os.path.dirname(page), file)) if file else page
                self.assertTrue(os.path.exists(path), f"{page}: {target}")
                if anchor:
                    heads = [re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in re.findall(r"^#+ (.*)", read(path), re.M)]
                    heads += re.findall(r'<a id="([^"]*)"', read(path))
                    self.assertIn(anchor, heads, f"{page}: {target}")

    def test_lists_are_set_off_by_a_blank_line(self):
        for page in pages():  # else python3-markdown, which makes the site, reads them as a part of the paragraph
            for before, line in zip(lines := CODE.sub("", read(page)).splitlines(), lines[1:]):
                self.assertFalse(line.startswith("- ") and re.match(r"[^\s-]", before), f"{page}: {line}")

    def test_the_readme_is_short(self):
        self.assertLessEqual(read("README.md").count("\n"), 130)


class Remarks(unittest.TestCase):
    def test_numbers_of_earlier_runs_are_found(self):
        for measured, remark in (("2.83", "order 2.9"), ("5.748e-01", "0.58 at the end"), ("404.247", "to 1.1%: 407.9"), ("-0.0157", "-1.5e-2")):
            self.assertTrue(findings.is_of_earlier_runs(claim("a", measured=measured, remark=remark)), remark)
        for measured, remark in (("2.83", "order 2.8, and 2.9 with BDF4"), ("397.879", "400 times as far"), ("0.082574", "the bound 0.083"),
                                 ("2.83", "with 3 curves"), ("10.2", "on 11 nodes, 9%"), ("-", "2.9"), ("2.83", "")):
            self.assertFalse(findings.is_of_earlier_runs(claim("a", measured=measured, remark=remark, expected=">= 0.08, <= 0.083")), remark)
        results = Results(statements=[Statement("mcf_sphere", [claim("a", measured="2.83", remark="order 2.9 by theory")])])
        self.assertEqual(len(findings.outdated_remarks(results, {})), 1)
        self.assertEqual(findings.outdated_remarks(results, {"reference/mcf_sphere.json": ["2.9 by theory"]}), [])


class Numbers(unittest.TestCase):
    def setUp(self):
        results = Results(statements=[Statement("mcf_sphere", [claim("a"), claim("b", measured="0.0769078"),
                                                               claim("c", measured="2.19, rising, 2.0 -> 2.4")])])
        results.tables["mcf_sphere"] = {"rows": [{}, {}], "fits": [
            {"quantity": "x", "norm": "lifted_H1", "variable": "h", "order": 2.5, "ci95": [2.4, 2.6], "labels": {"bdf": 3, "flow": "a"}}]}
        self.numbers = findings.Numbers(results)

    def filled(self, words):
        return self.numbers.filled("{{" + words + "}}", "a page")

    def test_what_double_braces_stand_for(self):
        self.assertEqual(self.filled("mcf_sphere a"), "2.95 ± 0.16")
        self.assertEqual(self.filled("mcf_sphere a order"), "2.95")
        self.assertEqual(self.filled("mcf_sphere b .4f"), "0.0769")
        self.assertEqual(self.filled("mcf_sphere b .1e"), "7.7e-2")
        self.assertEqual(self.filled("mcf_sphere c"), "2.0 → 2.4")
        self.assertEqual(self.filled("order mcf_sphere x lifted_H1 h bdf=3"), "2.50 ± 0.10")
        self.assertEqual(self.filled("rows mcf_sphere"), "2")

    def test_a_number_that_is_not_there_is_an_error(self):
        for wrong in ("mcf_sphere none", "order mcf_sphere x lifted_H1 h bdf=4", "order mcf_sphere v lifted_H1 h"):
            with self.assertRaisesRegex(TableError, "a page: "):
                self.filled(wrong)

    def test_statements(self):
        group = [Statement("mcf_sphere", [claim("a", remark="|nu_h| grows, see u-fine and see other")]),
                 Statement("mcf_sphere", [claim("u-fine", **CANNOT_BE_TOLD)])]
        other = Statement("mcf_sphere", [claim("other")])
        results = Results(statements=[*group, other])
        remarks = findings.Remarks({("kll19", "13.1"): group, ("beyond", "x"): [other]}, results)
        table = findings.statements_table(group, remarks, "kll19")
        self.assertIn('| reproduced | statement of a (§13.1, Fig. 13.1) | <a id="mcf_sphere.a"></a>`a` 2.95 [2.79, 3.11]: '
                      "&#124;ν<sub>h</sub>&#124; grows, see [`u-fine`](#mcf_sphere.u-fine) and see [`other`](beyond.md#mcf_sphere.other) |", table)
        self.assertIn("| cannot be told |", table)


class ReadmeTables(unittest.TestCase):
    def test_figures(self):
        results = Results()
        results.tables = {"mcf_sphere": {"rows": [{"seconds": 30.0}, {"seconds": 12.0}]}, "all_orders": {"rows": [{"seconds": 600.0}]}}
        table = gallery.figures_table(results)
        self.assertIn("| kll19 13.1, 13.2 | `mcf_sphere` | 42 s |", table)
        self.assertIn("`all_orders`", table.splitlines()[-1])
        self.assertIn("| 10 min |", table)

    def test_lines_of_a_program(self):
        self.assertEqual(gallery.program("  a;\n  b;\n  c;\n", ["a;", "c;"]), "```cpp\na;\nc;\n```")
        for wrong in (["c;", "a;"], ["d;"]):
            with self.assertRaises(TableError):
                gallery.program("  a;\n  b;\n  c;\n", wrong)


if __name__ == "__main__":
    unittest.main()
