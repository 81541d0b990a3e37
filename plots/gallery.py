# SPDX-License-Identifier: GPL-3.0-or-later
"""What is kept with the sources: small pictures in docs/, and in README.md the headline table and that of evolve's flows.

Usage: python3 plots/gallery.py VERDICTS SCHEMA FIGURES README DOCS
Copies figures that the README shows, made small, and writes two tables of the README anew, each between its marks: the
headline from VERDICTS (check_orders --output), the flows from SCHEMA (evolve --schema).
"""
import json
import os
import re
import sys

from report_content import PAPERS
from report_data import COUNTED_BASES, counts, place, read_results
from report_html import small_png
from table import TableError

PICTURES = ("kll19/fig13_1", "kll19/fig13_3", "kll21/fig7_5", "gallery/willmore_relaxation", "gallery/willmore_projection",
            "gallery/willmore_projection_length", "bk22/fig6", "gallery/all_orders",
            "gallery/mcf_angenent_torus", "gallery/mcf_competitors", "gallery/tumour_growth", "pfhub/fig1d")
WIDTH = 1000  # pixels
COLUMNS = ("reproduced", "reproduced, but", "cannot be told", "corrected", "not reproduced", "claim not met")


def headline(results):
    """Statements of each paper by verdict, as a table in Markdown. A column that is empty is left out."""
    placed = place(results)
    rows = []
    for key, name in [(paper.key, f"{paper.name} ({paper.key})") for paper in PAPERS] + [("beyond", "beyond the papers")]:
        statements = [statement for (section, _), group in placed.items() if section == key for statement in group]
        published, others = counts(statements)
        pairs = [others.get(basis, (0, 0)) for basis in COUNTED_BASES]
        rows.append([name, *(str(published[column] or "–") for column in COLUMNS),
                     *(f"{hold} of {number}" if number else "–" for hold, number in pairs)])
    heads = ["statements of", *COLUMNS, *COUNTED_BASES.values()]
    kept = [i for i in range(len(heads)) if heads[i] not in ("cannot be told", "claim not met") or any(row[i] != "–" for row in rows)]
    lines = [[line[i] for i in kept] for line in [heads, ["---"] * len(heads), *rows]]
    return markdown(lines)


def flows(schema):
    """The flows of evolve and their problems with a line of help each, as a table in Markdown."""
    lines = [["flow", "problem", ""], ["---"] * 3]
    for rule in schema["allOf"]:
        names = {key: value["const"] for key, value in rule["if"]["properties"].items()}
        lines.append([f"`{names['flow']}`", f"`{names['problem']}`" if "problem" in names else "", rule["then"]["description"]])
    return markdown(lines)


def markdown(lines):
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def with_table(readme, name, table):
    """The README's text with the table between its marks. Raises TableError when these are not there, once each."""
    marks = (f"<!-- {name}: written by make gallery -->", f"<!-- end of {name} -->")
    if any(readme.count(mark) != 1 for mark in marks):
        raise TableError(f"README: expected once each: {' and '.join(marks)}")
    return re.sub(f"{marks[0]}.*{marks[1]}", lambda _: f"{marks[0]}\n{table}\n{marks[1]}", readme, flags=re.DOTALL)


def main():
    if len(sys.argv) != 6:
        sys.exit(__doc__.strip())
    verdicts, schema, figures, readme, docs = sys.argv[1:]
    try:
        with open(readme, encoding="utf-8") as file:
            text = with_table(file.read(), "headline", headline(read_results(verdicts, "reference")))
        with open(schema, encoding="utf-8") as file:
            text = with_table(text, "flows", flows(json.load(file)))
        for name in PICTURES:
            with open(os.path.join(docs, os.path.basename(name) + ".png"), "wb") as file:
                file.write(small_png(os.path.join(figures, name + ".png"), WIDTH))
        with open(readme, "w", encoding="utf-8") as file:
            file.write(text)
    except (TableError, OSError) as error:
        sys.exit(f"{os.path.basename(sys.argv[0])}: {error}")


if __name__ == "__main__":
    main()
