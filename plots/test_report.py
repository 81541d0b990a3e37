# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of the report and of the gallery that is made from it."""
import glob
import html.parser
import io
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

from matplotlib.figure import Figure
from PIL import Image

import gallery
import report
import style
from report_content import PAPERS
from report_data import Statement, figure_verdict, grouped, place, read_results, verdict
from report_export import exports
from report_html import small_png, text
from table import TableError
from testing import FOLDER, synthetic_table


def claim(name, basis="statement", where="§13.1, Fig. 13.1", paper="kll19", **changes):
    """A verdict as check_orders writes it."""
    source = {"paper": paper, "place": where, "basis": basis} | ({"quote": "words of the paper"} if basis == "statement" else {})
    made = {"id": name, "statement": f"statement of {name}", "source": source,
            "kind": "order", "quantity": "x", "norm": "nodal_H1", "variable": "tau", "finding": "",
            "met": True, "outcome": "holds", "as_expected": True,
            "measured": "2.95 [2.79, 3.11]", "expected": ">= 2.5", "rows_used": 30, "where": {"flow": "mean_curvature"}, "figures": ["13.1"] if "13.1" in where else [],
            "reason": "", "remark": ""}
    return made | changes


FAILS = {"met": False, "outcome": "fails", "as_expected": False}
CANNOT_BE_TOLD = {"met": False, "outcome": "cannot be told", "as_expected": True}


class Words(unittest.TestCase):
    def test_mathematics(self):
        self.assertEqual(text("O(tau^3) for |nu_h| >= 1 & h^2"),
                         "O(τ<sup>3</sup>) for |ν<sub>h</sub>| ≥ 1 &amp; h<sup>2</sup>")
        self.assertEqual(text("small_ellipsoid, (3.4) of number"), "small_ellipsoid, (3.4) of number")
        self.assertEqual(text("4 pi², rho² - 1, pipe"), "4 π², ρ² - 1, pipe")
        self.assertEqual(text("Gamma_h, order q <= 5"), "Γ<sub>h</sub>, order q ≤ 5")
        self.assertEqual(text("h^1.5. R³ = R_0³, h^(k+1), 10^-4."),
                         "h<sup>1.5</sup>. R³ = R<sub>0</sub>³, h<sup>k+1</sup>, 10<sup>−4</sup>.")
        self.assertEqual(text("1.6e-03, 5.8e+00, -0.9, (3.4)-(3.5), Cahn-Hilliard, x-order-h-2, O(tau^1..5)"),
                         "1.6·10<sup>−3</sup>, 5.8, −0.9, (3.4)–(3.5), Cahn–Hilliard, x-order-h-2, O(τ<sup>1..5</sup>)")
        self.assertEqual(text("x1 in H1 and L2"), "x<sub>1</sub> in H<sup>1</sup> and L<sup>2</sup>")

    def test_verdicts(self):
        self.assertEqual(verdict(claim("a")), "reproduced")
        self.assertEqual(verdict(claim("a", "finding")), "holds")
        self.assertEqual(verdict(claim("a", finding="corrected")), "corrected")
        self.assertEqual(verdict(claim("a", finding="corrected", **FAILS)), "claim not met")

    def test_what_cannot_be_told_is_no_failure_where_the_reference_says_so(self):
        self.assertEqual(verdict(claim("a", **CANNOT_BE_TOLD)), "cannot be told")
        self.assertEqual(verdict(claim("a", **CANNOT_BE_TOLD | {"as_expected": False})), "claim not met")
        self.assertEqual(self.verdict_of(claim("a"), claim("b", **CANNOT_BE_TOLD)), "reproduced, but")
        self.assertEqual(self.verdict_of(claim("b", **CANNOT_BE_TOLD)), "cannot be told")

    def verdict_of(self, *claims):
        return Statement("mcf_sphere", list(claims)).verdict

    def test_a_statement_that_holds_in_some_settings_is_reproduced_but(self):
        holds, fails = claim("a"), claim("b", finding="not reproduced")
        self.assertEqual(self.verdict_of(holds, holds), "reproduced")
        self.assertEqual(self.verdict_of(fails), "not reproduced")
        self.assertEqual(self.verdict_of(holds, fails), "reproduced, but")
        self.assertEqual(self.verdict_of(holds, claim("c", finding="corrected")), "corrected")
        self.assertEqual(self.verdict_of(fails, claim("d", **FAILS)), "claim not met")

    def test_a_statement_is_of_a_family_when_all_of_its_checks_are(self):
        members = [claim("a", family="orders"), claim("b", family="orders")]
        self.assertEqual(Statement("mcf_sphere", members).family, "orders")
        self.assertEqual(Statement("mcf_sphere", [*members, claim("c")]).family, "")

    def test_claims_of_one_sentence_are_one_statement(self):
        same = [claim("a"), claim("b", statement="statement of a", norm="nodal_L2"), claim("c")]
        self.assertEqual([len(statement.claims) for statement in grouped("mcf_sphere", same, {})], [2, 1])


