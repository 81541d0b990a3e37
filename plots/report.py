# SPDX-License-Identifier: GPL-3.0-or-later
"""The reproduction report: one page with every figure, claim, verdict, table, and where they come from.

Usage: python3 plots/report.py VERDICTS FIGURES OUTPUT [--reference FOLDER] [--expect tables|everything] [--without-pdf]
Reads VERDICTS (check_orders --output), the tables that it names, and the PNGs of FIGURES; writes OUTPUT/index.html, which
needs no other file, OUTPUT/report.pdf, and all claims and orders as OUTPUT/{claims,orders}.{csv,tex}.
"""
import argparse
import datetime
import html
import os
import sys

from report_content import BEYOND, PAPERS
from report_data import BEYOND_STEMS, COUNTED_BASES, SEVERITY, Statement, counts, place, read_results, verdict
from report_export import exports
from report_html import number, picture, table, tag, text
from report_tables import fits_table, provenance_table, runs_table
from table import TableError

CLASSES = {"reproduced": "reproduced", "reproduced, but": "but", "corrected": "corrected", "not reproduced": "not",
           "cannot be told": "untold", "claim not met": "open", "holds": "holds"}
PRINTED_CHECKS = 80
PUBLISHED = ("reproduced", "reproduced, but", "cannot be told", "corrected", "not reproduced", "claim not met")


def badge(name):
    return tag("span", name, class_="verdict " + CLASSES[name])


def claim_rows(statement):
    """Rows of a claims table: the statement once, its checks one by one."""
    rows, before = [], None
    for i, claim in enumerate(statement.claims):
        first = i == 0
        quote = statement.source.get("quote", "")
        place_of = text(statement.source["place"]) + (f": “{text(quote)}”" if quote else "")
        words = text(statement.first["statement"]) + tag("div", place_of, class_="place")
        same_remark = not first and claim["remark"] == statement.claims[i - 1]["remark"]
        remark = "" if same_remark or not claim["remark"] else tag("span", text(claim["remark"]), class_="remark")
        reason = tag("span", text(claim["reason"]), class_="remark") if claim["reason"] else ""
        last = i == len(statement.claims) - 1
        rows.append(("" if last else "more",
                     ["" if verdict(claim) == before else badge(verdict(claim)),
                      (words if first else "") + remark + reason, _what(claim), text(claim["expected"]),
                      text(claim["measured"])]))
        before = verdict(claim)
    return rows


def _what(claim):
    """Quantity, norm and labels of a check."""
    norm = claim.get("norm", "").replace("_", " ").replace("H1 semi", "H1 seminorm")
    what = text(claim["quantity"].replace("_", " ") if claim["kind"] == "value" else claim["quantity"])
    if norm:
        what += ", " + norm.replace("H1", "H<sup>1</sup>").replace("L2", "L<sup>2</sup>")
    if "variable" in claim:
        what = f"order in {text(claim['variable'])}: {what}"
    labels = ", ".join(str(value) if name in ("flow", "run", "variant", "surface", "scheme") else f"{name} {value}"
                       for name, value in claim["where"].items())
    return what + (tag("div", text(labels.replace("_", " ")), class_="place") if labels else "")


def claims_table(statements):
    """The statements by themselves, then a line for each family, which opens to its members."""
    families = {}
    for statement in statements:
        families.setdefault(statement.family, []).append(statement)
    return statements_table(families.pop("", [])) + "".join(family_html(name, of) for name, of in families.items())


def _table(statements):
    rows = [row for statement in statements for row in claim_rows(statement)]
    return table(["verdict", "statement", "of what", "expected", "measured"], rows, "claims") if rows else ""


def _not_simply_holding(statements):
    return [statement for statement in statements if statement.verdict not in ("reproduced", "holds")]


def family_html(name, statements):
    """How many of its members are met; in print those that do not simply hold."""
    claims = [claim for statement in statements for claim in statement.claims]
    first = statements[0]
    line = " ".join([badge(Statement(first.stem, claims).verdict), text(first.families[name]["statement"]) + ":",
                     f"{sum(claim['met'] for claim in claims)} of {len(claims)} met",
                     tag("span", text(first.source["place"]), class_="place")])
    return (tag("details", tag("summary", line) + tag("div", _table(statements), class_="screen"), class_="family")
            + tag("div", _table(_not_simply_holding(statements)), class_="print"))


def statements_table(statements):
    """All checks on the screen; in print only those that do not simply hold."""
    rows = [row for statement in statements for row in claim_rows(statement)]
    if len(rows) <= PRINTED_CHECKS:
        return _table(statements)
    others = _table(_not_simply_holding(statements))
    note = tag("p", f"{len(rows)} checks, all in {tag('code', 'claims.csv')}" + ("; those that do not simply hold:" if others else
               ", and all of them hold."), class_="note print")
    return (tag("details", tag("summary", f"{len(rows)} checks") + _table(statements), class_="screen") + note
            + tag("div", others, class_="print"))


