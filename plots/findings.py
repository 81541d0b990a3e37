# SPDX-License-Identifier: GPL-3.0-or-later
"""The pages in docs/findings: what the runs found, with all numbers from the tables and verdicts.

Usage: python3 plots/findings.py VERDICTS DOCS      writes DOCS/findings/*.md
       python3 plots/findings.py --check DOCS       exit 1 where a page was made from other claims or another text

A page is made of plots/findings/NAME.md, in which {{..}} stand for numbers, and, for a paper, of its figures and claims:
  {{STEM CLAIM}}         what was measured for a claim, an order with its interval, as "2.82 ± 0.19"
  {{STEM CLAIM .4f}}     the same in a format of Python's, or its order alone ("order")
  {{order STEM QUANTITY NORM VARIABLE LABEL=VALUE ..}}    a fitted order of the table
  {{rows STEM}}          how many runs the table has
A number that is not there is an error. The head of a page says which claims, text and tables it is made from.
"""
import glob
import hashlib
import os
import re
import sys

from report_claims import Links, anchor
from report_content import PAPERS
from report_data import BEYOND_STEMS, OWN, differences, figure_verdict, of_section, place, read_results, verdict
from report_html import measured_words, text
from report_summary import DOI, UNTOLD
from report_tables import order_words
from table import TableError

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "findings")
REFERENCE = "reference"
MADE = "<!-- written by `make findings`; its text is plots/findings/{}.md -->"
SHOWN = 4
# A number of a remark that a run could have measured: no count of nodes, no percentage, no part of a name or a formula.
MEASURED = re.compile(r"(?<![\w.^§(/])\d+(?:\.\d+)?(?:e-?\d+)?(?![\w%]|\.\d| nodes| degrees)")
NEAR = 0.15


