# SPDX-License-Identifier: GPL-3.0-or-later
"""What is kept with the sources: small pictures in docs/, and tables in README.md and docs/flows.md, between marks.

Usage: python3 plots/gallery.py VERDICTS SCHEMA FIGURES README DOCS
Copies figures, made small, and writes anew: in README the headline, from VERDICTS (check_orders --output), the table of figures,
from the tables that VERDICTS names, and the lines of a program, from tests/consumer/shrink.cpp; in DOCS/flows.md the flows, from
SCHEMA (evolve --schema). FIGURES may be "none": no pictures.
"""
import json
import os
import re
import sys

from report_content import PAPERS
from report_data import COUNTED_BASES, PAPER_KEYS, counts, of_section, place, read_results
from report_html import small_png
from table import TableError

PICTURES = ("kll19/fig13_1", "kll19/fig13_3", "kll21/fig7_5", "gallery/willmore_relaxation", "gallery/willmore_projection",
            "gallery/willmore_projection_length", "bk22/fig6", "gallery/all_orders",
            "gallery/mcf_angenent_torus", "gallery/mcf_competitors", "gallery/tumour_growth", "pfhub/fig1d", "gallery/tangential_motion",
            "gallery/tangential_motion_willmore", "gallery/helfrich_vesicles", "gallery/helfrich_energies")
WIDTH = 1000  # pixels
# Verdicts of the headline, and their heads there: in words that need no explanation.
COLUMNS = {"reproduced": "reproduced", "reproduced, but": "reproduced, but with a restriction", "cannot be told": "cannot be told from the runs",
           "corrected": "misprint, corrected", "not reproduced": "not reproduced", "claim not met": "claim not met"}


def headline(results):
    """Statements of each paper by verdict, as a table in Markdown."""
    placed = place(results)
    rows = {}
    for key in (*PAPER_KEYS, "beyond"):
        published, others = counts(of_section(placed, key))
        rows[key] = [*(str(published[column] or "–") for column in COLUMNS), *(others.get(basis, "–") for basis in COUNTED_BASES)]
    return headline_table(rows)


def headline_table(rows):
    """Of {key of a paper, or "beyond": its numbers}. A column that may be empty, and is, is left out."""
    names = {paper.key: f"[{paper.key}](docs/findings/{paper.key}.md): {paper.name}. {paper.authors}, {paper.journal}"
             for paper in PAPERS} | {"beyond": "[beyond the papers](docs/findings/beyond.md)"}
    heads = ["statements of", *COLUMNS.values(), *COUNTED_BASES.values()]
    rows = [[names[key], *numbers] for key, numbers in rows.items()]
    may_be_empty = (COLUMNS["cannot be told"], COLUMNS["claim not met"])
    kept = [i for i in range(len(heads)) if heads[i] not in may_be_empty or any(row[i] != "–" for row in rows)]
    return markdown([[line[i] for i in kept] for line in [heads, ["---"] * len(heads), *rows]])


def figures_table(results):
    """Which executable draws which figures, from which claims, and the seconds of its runs together."""
    numbers = {}
    for paper in PAPERS:
        for figure in paper.figures:
            numbers.setdefault(figure.stem, {}).setdefault(paper.key, {})[figure.number] = None
    lines = [["figures", "executable", "time of all its runs"], ["---"] * 3]
    others = [stem for stem in results.tables if stem not in numbers]
    for stem, of_papers in numbers.items():
        if stem in results.tables:
            names = "; ".join(f"{key} {ranges(list(figures))}" for key, figures in of_papers.items())
            lines.append([names, f"`{stem}`", duration(seconds(results, [stem]))])
    lines.append(["[beyond the papers](docs/findings/beyond.md)", ", ".join(f"`{stem}`" for stem in others), duration(seconds(results, others))])
    return markdown(lines)


def seconds(results, stems):
    return sum(row.get("seconds", 0) for stem in stems for row in results.tables[stem]["rows"])


def duration(number):
    """Two figures at most: these are the times of one machine."""
    return f"{number:.2g} s" if number < 100 else f"{number / 60:.0f} min"


def ranges(numbers):
    """13.1, 13.2, 13.3 as 13.1–13.3; two numbers as 6, 7."""
    return ", ".join(numbers) if len(numbers) < 3 else f"{numbers[0]}–{numbers[-1]}"


def program(source, written):
    """The block of README with lines of a program. Raises TableError when one of them is not there, in this order."""
    lines = [line.strip() for line in source.splitlines()]
    for line in written:
        if line.strip() not in lines:
            raise TableError(f"tests/consumer/shrink.cpp has no line {line.strip()!r} behind those before")
        lines = lines[lines.index(line.strip()) + 1:]
    return "\n".join(["```cpp", *written, "```"])


PROGRAM = """const esfem::Mesh mesh = esfem::read_mesh(mesh_file).mesh;
const esfem::SurfaceSpace space(mesh);
esfem::MeanCurvatureFlow::State state = esfem::discrete_mean_curvature_state(space, mesh.nodes);
esfem::MeanCurvatureFlow flow(space, {});
esfem::UniformSteps steps;
steps.order = 3;
steps.tau = tau;
steps.steps = 20;
esfem::integrate(flow, steps, {state}, [&](int, const esfem::MeanCurvatureFlow::State& now) {
  std::printf("%-10.4g %-22.16g %.16g\\n", now.t, space.area(now.x), space.volume(now.x));
});""".splitlines()


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
    """A page's text with the table between its marks. Raises TableError when these are not there, once each."""
    marks = (f"<!-- {name}: written by make gallery -->", f"<!-- end of {name} -->")
    if any(readme.count(mark) != 1 for mark in marks):
        raise TableError(f"expected once each: {' and '.join(marks)}")
    return re.sub(f"{marks[0]}.*{marks[1]}", lambda _: f"{marks[0]}\n{table}\n{marks[1]}", readme, flags=re.DOTALL)


def main():
    if len(sys.argv) != 6:
        sys.exit(__doc__.strip())
    verdicts, schema, figures, readme, docs = sys.argv[1:]
    try:
        results = read_results(verdicts, "reference")
        with open("tests/consumer/shrink.cpp", encoding="utf-8") as file:
            lines = program(file.read(), PROGRAM)
        rewrite(readme, {"headline": headline(results), "figures": figures_table(results), "program": lines})
        with open(schema, encoding="utf-8") as file:
            rewrite(os.path.join(docs, "flows.md"), {"flows": flows(json.load(file))})
        for name in PICTURES if figures != "none" else ():
            with open(os.path.join(docs, os.path.basename(name) + ".png"), "wb") as file:
                file.write(small_png(os.path.join(figures, name + ".png"), WIDTH))
    except (TableError, OSError) as error:
        sys.exit(f"{os.path.basename(sys.argv[0])}: {error}")


def rewrite(path, tables):
    """Writes the tables between their marks. Raises TableError."""
    with open(path, encoding="utf-8") as file:
        page = file.read()
    try:
        for name, table in tables.items():
            page = with_table(page, name, table)
    except TableError as error:
        raise TableError(f"{path}: {error}") from error
    with open(path, "w", encoding="utf-8") as file:
        file.write(page)


if __name__ == "__main__":
    main()