def figure_html(figure, folder, missing):
    """The picture with its caption, or a note that it was not drawn."""
    path = os.path.join(folder, figure.name + ".png")
    heading = f"Figure {figure.number}. " if figure.number else ""
    caption = tag("figcaption", f"{heading}{text(figure.caption)} {tag('code', figure.name + '.pdf')}, drawn from "
                  f"{tag('code', figure.stem)}")
    if not os.path.exists(path):
        missing.append(f"figure {figure.name}")
        return tag("div", f"{heading}{text(figure.caption)} Not drawn: {tag('code', 'make ' + figure.stem)} draws it.",
                   class_="missing")
    return tag("figure", picture(path, figure.caption) + caption, id=figure.name.replace("/", "-"))


def tables_html(stems, results):
    """Orders and runs of the tables of some experiments."""
    parts = []
    for stem in stems:
        if stem in results.tables:
            parts.append(tag("h3", f"Tables of {tag('code', stem)}") + fits_table(results.tables[stem])
                         + runs_table(results.tables[stem], stem))
    return "".join(parts)


def see_also(number, placed, section):
    """Statements that name this figure, but stand beside another one."""
    ids = [tag("code", claim["id"]) for (where, key), statements in placed.items() if where == section and key != number
           for statement in statements if number in statement.figures for claim in statement.claims[:1]]
    return tag("p", "See also " + ", ".join(ids) + ".", class_="note") if ids else ""


def paper_section(paper, placed, results, folder):
    """Its figures, each with its claims; theorems and text; what this project adds; the tables."""
    parts = [tag("h2", text(paper.title), id=paper.key),
             tag("p", f"{text(paper.authors)}, {text(paper.journal)} ({tag('code', paper.key)}). {text(paper.about)}",
                 class_="source")]
    numbers = list(dict.fromkeys(figure.number for figure in paper.figures))
    for figure_number in numbers:
        first, *others = [figure_html(figure, folder, results.missing) for figure in paper.figures
                          if figure.number == figure_number]
        parts += [tag("section", tag("h3", f"Figure {figure_number}") + first), *others]
        parts.append(claims_table(placed.get((paper.key, figure_number), [])))
        parts.append(see_also(figure_number, placed, paper.key))
    if (paper.key, "") in placed:
        parts.append(tag("h3", "Theorems and text") + claims_table(placed[paper.key, ""]))
    stems = [figure.stem for figure in paper.figures]
    stems += [stem for stem, entry in results.tables.items() if entry["paper"] == paper.key]
    stems = [stem for stem in dict.fromkeys(stems) if stem not in BEYOND_STEMS]
    own = [statement for stem in stems for statement in placed.get((paper.key, stem), [])]
    if own:
        parts.append(tag("h3", "Independent values, and findings of this project") + claims_table(own))
    return "".join(parts) + tables_html(stems, results)


def beyond_section(placed, results, folder):
    parts = [tag("h2", "Beyond the papers", id="beyond")]
    for i, figure in enumerate(BEYOND):
        parts.append(tag("section", tag("h3", text(figure.caption)) + figure_html(figure, folder, results.missing)))
        if all(figure.stem != later.stem for later in BEYOND[i + 1:]):
            parts.append(claims_table(placed.get(("beyond", figure.stem), [])))
    return "".join(parts) + tables_html(dict.fromkeys(figure.stem for figure in BEYOND), results)


def counts_table(placed):
    """Statements by verdict, a row for each paper."""
    titles = {paper.key: f"{paper.name} ({paper.key})" for paper in PAPERS} | {"beyond": "Beyond the papers"}
    rows = []
    for section, title in titles.items():
        statements = [statement for (where, _), group in placed.items() if where == section for statement in group]
        published, others, checks = counts(statements)
        cells = [str(published[name]) if published[name] else "" for name in PUBLISHED]
        for basis in COUNTED_BASES:
            hold, all_of_them = others.get(basis, (0, 0))
            cells.append(f"{hold} of {all_of_them}" if all_of_them else "")
        rows.append([f'<a href="#{section}">{text(title)}</a>', *cells, str(checks)])
    return table(["statements", *(badge(name) for name in PUBLISHED), *COUNTED_BASES.values(), "checks"], rows, "counts")


def exceptions_table(results):
    """Published statements that do not hold, paper by paper, worst first."""
    chosen = [statement for statement in results.statements
              if statement.is_published and statement.verdict in ("claim not met", "not reproduced", "corrected", "cannot be told")]
    order = [paper.key for paper in PAPERS]
    chosen.sort(key=lambda statement: (order.index(statement.source["paper"]) if statement.source["paper"] in order
                                       else len(order), SEVERITY.index(statement.verdict)))
    rows = []
    for statement in chosen:
        worst = min(statement.claims, key=lambda claim: SEVERITY.index(verdict(claim)))
        why = text(worst["remark"] or worst["reason"])
        rows.append([badge(statement.verdict), text(statement.first["statement"])
                     + tag("div", f"{statement.source['paper']} {text(statement.source['place'])}", class_="place"), why])
    return table(["verdict", "statement", "why"], rows, "exceptions") if rows else tag("p", "Nothing.")


