# SPDX-License-Identifier: GPL-3.0-or-later
"""What the report is made from: tables, verdicts on claims, and which claim belongs to which figure."""
import glob
import json
import os
from dataclasses import dataclass, field

from report_content import BEYOND, PAPERS
from table import SCHEMA, TableError

VERDICT_SCHEMA = "esfem-verdicts/1"
# In the order of lists.
SEVERITY = ("claim not met", "not reproduced", "corrected", "cannot be told", "reproduced, but", "reproduced", "holds")
HOLDING = ("reproduced, but", "reproduced", "holds")
# What is counted beside the papers' statements, with the heads of the columns. What this project's own runs show
# (finding, regression) is no statement of a paper, and is not counted with them.
COUNTED_BASES = {"theory": "theorems and identities hold", "independent": "values of other programs and formulas met"}
OWN = ("finding", "regression")
BEYOND_STEMS = tuple(figure.stem for figure in BEYOND)
PAPER_KEYS = tuple(paper.key for paper in PAPERS)


@dataclass
class Statement:
    """A statement and the checks that it is held to, all of one table; `families`: what its families say, by id."""
    stem: str
    claims: list
    families: dict = field(default_factory=dict)

    @property
    def first(self):
        return self.claims[0]

    @property
    def source(self):
        return self.first["source"]

    @property
    def verdict(self):
        """That of its checks; reproduced in some settings and not in others is "reproduced, but"."""
        found = {verdict(claim) for claim in self.claims}
        for decisive in ("claim not met", "corrected"):
            if decisive in found:
                return decisive
        return found.pop() if len(found) == 1 else "reproduced, but"

    @property
    def figures(self):
        """Those of the paper, by number, that it is about."""
        return self.first["figures"]

    @property
    def family(self):
        """The id of the family that all of its checks are of; "" when there is none."""
        ids = {claim.get("family", "") for claim in self.claims}
        return ids.pop() if len(ids) == 1 else ""

    @property
    def worst(self):
        """The check that the verdict is most about."""
        return min(self.claims, key=lambda claim: SEVERITY.index(verdict(claim)))

    @property
    def is_published(self):
        return self.source["basis"] in ("statement", "theory")


@dataclass
class Results:
    """Tables and statements by stem; claims that this preset does not check; files that are not there."""
    tables: dict = field(default_factory=dict)
    statements: list = field(default_factory=list)
    elsewhere: int = 0
    missing: list = field(default_factory=list)


def verdict(claim):
    """In the words of the report. What no paper states (findings, independent and own values) holds or does not."""
    if not claim["as_expected"]:
        return "claim not met"
    if claim["outcome"] == "cannot be told":
        return claim["outcome"]
    if claim["finding"]:
        return claim["finding"]
    return "reproduced" if claim["source"]["basis"] in ("statement", "theory") else "holds"


def read_json(path):
    """The JSON in a file. Raises TableError."""
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError) as error:
        raise TableError(f"{path}: {error}") from error


def read_results(path, reference):
    """The verdicts in a file with the tables they are about, and what of reference/*.json has none. Raises TableError."""
    results = Results()
    verdicts = read_json(path)
    if not isinstance(verdicts, dict) or verdicts.get("schema") != VERDICT_SCHEMA:
        raise TableError(f'{path}: expected schema "{VERDICT_SCHEMA}"')
    for entry in verdicts["tables"]:
        table = read_json(entry["table"])
        if table.get("schema") != SCHEMA:
            raise TableError(f'{entry["table"]}: schema is {table.get("schema")!r}, expected "{SCHEMA}"')
        results.tables[entry["experiment"]] = table
        results.statements += grouped(entry["experiment"], entry["claims"], entry.get("families", {}))
        results.elsewhere += entry.get("elsewhere", 0)
    for path in sorted(glob.glob(os.path.join(reference, "*.json"))):
        stem = os.path.splitext(os.path.basename(path))[0]
        if stem not in results.tables:
            results.missing.append(f"results of {stem}")
    return results


def grouped(stem, claims, families):
    """Claims with the same words and the same source are checks of one statement."""
    groups = {}
    for claim in claims:
        key = (claim["statement"], claim["source"]["paper"], claim["source"]["place"], claim["source"]["basis"])
        groups.setdefault(key, []).append(claim)
    return [Statement(stem, group, families) for group in groups.values()]