class Page(html.parser.HTMLParser):
    """Tags that are open, and what would be loaded from elsewhere."""

    def __init__(self, page):
        super().__init__()
        self.open, self.loaded, self.words, self.ids, self.targets = [], [], [], [], []
        self.feed(page)

    def handle_starttag(self, tag, attrs):
        if tag not in ("meta", "img", "br", "link"):
            self.open.append(tag)
        for key, value in attrs:
            if key == "id":
                self.ids.append(value)
            if key == "href" and value.startswith("#"):
                self.targets.append(value[1:])
            if key == "src" and not value.startswith("data:") or key == "href" and not value.startswith(("#", "https://doi.org/")):
                self.loaded.append(value)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        self.words.append(data)


class Report(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        table = synthetic_table((0.49, 0.35), range(3))
        table["parameters"]["preset"] = "paper"
        table["fits"] = [{"quantity": "x", "norm": "lifted_H1", "variable": "tau", "order": 2.9, "ci95": [2.8, 3.0],
                          "labels": {"flow": "mean_curvature"}},
                         {"quantity": "x", "norm": "lifted_H1", "variable": "h", "order": 2.5, "ci95": None,
                          "remark": "rising, 2.4 -> 2.9", "labels": {"flow": "mean_curvature"}}]
        table["provenance"] = {"git": "0123456789abcdef", "dirty": False, "date": "2024-02-03T04:05:06Z", "command": "mcf_sphere"}
        table["rows"][0]["status"] = "failed: step 3, t = 0.1: degenerate element 7"
        self.write("table.json", table)
        self.write("reference/mcf_sphere.json", {})
        figure = Figure(figsize=(2, 1))
        figure.add_subplot().plot([0, 1])
        style.save(figure, os.path.join(self.folder, "figures/kll19/fig13_1"))

    def write(self, name, data):
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            json.dump(data, file)
        return path

    def verdicts(self, *claims, schema="esfem-verdicts/1"):
        table = {"experiment": "mcf_sphere", "paper": "kll19", "table": os.path.join(self.folder, "table.json"),
                 "claims": list(claims), "elsewhere": 1,
                 "families": {"orders": {"statement": "order q in tau", "met": 1, "claims": 2}}}
        return self.write("verdicts.json", {"schema": schema, "tables": [table]})

    def page(self, *claims, catches=None):
        self.results = read_results(self.verdicts(*claims), os.path.join(self.folder, "reference"))
        page = report.report_html(self.results, os.path.join(self.folder, "figures"), catches)
        parsed = Page(page)
        self.assertEqual(parsed.open, [])
        self.assertEqual(parsed.loaded, [], "the page needs no other file")
        self.assertEqual(len(parsed.ids), len(set(parsed.ids)), "each place has one name")
        self.assertEqual(set(parsed.targets) - set(parsed.ids), set(), "each link leads somewhere")
        return page, " ".join(parsed.words)

    def test_a_page_has_figure_claims_verdicts_orders_runs_and_provenance(self):
        page, words = self.page(claim("a"), claim("b", finding="corrected", remark="a sign of (2.18)"),
                                claim("c", "theory", "Theorem 6.1"), claim("d", "independent", "a table", "independent"))
        for expected in ("statement of a", "2.95 [2.79, 3.11]", "a sign of (2.18)", "corrected", "Theorems and text", "2.90 ± 0.10",
                         "failed at 0.1", "0123456789ab", "2024-02-03", "1 of 2 statements of the papers are reproduced",
                         "1 more checks belong", "doi:10.1007/s00211-019-01074-2"):
            self.assertIn(expected, words)
        self.assertEqual(page.count("<figure"), 1)
        self.assertIn("figure kll19/fig13_2", self.results.missing)
        self.assertIn("figure gallery/all_orders", words, "what is missing is said")

    def test_every_statement_has_one_place(self):
        self.page(claim("a"), claim("b", where="§14"), claim("c", "finding", "own runs", "esfem"),
                  claim("d", "independent", "a table", "independent", figures=["13.2"]))
        placed = place(self.results)
        self.assertEqual({key: len(statements) for key, statements in placed.items()},
                         {("kll19", "13.1"): 1, ("kll19", ""): 1, ("kll19", "mcf_sphere"): 1, ("kll19", "13.2"): 1})

    def test_each_published_figure_has_a_sentence_without_numbers(self):
        for paper in PAPERS:
            for number in dict.fromkeys(figure.number for figure in paper.figures):
                found = next(figure.found for figure in paper.figures if figure.number == number)
                self.assertRegex(found, r"^[A-Z].*\.$", f"{paper.key} {number}")
                self.assertNotRegex(re.sub("[HL][12]", "", found), r"\d", f"{paper.key} {number}: numbers come from tables")

    def test_a_figure_that_does_not_exist_is_an_error(self):
        for wrong in (claim("a", figures=["13.9"]), claim("a", figures=["7.1"]), claim("a", figures=["13.1", "1"])):
            with self.assertRaisesRegex(TableError, r"mcf_sphere: claim a: there is no figure .* of kll19; known are 13.1, "):
                self.page(wrong)

    def test_a_family_is_one_line_that_opens_to_its_members(self):
        page, words = self.page(claim("a", family="orders"), claim("b", family="orders", **FAILS, reason="too low"),
                                claim("c"))
        self.assertIn("order q in τ: 1 of 2 met", words)
        self.assertIn("2 of 3 statements of the papers are reproduced", words)
        family = page[page.index('<details class="family">'):]
        family = family[:family.index("</details>")]
        for inside in ("statement of a", "statement of b", "too low", "claim not met"):
            self.assertIn(inside, family)
        self.assertNotIn("statement of c", family)

    def test_remarks_link_to_the_claims_that_they_name(self):
        page, words = self.page(claim("a", remark="see u-fine and runs, not elsewhere-checked; no claims: well-known, runs"),
                                claim("u-fine"), claim("runs"), claim("b", remark="see not-at-this-preset and H-tau"))
        for name in ("u-fine", "runs"):
            self.assertEqual(page.count(f'<a href="#mcf_sphere.{name}" title='), 1)
        self.assertIn("see not-at-this-preset and H-tau, checked at the other preset", words)

    def test_committed_remarks_name_claims_that_exist(self):
        known, named = [], []
        for path in glob.glob(os.path.join(os.path.dirname(FOLDER), "reference/*.json")):
            with open(path, encoding="utf-8") as file:
                for entry in json.load(file)["claims"]:
                    known.append(".+".join(map(re.escape, re.split(r"\{[^}]*\}", entry["id"]))))
                    words = [entry.get(key, "") for key in ("statement", "remark")]
                    words += [change.get("remark", "") or "" for change in entry.get("except", [])]
                    named += [(path, name) for text_ in words for name in re.findall(r"\bsee ([a-z]\w*(?:-[\w.]*\w)+)", text_)]
        self.assertGreater(len(named), 20)
        for path, name in named:
            self.assertRegex(name, f"^(?:{'|'.join(known)})$", path)

    def test_own_runs_are_not_counted_with_the_papers(self):
        page, words = self.page(claim("a"), claim("b", "finding", "own runs", "esfem"), claim("c", "regression", "own runs", "esfem"))
        self.assertIn("1 of 1 statements of the papers", words)
        self.assertIn("1 of 1 checks of what this project’s own runs show", words)
        self.assertIn("Own runs: 2 checks", words)
        self.assertLess(page.index("statement of a"), page.index('<details class="own">'))

    def test_a_reader_sees_figures_and_differences_first(self):
        page, _ = self.page(claim("a"), claim("b", finding="corrected", remark="a sign"), claim("c", finding="not reproduced"),
                                claim("d", statement="other words", finding="corrected", remark="a sign"))
        self.assertLess(page.index("what it shows, and what the runs say"), page.index('id="kll19-claims"'))
        front = page[page.index('id="kll19-differences"'):page.index('id="nick18"')]
        self.assertLess(front.index("statement of c"), front.index("statement of b"))
        self.assertEqual(front.count("a sign"), 1, "statements that differ for the same reason are one entry")

    def test_the_verdict_of_a_figure(self):
        def of(*claims):
            return figure_verdict([Statement("mcf_sphere", [one]) for one in claims])[0]
        untold = claim("u", **CANNOT_BE_TOLD)
        self.assertEqual(of(claim("a")), "reproduced")
        self.assertEqual(of(claim("a"), untold), "reproduced")
        self.assertEqual(of(untold), "cannot be told")
        self.assertEqual(of(claim("a"), claim("b", finding="not reproduced")), "reproduced, but")
        self.assertEqual(of(claim("a"), claim("b", **FAILS)), "claim not met")
        self.assertEqual(of(claim("b", "finding")), "")

    def test_what_a_claim_catches(self):
        _, words = self.page(claim("a"), catches={"mcf_sphere": {"a": ["tau forgotten", "wrong sign"]}})
        self.assertIn("catches: τ forgotten, wrong sign", words)

    def test_exports(self):
        self.page(claim("a", remark="50%"), claim("b", statement="|nu_h| >= 1 & ²"))
        files = exports(self.results)
        self.assertEqual(files["claims.csv"].count("\n"), 3)
        self.assertIn("mcf_sphere,a,kll19,", files["claims.csv"])
        self.assertIn(r"$|$nu\_h$|$ $>$= 1 \& $^2$", files["claims.tex"])
        self.assertIn("mcf_sphere,flow mean_curvature,x,lifted_H1,tau,2.900,2.800,3.000", files["orders.csv"])
        for name, text_ in files.items():
            if name.endswith("tex"):
                widths = {line.replace(r"\&", "").count("&") for line in text_.splitlines() if line.endswith(r"\\")
                          and not line.startswith(r"\caption")}
                self.assertEqual(len(widths), 1, name)

    def test_unmet_claims_are_seen_first(self):
        _, words = self.page(claim("a"), claim("b", **FAILS, reason="Convergence order not achieved"))
        self.assertIn("1 of 2 statements of the papers are reproduced", words)
        self.assertLess(words.index("Convergence order not achieved"), words.index("statement of a"))

    def run_report(self, verdicts, *options):
        command = [sys.executable, os.path.join(FOLDER, "report.py"), verdicts, os.path.join(self.folder, "figures"),
                   os.path.join(self.folder, "report"), "--reference", os.path.join(self.folder, "reference"), *options]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def test_command_line(self):
        done = self.run_report(self.verdicts(claim("a")))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("1 figures, 1 claims", done.stdout)
        with open(os.path.join(self.folder, "report/report.pdf"), "rb") as file:
            self.assertEqual(file.read(5), b"%PDF-")
        incomplete = self.run_report(self.verdicts(claim("a")), "--without-pdf", "--expect", "everything")
        self.assertEqual(incomplete.returncode, 1)
        self.assertEqual(self.run_report(self.verdicts(claim("a")), "--without-pdf", "--expect", "tables").returncode, 0)
        self.write("reference/mcf_dumbbell.json", {})
        no_table = self.run_report(self.verdicts(claim("a")), "--without-pdf", "--expect", "tables")
        self.assertEqual(no_table.returncode, 1)
        self.assertIn("results of mcf_dumbbell", no_table.stdout)

    def test_bad_input_is_one_line(self):
        for verdicts in (self.verdicts(claim("a"), schema="other"), os.path.join(self.folder, "none.json")):
            done = self.run_report(verdicts)
            self.assertEqual(done.returncode, 1)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "report")))

    def test_pictures_become_small(self):
        path = os.path.join(self.folder, "figures/kll19/fig13_1.png")
        with Image.open(io.BytesIO(small_png(path, 100))) as picture:
            self.assertEqual(picture.width, 100)

    def test_flows_of_the_schema(self):
        def rule(names, text):
            return {"if": {"properties": {key: {"const": name} for key, name in names.items()}}, "then": {"description": text}}
        table = gallery.flows({"allOf": [rule({"flow": "dziuk"}, "of nodes"),
                                         rule({"flow": "coupled", "problem": "tumour"}, "two kinds")]})
        self.assertEqual(table.splitlines()[2:], ["| `dziuk` |  | of nodes |", "| `coupled` | `tumour` | two kinds |"])

    def test_headline(self):
        self.page(claim("a"), claim("b", finding="not reproduced"), claim("c", "finding", "own", "esfem"), claim("d", "theory"),
                  claim("e", "theory", **FAILS), claim("f", "regression", "own", "esfem"))
        table = gallery.headline(self.results)
        self.assertIn("| [kll19](docs/findings/kll19.md): Mean curvature flow. B. Kovács, B. Li, Ch. Lubich, Numer. Math. 143 (2019) "
                      "| 1 | – | – | 1 | 1; 1 claim not met | – |", table)
        self.assertNotIn("claim not met", table.splitlines()[0])
        mark = "<!-- headline: written by make gallery -->"
        readme = f"before\n{mark}\nstale\n<!-- end of headline -->\nafter"
        new = gallery.with_table(readme, "headline", table)
        self.assertTrue(new.startswith("before\n") and new.endswith("\nafter") and "stale" not in new)
        self.assertEqual(gallery.with_table(new, "headline", table), new)
        for broken in ("no marks", readme + mark):
            with self.assertRaises(TableError):
                gallery.with_table(broken, "headline", table)


if __name__ == "__main__":
    unittest.main()
