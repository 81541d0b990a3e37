# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 13.1 and 13.2 of Kovács, Li, Lubich (2019): mean curvature flow of a sphere, errors against tau and h.

Usage: python3 plots/mcf_sphere.py results/paper/mcf_sphere.json figures
Writes figures/kll19/fig13_1.{pdf,png} and fig13_2.{pdf,png}. The paper shows x, nu and H; v is added. The figures are of
(5.1) with the BDF method and the start of most runs; Dziuk's scheme is drawn only from a table that has nothing else.
"""
from convergence import convergence_figure
from script import run
from table import label_of

QUANTITIES = ("x", "v", "nu", "H")
NORM = "nodal_H1"  # what the authors plot


def draw(table, norm):
    """The theory's orders are those of the degree and of the BDF method; the sphere shows one or two more in space."""
    degree = table.get("parameters", {}).get("degree", 2)
    rows = drawn_rows(table["rows"])
    bdf = label_of(rows[0], "bdf", 3) if rows else 3
    yield "kll19/fig13_1", convergence_figure(rows, QUANTITIES, norm, "tau", order=bdf)
    yield "kll19/fig13_2", convergence_figure(rows, QUANTITIES, norm, "h", order=degree,
                                              faster=(degree + 1, degree + 2))


def drawn_rows(rows):
    """The runs "convergence" of (5.1), or else of Dziuk's scheme, with the BDF method and the start of most of them."""
    found = [row for row in rows if label_of(row, "run", "convergence") == "convergence"]
    found = [row for row in found if label_of(row, "flow", "mean_curvature") == "mean_curvature"] or found
    variants = {}
    for row in found:
        variants.setdefault((label_of(row, "bdf"), label_of(row, "start")), []).append(row)
    return max(variants.values(), key=len, default=[])


if __name__ == "__main__":
    run("mcf_sphere", draw, __doc__, NORM)
