# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 7.1-7.3 of Kovács, Li, Lubich (2021): Willmore flow of a sphere, without and with projections.

Usage: python3 plots/willmore_sphere.py results/paper/willmore_sphere.json figures
Writes figures/kll21/fig7_1 .. fig7_3.{pdf,png}: errors and energy against the mesh width without and with projection of
nu and z after each step (7.1, 7.3), and what the projections do to the normal and to the sphere over time (7.2).
"""
import textwrap

import numpy as np

import style
import time_series
from script import run
from table import TableError, has_series, label_of, series
from willmore import SPHERE, errors_and_energy

NORM = "nodal_H1"  # what the authors plot
PAPER = {"flow": "willmore", "theta": "no"}
# Black without, grey with projections, circles for the minimum and stars for the maximum, as in the paper.
PROJECTIONS = {"none": ("without projections", {"color": "black", "zorder": 2.2}),
               "projected": ("with projections", {"color": "0.6", "linewidth": 1.3})}
MARKERS = {"min": {"marker": "o", "markersize": 4}, "max": {"marker": "*", "markersize": 5.5}}
APART = {("none", "min"): 0, ("projected", "min"): 1, ("none", "max"): 2, ("projected", "max"): 3}  # marks of lines that coincide
PAIRS = {"nu": r"$\min\,|\nu_h|$ and $\max\,|\nu_h|$", "radius": "min and max distance from 0"}


def draw(table, norm):
    """Yields (name, figure) for what the table has. TableError when it has none of these runs."""
    rows = [row for row in table["rows"] if all(label_of(row, key, value) == value for key, value in PAPER.items())]
    degree, nothing = table.get("parameters", {}).get("degree", 2), True
    for name, projection in (("kll21/fig7_1", "none"), ("kll21/fig7_3", "projected")):
        chosen = [row for row in rows if label_of(row, "run") == "convergence" and label_of(row, "projection") == projection]
        if chosen:
            nothing = False
            yield name, errors_and_energy(chosen, norm, degree, SPHERE)
    normals = [row for row in rows if label_of(row, "run") == "normals" and label_of(row, "projection") in PROJECTIONS]
    if normals:
        nothing = False
        yield "kll21/fig7_2", projections_figure(normals)
    if nothing:
        raise TableError('no rows with run "convergence" or "normals"')


def projections_figure(rows):
    """Figure 7.2: length of the normal, distance from the origin, and Willmore energy over time."""
    shown = [row for row in rows if has_series(row)]
    if not shown:
        return style.notice([f"None of {len(rows)} runs finished. The first: {rows[0]['status']}."])
    legend = {label: line for key, (label, line) in PROJECTIONS.items()
              if any(label_of(row, "projection") == key for row in shown)}
    legend |= {f"{kind}imum": {"color": "black", "linestyle": "none", "markerfacecolor": "white", **marker}
               for kind, marker in MARKERS.items()}
    notes = time_series.failure_notes(rows, lambda row: PROJECTIONS[label_of(row, "projection")][0])
    notes = [textwrap.shorten(f"{PROJECTIONS[label_of(row, 'projection')][0].capitalize()}: {row['status']}", 140)
             for row in shown if row["status"] != "ok"] + notes
    headings = [*PAIRS.values(), "Willmore energy"]
    setting = rf"{style.nodes_label(shown[0]['nodes'])}, $\tau = {shown[0]['tau']:.3g}$"
    figure, (panels,) = time_series.panels([headings], legend, [f"Sphere of radius 1, {setting}.", *notes])
    end = max(row["tau"] * row["steps"] for row in shown)
    for axes, quantity in zip(panels, (*PAIRS, None)):
        axes.set_xlim(-0.06 * end, 1.06 * end)
        if quantity:
            values = [_draw(axes, row, f"{kind}_{quantity}", end, {**marker, "markevery": _marks(row, kind)})
                      for row in shown for kind, marker in MARKERS.items()]
            values = np.concatenate(values)
            time_series.scale(axes, values, logarithmic=max(values, default=1) > 10)
        else:
            values = np.concatenate([_draw(axes, row, "willmore_energy", end, {}) for row in shown])
            time_series.scale(axes, np.append(values, SPHERE[0]), logarithmic=max(values, default=1) > 10 * SPHERE[0])
            style.limit_line(axes, *SPHERE, zorder=3)
    return figure


def _marks(row, kind):
    every = max(round(len(row["series"]["t"]) / 10), 4)
    return APART[label_of(row, "projection"), kind] * every // 4, every


def _draw(axes, row, name, end, marker):
    line = {**PROJECTIONS[label_of(row, "projection")][1], "markerfacecolor": "white", **marker}
    return time_series.draw_series(axes, row, name, line, (0, 1.001 * end))


if __name__ == "__main__":
    run("willmore_sphere", draw, __doc__, NORM)
