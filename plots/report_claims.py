# SPDX-License-Identifier: GPL-3.0-or-later
"""Claims in the report: tables of their checks, the lines of families, and links from a remark to the claims that it names."""
import html
import re

from report_data import Statement, verdict
from report_html import link, measured_words, table, tag, text

CLASSES = {"reproduced": "reproduced", "reproduced, but": "but", "corrected": "corrected", "not reproduced": "not",
           "cannot be told": "untold", "claim not met": "open", "holds": "holds"}
PRINTED_CHECKS = 80
WORD = re.compile(r"[A-Za-z0-9][\w.-]*\w")
NAME = r"[a-zA-Z]\w*(?:-\w+)+"
ELSEWHERE = re.compile(rf"\bsee {NAME}(?:(?:, | and ){NAME})*\b")


def badge(name):
    return tag("span", name, class_="verdict " + CLASSES[name])


def anchor(stem, name):
    return f"{stem}.{name}"


class Links:
    """Which claims there are, which of them remarks name, and which broken variants of the program each one catches."""

    def __init__(self, results, catches=None):
        self.known = {anchor(statement.stem, claim["id"]): claim for statement in results.statements for claim in statement.claims}
        self.catches = catches or {}
        self.named = set()
        for statement in results.statements:
            for claim in statement.claims:
                for words in (claim["statement"], claim["remark"]):
                    self.named.update(target for _, target in self.parts(statement.stem, words)
                                      if target and target != anchor(statement.stem, claim["id"]))

    def remark(self, stem, words, own=""):
        """A remark, or a statement, as HTML, in which names of claims are links to them; one that this preset does not check
        says so. `own`: the claim whose words these are, which needs no link to itself."""
        made = []
        for part, target in self.parts(stem, words):
            if target and target != own:
                claim = self.known[target]
                made.append(link(target, tag("code", html.escape(part)), title=claim["statement"]))
            else:
                made.append(_with_names(part))
        return "".join(made)

    def caught(self, stem, name):
        """A line with the broken variants that a check catches, where that is known."""
        variants = self.catches.get(stem, {}).get(name, [])
        return tag("div", "catches: " + text(", ".join(map(str, variants))), class_="place") if variants else ""

    def parts(self, stem, words):
        """[(words, anchor of the claim that they name, or None)]. Names without a hyphen are claims only behind "see"."""
        parts, done = [], 0
        for match in WORD.finditer(words):
            other = re.match(r" of (\w+)", words[match.end():])
            found = [target for target in (anchor(stem, match[0]), anchor(other[1], match[0]) if other else "") if target in self.known]
            behind_see = re.search(r"\bsee (?:[\w-]+(?:, | and | or ))*$", words[:match.start()])
            if found and (behind_see or "-" in match[0]):
                parts += [(words[done:match.start()], None), (match[0], found[0])]
                done = match.end()
        return parts + [(words[done:], None)]


def _with_names(words):
    """Words that name no claim of the page as HTML; names of other claims stay as they are."""
    made, done = [], 0
    for match in ELSEWHERE.finditer(words):
        made += [text(words[done:match.start()]), html.escape(match[0]), ", checked at the other preset"]
        done = match.end()
    return "".join(made) + text(words[done:])


def claim_rows(statement, links):
    """Rows of a claims table: the statement once, its checks one by one."""
    rows, before = [], None
    for i, claim in enumerate(statement.claims):
        first, last = i == 0, i == len(statement.claims) - 1
        quote = statement.source.get("quote", "")
        place_of = text(statement.source["place"]) + (f": “{text(quote)}”" if quote else "")
        words = links.remark(statement.stem, statement.first["statement"], anchor(statement.stem, statement.first["id"]))
        words += tag("div", place_of, class_="place")
        same_remark = not first and claim["remark"] == statement.claims[i - 1]["remark"]
        remark = "" if same_remark or not claim["remark"] else tag("span", links.remark(statement.stem, claim["remark"]), class_="remark")
        reason = tag("span", text(claim["reason"]), class_="remark") if claim["reason"] else ""
        target = anchor(statement.stem, claim["id"])
        settled = statement.verdict in ("reproduced", "holds") and target not in links.named
        kinds = ("" if last else "more", "settled" if settled else "")
        rows.append((" ".join(filter(None, kinds)),
                     ["" if verdict(claim) == before else badge(verdict(claim)), (words if first else "") + remark + reason,
                      _what(claim, target) + links.caught(statement.stem, claim["id"]), text(claim["expected"]), measured_words(claim["measured"])]))
        before = verdict(claim)
    return rows


def _what(claim, target):
    """Quantity, norm and labels of a check, and its name, to which remarks link."""
    norm = claim.get("norm", "").replace("_", " ").replace("H1 semi", "H1 seminorm")
    what = text(claim["quantity"].replace("_", " ") if claim["kind"] == "value" else claim["quantity"])
    if norm:
        what += ", " + text(norm)
    if "variable" in claim:
        what = f"order in {text(claim['variable'])}: {what}"
    labels = ", ".join(str(value) if name in ("flow", "run", "variant", "surface", "scheme") else f"{name} {value}"
                       for name, value in claim["where"].items())
    what += tag("div", text(labels.replace("_", " ")), class_="place") if labels else ""
    return what + tag("div", tag("code", html.escape(claim["id"])), class_="name", id=target)


def claims_table(statements, links):
    """The statements by themselves, then a line for each family, which opens to its members."""
    families = {}
    for statement in statements:
        families.setdefault(statement.family, []).append(statement)
    return statements_table(families.pop("", []), links) + "".join(family_html(name, of, links) for name, of in families.items())


def statements_table(statements, links):
    """All checks on the screen, a long list closed; of that, print has only those that do not simply hold."""
    rows = [row for statement in statements for row in claim_rows(statement, links)]
    if not rows:
        return ""
    if len(rows) <= PRINTED_CHECKS:
        return _table(rows)
    return tag("details", tag("summary", f"{len(rows)} checks") + _table(rows, short_in_print=True))


def family_html(name, statements, links):
    """How many of its members are met; in print those that do not simply hold."""
    claims = [claim for statement in statements for claim in statement.claims]
    first = statements[0]
    line = " ".join([badge(Statement(first.stem, claims).verdict), text(first.families[name]["statement"]) + ":",
                     f"{sum(claim['met'] for claim in claims)} of {len(claims)} met",
                     tag("span", text(first.source["place"]), class_="place")])
    rows = [row for statement in statements for row in claim_rows(statement, links)]
    return tag("details", tag("summary", line) + _table(rows, short_in_print=True), class_="family")


def _table(rows, short_in_print=False):
    """`short_in_print`: print leaves out what simply holds, and a table in which all of it does."""
    empty = short_in_print and all("settled" in kind for kind, _ in rows)
    return table(["verdict", "statement", "of what", "expected", "measured"], rows, "claims stacked",
                 " ".join(filter(None, ["short" if short_in_print else "", "screen" if empty else ""])))