def place(results):
    """{(section, key): statements}: ("kll19", "13.1") for a figure, ("kll19", "") for theorems and text,
    ("kll19", stem) for findings and independent values, ("beyond", stem) for what no paper has: there theorems stand, too.

    Raises TableError for a statement of a source, or about a figure, that the report does not know.
    """
    placed = {}
    numbers = {paper.key: [figure.number for figure in paper.figures] for paper in PAPERS}
    for statement in results.statements:
        section = statement.source["paper"]
        if section not in PAPER_KEYS:
            section = results.tables[statement.stem]["paper"]
        _check_figures(statement, section, numbers.get(section, []))
        if statement.stem in BEYOND_STEMS and (section not in PAPER_KEYS or statement.source["basis"] != "statement"):
            section, key = "beyond", statement.stem
        elif section not in PAPER_KEYS:
            raise TableError(f"no place in the report for the claims of {statement.stem}: see report_content.py")
        else:
            key = statement.figures[0] if statement.figures else "" if statement.is_published else statement.stem
        placed.setdefault((section, key), []).append(statement)
    return placed


def _check_figures(statement, paper, known):
    for claim in statement.claims:
        for figure in claim["figures"]:
            if figure not in known:
                raise TableError(f"{statement.stem}: claim {claim['id']}: there is no figure {figure} of {paper}; "
                                 f"known are {', '.join(dict.fromkeys(known)) or 'none'}")


def counts(statements):
    """{verdict: number}, of the papers' statements, and {basis: words}, of theory and independent values: how many hold, and, as
    "10; 1 cannot be told", what of the others."""
    of_basis = {}
    for statement in statements:
        of_basis.setdefault(statement.source["basis"], []).append(statement)
    published = {name: sum(s.verdict == name for s in of_basis.get("statement", [])) for name in SEVERITY}
    others = {basis: _that_hold(of_basis[basis]) for basis in COUNTED_BASES if basis in of_basis}
    return published, others


def _that_hold(statements):
    others = [f"{number} {name}" for name in SEVERITY if name not in HOLDING
              for number in [sum(s.verdict == name for s in statements)] if number]
    return "; ".join([str(sum(s.verdict in HOLDING for s in statements)), *others])


def own_counts(results):
    """(that hold, all) of the checks of this project's own findings."""
    claims = [claim for statement in results.statements if statement.source["basis"] == "finding" for claim in statement.claims]
    return sum(verdict(claim) in HOLDING for claim in claims), len(claims)


def of_section(placed, section):
    """All statements of a paper, or of "beyond"."""
    return [statement for (where, _), group in placed.items() if where == section for statement in group]


def figure_verdict(statements):
    """(verdict, how many statements have which) of a figure: one that is reproduced in some respects and not in others is
    "reproduced, but". ("", "") where the paper says nothing of it that is checked."""
    published, _ = counts(statements)
    found = {name: number for name, number in published.items() if number}
    if not found:
        return "", ""
    tally = "; ".join(f"{number} {name}" for name, number in sorted(found.items(), key=lambda item: -SEVERITY.index(item[0])))
    if "claim not met" in found:
        return "claim not met", tally
    told = {name for name in found if name != "cannot be told"} or set(found)
    return told.pop() if len(told) == 1 else "reproduced, but", tally


def differences(statements):
    """[(verdict, why, statements)], most important first: what the papers state and does not simply hold. Statements with the
    same verdict for the same reason are one entry."""
    groups = {}
    for statement in statements:
        if statement.is_published and statement.verdict not in ("reproduced", "holds"):
            # An order that cannot be told is explained by numbers, which differ from one to the other.
            why = statement.worst["remark"] or ("" if statement.verdict == "cannot be told" else statement.worst["reason"])
            groups.setdefault((statement.verdict, why or statement.stem), (why, []))[1].append(statement)
    order = {name: i for i, name in enumerate(("claim not met", "not reproduced", "corrected", "reproduced, but", "cannot be told"))}
    entries = [(name, why, group) for (name, _), (why, group) in groups.items()]
    return sorted(entries, key=lambda entry: order[entry[0]])