def digest(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()[:12]


def stems_of(name):
    """The experiments whose claims a page has: those of its paper, all others on "beyond", on other pages those it names."""
    papers = {paper.key: {figure.stem for figure in paper.figures} for paper in PAPERS}
    stems = sorted(os.path.splitext(os.path.basename(path))[0] for path in glob.glob(f"{REFERENCE}/*.json"))
    if name in papers:
        return [stem for stem in stems if stem in papers[name] or stem in BEYOND_STEMS]
    if name == "beyond":
        return [stem for stem in stems if not any(stem in of for of in papers.values())]
    with open(f"{FOLDER}/{name}.md", encoding="utf-8") as file:
        words = file.read()
    return [stem for stem in stems if stem in words]


def made_from(name):
    """The line of a page that says what it is made from, apart from the tables."""
    inputs = [f"{FOLDER}/{name}.md"] + [f"{REFERENCE}/{stem}.json" for stem in stems_of(name)]
    return "<!-- made from " + ", ".join(f"{os.path.basename(path)} {digest(path)}" for path in inputs) + " -->"


class Numbers:
    """What {{..}} stand for."""

    def __init__(self, results):
        self.tables = results.tables
        self.claims = {(s.stem, claim["id"]): claim for s in results.statements for claim in s.claims}

    def filled(self, words, where):
        return re.sub(r"\{\{([^}]*)\}\}", lambda match: self._number(match[1].split(), where), words)

    def _number(self, words, where):
        if words[0] == "order":
            return self._order(*words[1:5], dict(word.split("=", 1) for word in words[5:]), where)
        if words[0] == "rows":
            return str(len(self.tables[words[1]]["rows"]))
        claim = self.claims.get(tuple(words[:2]))
        if not claim:
            raise TableError(f"{where}: there is no claim {' '.join(words[:2])}")
        measured = claim["measured"]
        if len(words) == 2:
            interval = re.fullmatch(r"(\S+) \[(\S+), (\S+)\]", measured)
            if interval:
                order, low, high = map(float, interval.groups())
                return f"{order:.2f} ± {(high - low) / 2:.2f}"
            changes = re.fullmatch(r"(\S+), (.*)", measured)
            return arrow(f"{changes[1]} ({changes[2]})" if changes else measured.replace("-", "none") if measured == "-" else measured)
        number = float(re.match(r"[-+.\de]+", measured)[0])
        return f"{number:.2f}" if words[2] == "order" else re.sub(r"e([-+])0", r"e\1", re.sub("^-", "−", format(number, words[2])))

    def _order(self, stem, quantity, norm, variable, labels, where):
        for fit in self.tables[stem].get("fits", []):
            has = {name: str(value) for name, value in fit.get("labels", {}).items()}
            if (fit["quantity"], fit["norm"], fit["variable"]) == (quantity, norm, variable) and labels.items() <= has.items():
                return arrow(order_words(fit))
        raise TableError(f"{where}: {stem} has no fit of {quantity} {norm} {variable} {labels}")


def arrow(words):
    """Slopes that still change, from coarse to fine: "2.22 (falling, 2.4 → 2.1)" is "2.4 → 2.1"."""
    changing = re.search(r"(?:rising|falling), (\S+) (?:->|→|-&gt;) (-?[\d.]+)", words)
    return f"{changing[1]} → {changing[2]}" if changing else words


def cell(words):
    """A sentence of a claim for a table in Markdown."""
    return escaped(text(words))


def escaped(made):
    """HTML for a cell of a table in Markdown."""
    return made.replace("|", "&#124;").replace("*", "&#42;")


class Remarks:
    """Remarks in which names of claims lead to where the pages list them."""

    def __init__(self, placed, results):
        self.links = Links(results)
        self.pages = {}
        for (section, _), statements in placed.items():
            for statement in statements:
                if not statement.family and statement.source["basis"] != "regression":
                    self.pages.update({anchor(statement.stem, claim["id"]): section for claim in statement.claims})

    def cell(self, stem, words, page):
        """Words of a claim of `stem` for a table of `page`."""
        made = []
        for part, target in self.links.parts(stem, words):
            if not target:
                made.append(cell(part))
            elif target in self.pages:
                other = "" if self.pages[target] == page else self.pages[target] + ".md"
                made.append(f"[`{part}`]({other}#{target})")
            else:
                made.append(f"`{part}`")
        return "".join(made)


def table(heads, rows):
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def check(stem, claim, remarks, page):
    """What was measured, and the remark, of one check, with its name, to which remarks lead."""
    remark = f": {remarks.cell(stem, claim['remark'], page)}" if claim["remark"] else ""
    return f'<a id="{anchor(stem, claim["id"])}"></a>`{claim["id"]}` {escaped(measured_words(claim["measured"]))}{remark}'


def statement_row(statement, remarks, page):
    # A remark that several checks share is written once.
    parts, before = [], None
    for claim in statement.claims:
        parts.append(check(statement.stem, claim if claim["remark"] != before else claim | {"remark": ""}, remarks, page))
        before = claim["remark"]
    words = remarks.cell(statement.stem, statement.first["statement"], page)
    return [statement.verdict, f"{words} ({cell(statement.source['place'])})", "<br>".join(parts)]


def statements_table(statements, remarks, page):
    """A row for each statement, and a line for each family."""
    single = [statement for statement in statements if not statement.family]
    parts = [table(["verdict", "statement", "measured"], [statement_row(s, remarks, page) for s in single])] if single else []
    families = {}
    for statement in statements:
        if statement.family:
            families.setdefault((statement.stem, statement.family), []).append(statement)
    lines = []
    for (stem, name), group in families.items():
        claims = [claim for statement in group for claim in statement.claims]
        met = sum(claim["met"] for claim in claims)
        untold = sum(verdict(claim) == "cannot be told" for claim in claims)
        lines.append(f"- {text(group[0].families[name]['statement'])} (`{stem}`): {met} of {len(claims)} met"
                     + (f", {untold} cannot be told" if untold else ""))
    return "\n\n".join(parts + (["\n".join(lines)] if lines else []))


def figures_table(paper, placed):
    rows = {}
    for figure in paper.figures:
        name, tally = figure_verdict(placed.get((paper.key, figure.number), []))
        rows.setdefault(figure.number, [figure.number, f"{cell(figure.caption)} {cell(figure.found)}", f"`{figure.stem}`",
                                        f"{name or 'no statement'}{f' ({tally})' if tally and tally[2:] != name else ''}"])
    return table(["figure", "what it shows, and what the runs say", "executable", "verdict"], rows.values())


def differences_table(statements, remarks, page):
    rows = []
    for name, why, group in differences(statements):
        words = "<br>".join(f"{cell(s.first['statement'])} ({cell(s.source['place'])})" for s in group[:SHOWN])
        words += f"<br>and {len(group) - SHOWN} more" if len(group) > SHOWN else ""
        rows.append([name, words, remarks.cell(group[0].stem, why or (UNTOLD if len(group) > 1 else group[0].worst["reason"]), page)])
    return table(["verdict", "statement", "why"], rows) if rows else "Nothing."


def provenance(results, stems):
    """The version of the tables that a page is made from."""
    origins = [results.tables[stem].get("provenance", {}) for stem in stems if stem in results.tables]
    def values(key, short=None):
        found = [value for origin in origins for value in (origin.get(key) if isinstance(origin.get(key), list) else [origin.get(key)])]
        return ", ".join(sorted({str(value)[:short] for value in found if value}))
    return (f"*Tables of {values('date', 10)}, version {values('version')}, commit {values('git', 10)}, {values('compiler')}, "
            f"{values('cpu')}. The report has all checks and all orders: `make report`.*")


def paper_page(paper, placed, results, remarks, story):
    statements = of_section(placed, paper.key)
    theirs = [s for s in statements if s.source["basis"] not in OWN]
    own = [s for s in statements if s.source["basis"] == "finding"]
    doi = f", [doi:{paper.doi}]({DOI}{paper.doi})" if paper.doi else ""
    stems = {s.stem for s in statements}
    return [f"# {paper.name} ({paper.key})", f"{paper.authors}: {paper.title}. {paper.journal}{doi}. {cell(paper.about)}",
            provenance(results, sorted(stems)), "## Figures", figures_table(paper, placed), "## What differs", differences_table(statements, remarks, paper.key),
            story, "## All statements", statements_table(theirs, remarks, paper.key), "## What the project's own runs show", statements_table(own, remarks, paper.key)]


def beyond_page(placed, results, remarks, story):
    parts = ["# Beyond the papers", provenance(results, [stem for stem in BEYOND_STEMS if stem in results.tables]), story]
    for stem in dict.fromkeys(BEYOND_STEMS):
        statements = [s for s in placed.get(("beyond", stem), []) if s.source["basis"] != "regression"]
        if statements:
            parts += [f"## Claims of `{stem}`", statements_table(statements, remarks, "beyond")]
    return parts


def page(name, placed, results, remarks):
    """The text of a page."""
    with open(f"{FOLDER}/{name}.md", encoding="utf-8") as file:
        story = Numbers(results).filled(file.read().strip(), f"plots/findings/{name}.md")
    papers = {paper.key: paper for paper in PAPERS}
    if name in papers:
        parts = paper_page(papers[name], placed, results, remarks, story)
    else:
        parts = beyond_page(placed, results, remarks, story) if name == "beyond" else [story]
    return "\n\n".join([MADE.format(name) + "\n" + made_from(name), *parts]) + "\n"


def names():
    return sorted(os.path.splitext(os.path.basename(path))[0] for path in glob.glob(f"{FOLDER}/*.md"))


def numbers_in(words):
    """(value, half a unit of its last digit) of the numbers of a sentence that could be measured ones."""
    for match in MEASURED.finditer(words):
        mantissa, _, exponent = match[0].partition("e")
        whole, _, decimals = mantissa.partition(".")
        zeros = 0 if decimals else len(whole) - len(whole.rstrip("0"))
        yield float(match[0]), 0.5 * 10.0 ** (int(exponent or 0) - len(decimals) + zeros)


def is_of_earlier_runs(claim):
    """Whether numbers of a remark are near what was measured, but none is it: they were measured in earlier runs."""
    number = MEASURED.match(claim["measured"].lstrip("-"))
    if not number or float(number[0]) == 0:
        return False
    measured, bounds = float(number[0]), {value for value, _ in numbers_in(claim["expected"])}
    near = [(value, half) for value, half in numbers_in(claim["remark"]) if abs(value - measured) <= NEAR * measured and value not in bounds]
    return bool(near) and all(abs(value - measured) > 1.001 * half for value, half in near)


def outdated_remarks(results, allowed):
    """A line for each remark with numbers of earlier runs; `allowed`: words of remarks, by file, with others that are meant."""
    return [f"{REFERENCE}/{statement.stem}.json: {claim['id']}: measured {claim['measured']}, but: {claim['remark']}"
            for statement in results.statements for claim in statement.claims
            if is_of_earlier_runs(claim) and not any(words in claim["remark"] for words in allowed.get(f"{REFERENCE}/{statement.stem}.json", []))]


def allowed_numbers():
    """{file: words around a number that may be typed}."""
    words = {}
    with open(f"{os.path.dirname(FOLDER)}/typed_numbers.txt", encoding="utf-8") as file:
        for line in file:
            if line.strip() and not line.startswith("#"):
                name, what, why = line.split(": ", 2)
                assert why.strip(), line
                words.setdefault(name, []).append(what)
    return words


def outdated(docs):
    """What is wrong with the pages that are there, a line each."""
    wrong = []
    for name in names():
        path = f"{docs}/findings/{name}.md"
        try:
            with open(path, encoding="utf-8") as file:
                head = file.read().split("\n\n")[0]
        except OSError as error:
            wrong.append(f"{path}: {error.strerror}")
            continue
        expected = made_from(name)
        if expected not in head:
            changed = sorted(set(expected.split(", ")) - set(head.split(", ")))
            wrong.append(f"{path} was made from other inputs: {'; '.join(changed)}. With the published tables: make findings")
    return wrong


def write_all(verdicts, docs):
    results = read_results(verdicts, REFERENCE)
    wrong = outdated_remarks(results, allowed_numbers())
    if wrong:
        raise TableError("remarks with numbers of earlier runs; correct them, or say in plots/typed_numbers.txt what they are:\n" + "\n".join(wrong))
    placed = place(results)
    remarks = Remarks(placed, results)
    os.makedirs(f"{docs}/findings", exist_ok=True)
    for name in names():
        made = page(name, placed, results, remarks)
        with open(f"{docs}/findings/{name}.md", "w", encoding="utf-8") as file:
            file.write(made)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    try:
        if sys.argv[1] == "--check":
            wrong = outdated(sys.argv[2])
            if wrong:
                sys.exit("\n".join(wrong))
        else:
            write_all(*sys.argv[1:])
    except (TableError, OSError) as error:
        sys.exit(f"{os.path.basename(sys.argv[0])}: {error}")


if __name__ == "__main__":
    main()
