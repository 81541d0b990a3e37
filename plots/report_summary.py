# SPDX-License-Identifier: GPL-3.0-or-later
"""The front of the report: what holds, and for each paper its figures with a sentence and a verdict, and what differs."""
import html

from report_claims import anchor, badge
from report_content import PAPERS
from report_data import COUNTED_BASES, counts, differences, figure_verdict, of_section
from report_html import link, table, tag, text

PUBLISHED = ("reproduced", "reproduced, but", "cannot be told", "corrected", "not reproduced", "claim not met")
DOI = "https://doi.org/"
SHOWN = 4  # statements that one entry lists by name
UNTOLD = "the interval of the order contains the bound, or the order has no interval"


def source(paper):
    """Authors, title and journal, with the DOI."""
    where = f"{text(paper.authors)}: {text(paper.title)}. {text(paper.journal)}"
    return where + (f", {link(DOI + paper.doi, 'doi:' + text(paper.doi))}" if paper.doi else "") + "."


def counts_table(placed):
    """Statements by verdict, a row for each paper. The numbers lead to what they count."""
    titles = {paper.key: f"{paper.name} ({paper.key})" for paper in PAPERS} | {"beyond": "Beyond the papers: a benchmark, and theory"}
    found = {section: counts(of_section(placed, section)) for section in titles}
    columns = [name for name in PUBLISHED if name != "claim not met" or any(published[name] for published, _ in found.values())]
    rows = []
    for section, title in titles.items():
        published, others = found[section]
        to = {"reproduced": f"{section}-claims"} if section != "beyond" else {}
        where = "beyond" if section == "beyond" else f"{section}-differences"
        cells = [link(to.get(name, where), str(published[name])) if published[name] else "" for name in columns]
        cells += [others.get(basis, "") for basis in COUNTED_BASES]
        rows.append([link(section, text(title)), *cells])
    return table(["statements of", *(badge(name) for name in columns), *COUNTED_BASES.values()], rows, "counts")


def figures_table(paper, placed):
    """Each published figure: what it shows, what the runs say, and the verdict on what the paper states of it."""
    rows, seen = [], set()
    for figure in paper.figures:
        if figure.number in seen:
            continue
        seen.add(figure.number)
        name, tally = figure_verdict(placed.get((paper.key, figure.number), []))
        said = tag("div", tally, class_="place") if tally else ""
        rows.append([link(f"{paper.key}-{figure.number}", figure.number), text(figure.caption) + " " + text(figure.found),
                     (badge(name) if name else "no statement") + said])
    return table(["figure", "what it shows, and what the runs say", "verdict"], rows, "figures stacked")


def differences_table(statements, links):
    """What the papers state and does not simply hold, most important first; each entry leads to its claims."""
    rows = []
    for name, why, group in differences(statements):
        shown = [link(anchor(s.stem, s.worst["id"]), text(s.first["statement"]))
                 + tag("div", text(s.source["place"]), class_="place") for s in group[:SHOWN]]
        words = "".join(tag("div", entry) for entry in shown)
        if len(group) > SHOWN:
            more = ", ".join(link(anchor(s.stem, s.worst["id"]), tag("code", html.escape(s.worst["id"]))) for s in group[SHOWN:])
            count = f"and {len(group) - SHOWN} more"
            words += tag("details", tag("summary", count) + more, class_="place screen") + tag("div", count, class_="place print")
        rows.append([badge(name), words, links.remark(group[0].stem, why) or text(UNTOLD if len(group) > 1 else group[0].worst["reason"])])
    return table(["verdict", "statement", "why"], rows, "exceptions stacked") if rows else tag("p", "Nothing.")


def paper_summary(paper, placed, links):
    """The page of a paper that a reader with five minutes reads."""
    return "".join([
        tag("h2", f"{text(paper.name)} ({paper.key})", id=paper.key), tag("p", f"{source(paper)} {text(paper.about)}", class_="source"),
        figures_table(paper, placed), tag("h3", "What differs", id=f"{paper.key}-differences"),
        differences_table(of_section(placed, paper.key), links),
        tag("p", link(f"{paper.key}-claims", "All figures, claims and tables of this paper"), class_="note screen")])
