# SPDX-License-Identifier: GPL-3.0-or-later
"""The reproduction report: one page with every figure, claim, verdict, table, and where they come from.

Usage: python3 plots/report.py VERDICTS FIGURES OUTPUT [--reference FOLDER] [--catches FILE] [--expect tables|everything]
       [--without-pdf]
Reads VERDICTS (check_orders --output), the tables that it names, and the PNGs of FIGURES; writes OUTPUT/index.html, which
needs no other file, OUTPUT/report.pdf, and all claims and orders as OUTPUT/{claims,orders}.{csv,tex}.
"""
import argparse
import datetime
import html
import os
import sys

from report_claims import Links, claims_table
from report_content import BEYOND, PAPERS
from report_data import BEYOND_STEMS, OWN, of_section, own_counts, place, read_json, read_results
from report_export import exports
from report_html import link, number, picture, tag, text
from report_summary import counts_table, paper_summary, source
from report_tables import fits_table, provenance_table, runs_table
from table import TableError


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


def see_also(figure_number, placed, section):
    """Statements that name this figure, but stand beside another one."""
    ids = [link(f"{statement.stem}.{statement.first['id']}", tag("code", html.escape(statement.first["id"])))
           for (where, key), statements in placed.items() if where == section and key != figure_number
           for statement in statements if figure_number in statement.figures]
    return tag("p", "See also " + ", ".join(ids) + ".", class_="note") if ids else ""


def own_runs(title, statements, links):
    """What this project's own runs show, closed: no paper states it."""
    if not statements:
        return ""
    inside = tag("summary", f"{title}: {sum(len(s.claims) for s in statements)} checks") + claims_table(statements, links)
    return tag("details", inside, class_="own")


def split(statements):
    """(of a paper or independent, of this project's own runs)."""
    return ([s for s in statements if s.source["basis"] not in OWN], [s for s in statements if s.source["basis"] in OWN])


def paper_section(paper, placed, results, folder, links):
    """Its figures, each with its claims; theorems and text; independent values; what own runs show; the tables."""
    parts = [tag("h2", f"{text(paper.name)}: all claims", id=f"{paper.key}-claims"), tag("p", source(paper), class_="source")]
    own = []
    for figure_number in dict.fromkeys(figure.number for figure in paper.figures):
        first, *others = [figure_html(figure, folder, results.missing) for figure in paper.figures
                          if figure.number == figure_number]
        parts += [tag("section", tag("h3", f"Figure {figure_number}", id=f"{paper.key}-{figure_number}") + first), *others]
        theirs, ours = split(placed.get((paper.key, figure_number), []))
        parts += [claims_table(theirs, links), see_also(figure_number, placed, paper.key)]
        own += ours
    theirs, ours = split(placed.get((paper.key, ""), []))
    parts += [tag("h3", "Theorems and text") + claims_table(theirs, links)] if theirs else []
    own += ours
    stems = [figure.stem for figure in paper.figures]
    stems += [stem for stem, entry in results.tables.items() if entry["paper"] == paper.key]
    stems = [stem for stem in dict.fromkeys(stems) if stem not in BEYOND_STEMS]
    theirs, ours = split([statement for stem in stems for statement in placed.get((paper.key, stem), [])])
    parts += [tag("h3", "Independent values") + claims_table(theirs, links)] if theirs else []
    parts.append(own_runs("Own runs", own + ours, links))
    return "".join(parts) + tables_html(stems, results)


def beyond_section(placed, results, folder, links):
    parts = [tag("h2", "Beyond the papers", id="beyond")]
    for i, figure in enumerate(BEYOND):
        parts.append(tag("section", tag("h3", text(figure.caption)) + figure_html(figure, folder, results.missing)))
        if all(figure.stem != later.stem for later in BEYOND[i + 1:]):
            theirs, ours = split(placed.get(("beyond", figure.stem), []))
            parts += [claims_table(theirs, links), own_runs("Own runs", ours, links)]
    return "".join(parts) + tables_html(dict.fromkeys(figure.stem for figure in BEYOND), results)


NOTE = ("A statement is a sentence, a figure or a theorem that a computation can test; it may need several checks. "
        "<i>Reproduced, but</i>: with a restriction that the remark names, or in some settings only. "
        "<i>Cannot be told</i>: the interval of the order contains both what is stated and its opposite, or there is none. "
        "<i>Corrected</i>: wrong as printed; the remark gives the correct version. Independent values come from other implementations. "
        "Orders are fitted to all runs at once; brackets are 95% intervals, by the jackknife over meshes and step sizes.")


def report_html(results, folder, catches=None):
    """The page. Appends what is not there to results.missing."""
    presets = sorted({entry["parameters"].get("preset", "") for entry in results.tables.values()})
    placed, links = place(results), Links(results, catches)
    summaries = [paper_summary(paper, placed, links) for paper in PAPERS]
    body = [paper_section(paper, placed, results, folder, links) for paper in PAPERS]
    body.append(beyond_section(placed, results, folder, links))
    body.append(tag("h2", "Where the numbers come from", id="provenance") + provenance_table(results.tables))
    contents = "".join(tag("li", link(key, text(title))) for key, title in
                       [(paper.key, f"{paper.name} ({paper.key})") for paper in PAPERS]
                       + [(f"{paper.key}-claims", f"{paper.name}: all claims") for paper in PAPERS]
                       + [("beyond", "Beyond the papers"), ("provenance", "Where the numbers come from")])
    published = [s for paper in PAPERS for s in of_section(placed, paper.key) if s.source["basis"] == "statement"]
    hold = sum(s.verdict in ("reproduced", "reproduced, but") for s in published)
    own, of_own = own_counts(results)
    lead = (f"{hold} of {len(published)} statements of the papers are reproduced, {sum(s.verdict == 'reproduced' for s in published)} of "
            f"these without a restriction, in {len(results.tables)} tables of preset {' and '.join(presets)}.")
    beside = (f"Not counted with them: {own} of {of_own} checks of what this project’s own runs show are met."
              + (f" {results.elsewhere} more checks belong to the other preset." if results.elsewhere else ""))
    missing = "".join(tag("li", html.escape(entry)) for entry in results.missing)
    head = [tag("h1", "Evolving surface finite elements: claims of four papers and their verdicts"),
            tag("p", f"esfem, {_date(results)}. {lead}", class_="lead"),
            tag("div", f"Not there: <ul>{missing}</ul>", class_="missing") if missing else "",
            tag("h3", "What holds", id="holds"), counts_table(placed), tag("p", beside + " " + NOTE, class_="note"),
            tag("nav", tag("ol", contents))]
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "report.css"), encoding="utf-8") as file:
        style = file.read()
    return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
            '<meta name="viewport" content="width=device-width, initial-scale=1">'
            f"<title>esfem: reproduction report</title><style>{style}</style></head><body>" + "\n".join(head + summaries + body)
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
    parser.add_argument("--catches", default="report/catches.json",
                        help='{STEM: {CLAIM: ["broken variant", ..]}}, shown beside the claims where the file is there (default: %(default)s)')
    parser.add_argument("--expect", choices=("tables", "everything"),
                        help="exit 1 when there is no table of an experiment, or anything is missing; the report is written")
    parser.add_argument("--without-pdf", action="store_true", help="index.html only")
    arguments = parser.parse_args()
    try:
        results = read_results(arguments.verdicts, arguments.reference)
        catches = read_json(arguments.catches) if os.path.exists(arguments.catches) else {}
        page = report_html(results, arguments.figures, catches)
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