def report_html(results, folder):
    """The page. Appends what is not there to results.missing."""
    presets = sorted({entry["parameters"].get("preset", "") for entry in results.tables.values()})
    placed = place(results)
    claims = [claim for statement in results.statements for claim in statement.claims]
    body = [paper_section(paper, placed, results, folder) for paper in PAPERS]
    body.append(beyond_section(placed, results, folder))
    body.append(tag("h2", "Where the numbers come from", id="provenance") + provenance_table(results.tables))
    contents = "".join(tag("li", f'<a href="#{key}">{text(title)}</a>') for key, title in
                       [("holds", "What holds"), ("exceptions", "What is not reproduced, or corrected")]
                       + [(paper.key, f"{paper.name} ({paper.key})") for paper in PAPERS]
                       + [("beyond", "Beyond the papers"), ("provenance", "Where the numbers come from")])
    met = sum(claim["met"] for claim in claims)
    untold = sum(claim["outcome"] == "cannot be told" for claim in claims)
    lead = (f"{met} of {len(claims)} checks met, {untold} cannot be told, of {len(results.statements)} statements, in {len(results.tables)} tables"
            f" of preset {' and '.join(presets)}."
            + (f" {results.elsewhere} more are checked at the other preset." if results.elsewhere else ""))
    missing = "".join(tag("li", html.escape(entry)) for entry in results.missing)
    head = [tag("h1", "Evolving surface finite elements: claims of four papers and their verdicts"),
            tag("p", f"esfem, {_date(results)}. {lead}", class_="lead"),
            tag("div", f"Not there: <ul>{missing}</ul>", class_="missing") if missing else "",
            tag("nav", tag("ol", contents)),
            tag("h3", "What holds", id="holds"), counts_table(placed),
            tag("p", "A statement is a sentence, a figure or a theorem of a paper that a computation can test; it may need "
                "several checks. <i>Reproduced, but</i>: with a restriction that the remark names, or in some settings only. "
                "<i>Cannot be told</i>: the interval of the order contains both what is stated and its opposite, or there is none. "
                "<i>Corrected</i>: wrong as printed, and the remark gives the correct version. Independent values come from other implementations; "
                "findings are this project’s own. Orders are fitted to all runs at once; brackets are 95% intervals, by the jackknife over meshes and step sizes.",
                class_="note"),
            tag("h2", "What is not reproduced, or corrected", id="exceptions"), exceptions_table(results)]
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "report.css"), encoding="utf-8") as file:
        style = file.read()
    return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
            '<meta name="viewport" content="width=device-width, initial-scale=1">'
            f"<title>esfem: reproduction report</title><style>{style}</style></head><body>" + "\n".join(head + body)
            + "</body></html>\n")


def _date(results):
    """Of the newest table: the report of old results must not look new."""
    dates = [entry.get("provenance", {}).get("date", "") for entry in results.tables.values()]
    return number(max(dates, default="")[:10] or datetime.date.today().isoformat())


def write(path, data):
    """Whole or not at all."""
    unfinished = f"{path}.{os.getpid()}.tmp"
    with open(unfinished, "wb") as file:
        file.write(data)
    os.replace(unfinished, path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("verdicts", help="e.g. report/verdicts.json")
    parser.add_argument("figures", help="e.g. figures")
    parser.add_argument("output", help="e.g. report")
    parser.add_argument("--reference", default="reference", help="folder of the claims (default: reference)")
    parser.add_argument("--expect", choices=("tables", "everything"),
                        help="exit 1 when there is no table of an experiment, or anything is missing; the report is written")
    parser.add_argument("--without-pdf", action="store_true", help="index.html only")
    arguments = parser.parse_args()
    try:
        results = read_results(arguments.verdicts, arguments.reference)
        page = report_html(results, arguments.figures)
        os.makedirs(arguments.output, exist_ok=True)
        write(os.path.join(arguments.output, "index.html"), page.encode())
        for name, data in exports(results).items():
            write(os.path.join(arguments.output, name), data.encode())
        if not arguments.without_pdf:
            import weasyprint  # slow to load
            write(os.path.join(arguments.output, "report.pdf"), weasyprint.HTML(string=page).write_pdf())
    except TableError as error:
        sys.exit(f"{parser.prog}: {error}")
    except (ImportError, OSError) as error:
        sys.exit(f"{parser.prog}: {error}")
    figures = page.count("<figure")
    print(f"report: {figures} figures, {sum(len(s.claims) for s in results.statements)} claims: {arguments.output}/index.html")
    for entry in results.missing:
        print(f"report: missing: {entry}")
    expected = {"everything": results.missing, "tables": [entry for entry in results.missing if entry.startswith("results")]}
    if expected.get(arguments.expect):
        sys.exit(f"{parser.prog}: {len(expected[arguments.expect])} missing, see above")


if __name__ == "__main__":
    main()
