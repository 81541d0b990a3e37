# SPDX-License-Identifier: GPL-3.0-or-later
"""Quality of meshes in mean curvature flow and Willmore flow with and without tangential motion.

Usage: python3 plots/tangential_motion.py results/paper/tangential_motion.json figures
Writes figures/gallery/tangential_motion.{pdf,png}: mean curvature flow, the smallest angle and the worst radius ratio over
time; and figures/gallery/tangential_motion_willmore.{pdf,png}: the same and the energy in Willmore flow of a torus.
"""
import numpy as np

import style
import time_series
from script import run
from table import TableError, has_series, label_of, series
from willmore import TORUS, finest

SURFACES = {"dumbbell": "dumbbell", "red_blood_cell": "red blood cell", "ellipsoid": "ellipsoid (4, 1, 1)", "torus": "torus"}
# (flow, tangential motion): label and line. Thinner lines lie on top: lines that coincide all show.
SCHEMES = {("mean_curvature", "none"): ("(5.1)", {"color": style.BLUE, "linewidth": 1.6}),
           ("mean_curvature", "minimal_deformation"): ("(5.1), minimal deformation rate",
                                                       {"color": style.GREEN, "linewidth": 1.6}),
           ("dziuk", "none"): ("Dziuk", {"color": style.VERMILLION, "linewidth": 1.0,
                                         "linestyle": style.DASHES["dashed"]}),
           ("bgn", "none"): ("BGN", {"color": style.PURPLE, "linewidth": 1.0})}
ON_TORUS = {("willmore", "none"): ("(3.4)–(3.5)", {"color": style.BLUE, "linewidth": 1.2, "linestyle": style.DASHES["dashed"]}),
            ("willmore", "minimal_deformation"): ("minimal deformation rate", {"color": style.GREEN, "linewidth": 1.2,
                                                                               "linestyle": style.DASHES["dash-dot"]}),
            ("willmore_relaxed", "none"): ("relaxation", {"color": style.BLUE, "linewidth": 2.0}),
            ("willmore_relaxed", "minimal_deformation"): ("both", {"color": style.GREEN, "linewidth": 1.2})}
QUANTITIES = {"worst_angle": "smallest angle (degrees)", "worst_radius_ratio": "worst radius ratio"}


def draw(table, folder):
    """Yields (name, figure) for what the table has. TableError when there is nothing; `folder` is not needed."""
    figures = {"gallery/tangential_motion": (SCHEMES, _figure), "gallery/tangential_motion_willmore": (ON_TORUS, _torus_figure)}
    found = False
    for name, (schemes, figure_of) in figures.items():
        rows = [row for row in table["rows"] if label_of(row, "surface") in SURFACES and _scheme(row) in schemes]
        runs = {}
        for row in filter(has_series, rows):
            runs.setdefault((label_of(row, "surface"), _scheme(row)), []).append(row)
        runs = {key: finest(of_key) for key, of_key in runs.items() if any(series(row, name) for row in of_key
                                                                           for name in QUANTITIES)}
        if runs:
            found = True
            yield name, figure_of(runs, rows)
    if not found:
        raise TableError(f"no series {', '.join(QUANTITIES)} of {', '.join(SURFACES)}")


def _scheme(row):
    return label_of(row, "flow"), label_of(row, "tangential")


def _legend(schemes, runs):
    return {label: line for scheme, (label, line) in schemes.items() if any(of == scheme for _, of in runs)}


def _figure(runs, rows):
    surfaces = [surface for surface in SURFACES if any(of == surface for of, _ in runs)]
    headings = [[SURFACES[surface] for surface in surfaces], [""] * len(surfaces)]
    figure, grid = time_series.panels(headings, _legend(SCHEMES, runs), _notes(runs, rows, surfaces))
    for (name, label), axes_row in zip(QUANTITIES.items(), grid):
        for surface, axes in zip(surfaces, axes_row):
            _panel(axes, {scheme: (runs.get((surface, scheme)), line) for scheme, (_, line) in SCHEMES.items()}, name)
            axes.set_ylim(bottom=0)
        axes_row[0].set_ylabel(label, labelpad=2)
    return figure


def _torus_figure(runs, rows):
    headings = [[*QUANTITIES.values(), "energy $W(H_h)$"]]
    figure, (axes_row,) = time_series.panels(headings, _legend(ON_TORUS, runs), _notes(runs, rows, ["torus"]))
    lines = {scheme: (runs.get(("torus", scheme)), line) for scheme, (_, line) in ON_TORUS.items()}
    for name, axes in zip((*QUANTITIES, "willmore_energy"), axes_row):
        _panel(axes, lines, name)
        if name in QUANTITIES:
            axes.set_ylim(bottom=0)
        else:
            style.limit_line(axes, *TORUS)
    return figure


def _panel(axes, lines, name):
    """A quantity over time. `lines`: {scheme: (row, or None, and keyword arguments of `plot`)}."""
    values, end = [np.empty(0)], 0
    for row, line in lines.values():
        if row:
            values.append(time_series.draw_series(axes, row, name, line, (0, np.inf)))
            end = max(end, max(row["series"]["t"]))
    time_series.scale(axes, np.concatenate(values))
    axes.set_xlim(0, end or 1)


def _notes(runs, rows, surfaces):
    """Mesh and step size of the runs, and which runs stopped or are missing."""
    notes = []
    for surface in surfaces:
        relation = r"\leq" if surface == "torus" else "="  # the steps of the torus are adaptive
        settings = dict.fromkeys(rf"{style.nodes_label(row['nodes'])}, $\tau {relation} {row['tau']:.3g}$"
                                 for (of, _), row in runs.items() if of == surface)
        name = SURFACES[surface]
        notes += style.wrap(f"{name[0].upper()}{name[1:]}: {'; '.join(settings)}.")
    return notes + time_series.stopped_notes(runs.values(), _name) + time_series.failure_notes(rows, _name)


def _name(row):
    return f"{SURFACES[label_of(row, 'surface')]}, {(SCHEMES | ON_TORUS)[_scheme(row)][0]}"


if __name__ == "__main__":
    run("tangential_motion", draw, __doc__)
