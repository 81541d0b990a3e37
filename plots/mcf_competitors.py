# SPDX-License-Identifier: GPL-3.0-or-later
"""Mean curvature flow by three schemes, error against time: kll19 (5.1), Dziuk (3.6), and Barrett, Garcke, Nürnberg.

Usage: python3 plots/mcf_competitors.py results/paper/mcf_competitors.json figures
Writes figures/gallery/mcf_competitors.{pdf,png}: for each surface the errors of the nodes' positions and the distances
of the nodes from the exact surface over the seconds that the steps take. Every mark is a run; a line joins those runs
of a scheme that no other run of it beats in both.
"""
import math

import style
import time_series
from convergence import NORMS, failure_notes
from script import run
from table import TableError, label_of, succeeded

NORM = "nodal_L2"
SURFACES = {"sphere": "sphere", "angenent_torus": "self-shrinking torus"}
FLOWS = {"mean_curvature": ("(5.1)", style.BLUE), "dziuk": ("Dziuk", style.VERMILLION), "bgn": ("BGN", style.PURPLE)}
# One look for each BDF method, and one for linear elements.
LOOKS = {(2, 3): ("-", "o"), (2, 2): (style.DASHES["dashed"], "s"), (2, 1): (style.DASHES["dotted"], "^"),
         (1, 1): (style.DASHES["dash-dot"], "v")}
SECONDS = "seconds_of_steps"


def draw(table, norm):
    """Yields (name, figure). TableError when there is nothing to show."""
    rows = [row for row in table["rows"]
            if label_of(row, "flow") in FLOWS and label_of(row, "surface") in SURFACES]
    points = {surface: {} for surface in SURFACES}
    for row in filter(succeeded, rows):
        point = _point(row, norm)
        if point and _variant(row)[1:] in LOOKS:
            points[label_of(row, "surface")].setdefault(_variant(row), []).append(point)
    surfaces = [surface for surface in SURFACES if points[surface]]
    if not surfaces:
        raise TableError(f"no {SECONDS} with errors of x in the norm {norm} of {', '.join(SURFACES)}")
    notes = failure_notes(rows, {}, lambda row: _label(_variant(row)))
    yield "gallery/mcf_competitors", _figure(surfaces, points, norm, notes)


def _variant(row):
    return tuple(label_of(row, name) for name in ("flow", "degree", "bdf"))


def _point(row, norm):
    """(seconds, error of x, distance), or None where one is missing."""
    values = row.get("values") or {}
    point = values.get(SECONDS), row["errors"].get("x", {}).get(norm), values.get("distance")
    return point if all(isinstance(value, (int, float)) and 0 < value < math.inf for value in point) else None


def _order(variant):
    return list(FLOWS).index(variant[0]), list(LOOKS).index(variant[1:])


def _look(variant):
    dash, marker = LOOKS[variant[1:]]
    return {"color": FLOWS[variant[0]][1], "linestyle": dash, "marker": marker, "markersize": 3.6,
            "markerfacecolor": "white", "markeredgewidth": 0.8, "linewidth": 0.9}


def _label(variant):
    flow, degree, bdf = variant
    return f"{FLOWS[flow][0]}, $P_{degree}$, BDF{bdf}"


def frontier(points):
    """Those of the (seconds, error) that no other one beats in both, by seconds."""
    best, chosen = math.inf, []
    for seconds, error in sorted(points):
        if error < best:
            best = error
            chosen.append((seconds, error))
    return chosen


def _figure(surfaces, points, norm, notes):
    variants = sorted({variant for surface in surfaces for variant in points[surface]}, key=_order)
    headings = [[f"{SURFACES[surface]}: {what}" for surface in surfaces]
                for what in ("positions of the nodes", "distance from the surface")]
    figure, grid = time_series.panels(headings, {_label(variant): _look(variant) for variant in variants}, notes)
    labels = [f"error of $x$ in {NORMS[norm]}", "distance, r.m.s. of the nodes"]
    for column, label, axes_row in zip((1, 2), labels, grid):
        for surface, axes in zip(surfaces, axes_row):
            for variant in variants:
                pairs = [(point[0], point[column]) for point in points[surface].get(variant, [])]
                if pairs:
                    axes.plot(*zip(*pairs), **{**_look(variant), "linestyle": "none"})
                    axes.plot(*zip(*frontier(pairs)), **{**_look(variant), "marker": "none"})
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.set_xlabel("seconds of the steps", labelpad=1)
        axes_row[0].set_ylabel(label, labelpad=2)
    return figure


if __name__ == "__main__":
    run("mcf_competitors", draw, __doc__, NORM)
