# SPDX-License-Identifier: GPL-3.0-or-later
"""Willmore flow with and without projections of the normal: orders in time, errors on the sphere, and the length of nu_h.

Usage: python3 plots/willmore_projection.py results/paper/willmore_projection.json figures
Writes figures/gallery/willmore_projection.{pdf,png}: errors of u = (H, nu) of the ellipsoid over the step size for each BDF
method, and of x on the sphere; and figures/gallery/willmore_projection_length.{pdf,png}: how |nu_h| - 1 grows or decays on
spheres, compared with exp(8t/R⁴) and exp(-4t/R⁴). Each is left out where the table has none of its runs.
"""
import numpy as np

import style
import time_series
from convergence import NORMS, Panel, curves_of, draw_panels, failure_notes
from script import run
from table import TableError, has_series, label_of, succeeded

PROJECTIONS = {"none": "no projections", "projected": "after each step (paper)", "coefficients": "in the coefficients"}
RATES = {"none": (8, r"$e^{8t/R^4}$"), "coefficients": (-4, r"$e^{-4t/R^4}$")}


def draw(table, _norm):
    """Yields (name, figure) for what the table has. TableError when there is nothing."""
    plain = [row for row in table["rows"] if _is_plain(row)]
    errors = [row for row in plain if label_of(row, "run") in ("order", "sphere")]
    lengths = [row for row in plain if label_of(row, "run") == "length" and has_series(row)]
    if not errors and not lengths:
        raise TableError('no rows with run "order", "sphere" or "length"')
    if errors:
        yield "gallery/willmore_projection", _errors_figure(errors)
    if lengths:
        yield "gallery/willmore_projection_length", _length_figure(lengths)


def _is_plain(row):
    """Whether it is Willmore flow with extrapolated F and quadratic elements on the structured mesh."""
    usual = {"flow": "willmore", "F": "extrapolated", "mesh_of": "icosphere", "degree": 2}
    return all(label_of(row, name, value) == value for name, value in usual.items())


def _line(row):
    """What makes a line: its projection."""
    name = label_of(row, "projection")
    return -list(PROJECTIONS).index(name), PROJECTIONS[name]


def _errors_figure(rows):
    panels, skipped = [], {}
    for bdf in sorted({label_of(row, "bdf") for row in rows if label_of(row, "run") == "order"}):
        of_method = [row for row in rows if label_of(row, "run") == "order" and label_of(row, "bdf") == bdf]
        lines, skipped[f"BDF{bdf}"] = curves_of(of_method, lambda row: row["errors"].get("u", {}).get("nodal_L2"), "tau", _line)
        panels.append(Panel(rf"ellipsoid, $(H, \nu)$, BDF{bdf}", lines, "tau", bdf))
    sphere = [row for row in rows if label_of(row, "run") == "sphere"]
    finished = [row for row in rows if succeeded(row) or row not in sphere]
    if sphere:
        lines, skipped["sphere"] = curves_of(sphere, lambda row: row["errors"].get("x", {}).get("nodal_H1"), "tau", _line)
        panels.append(Panel(r"sphere, $x$ in $L^\infty(H^1)$, BDF2", lines, "tau"))
    return draw_panels(panels, f"error in {NORMS['nodal_L2']}", [*_singular_notes(sphere), *failure_notes(finished, skipped)], columns=3)


def _singular_notes(rows):
    """Which runs on the sphere ended early, by projection and step size."""
    notes = []
    for name, words in PROJECTIONS.items():
        steps = sorted((row["tau"] for row in rows if label_of(row, "projection") == name and not succeeded(row)), reverse=True)
        if steps:
            notes += style.wrap(f"Sphere, {words}: singular before the end, because of $|\\nu_h|$, with $\\tau$ = "
                                f"{', '.join(f'{tau:.3g}' for tau in steps)}.")
    return notes


def _length_figure(rows):
    """|nu_h| - 1 over t/R⁴, relative to its first value, with the rates of the equation for a sphere."""
    labels = [rf"{PROJECTIONS[label_of(row, 'projection')]}, $R = {label_of(row, 'radius'):g}$" for row in rows]
    lines = style.line_styles(len(rows))
    exact = {label: {"color": "black", "linestyle": dash, "linewidth": 0.9}
             for (_, label), dash in zip(RATES.values(), ("--", ":"))}
    figure, ((axes,),) = time_series.panels([[r"$(|\nu_h| - 1)$ relative to its first value, mean of the nodes"]],
                                            dict(zip(labels, lines)) | exact, time_series.failure_notes(rows), abreast=3)
    values = []
    for i, (row, line) in enumerate(zip(rows, lines)):
        scaled = np.array(row["series"]["t"]) / label_of(row, "radius") ** 4
        excess = np.array(row["series"]["nu_excess"])
        values.append(time_series.positive(excess / excess[0]))
        axes.plot(scaled, values[-1], **line, markevery=(i, max(len(scaled) // 8, 1)))
    t = np.array([0, 0.5])
    for (rate, label) in RATES.values():
        axes.plot(t, np.exp(rate * t), **exact[label])
    axes.set_xlabel("$t/R^4$", labelpad=1)
    time_series.scale(axes, np.concatenate(values), logarithmic=True)
    return figure


if __name__ == "__main__":
    run("willmore_projection", draw, __doc__)
