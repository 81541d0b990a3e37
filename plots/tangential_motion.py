# SPDX-License-Identifier: GPL-3.0-or-later
"""Quality of meshes in mean curvature flow with and without tangential motion.

Usage: python3 plots/tangential_motion.py results/paper/tangential_motion.json figures
Writes figures/gallery/tangential_motion.{pdf,png}: the smallest angle and the worst radius ratio over time.
"""
import numpy as np

import style
import time_series
from script import run
from table import TableError, has_series, label_of, series
from willmore import finest

SURFACES = {"dumbbell": "dumbbell", "red_blood_cell": "red blood cell", "ellipsoid": "ellipsoid (4, 1, 1)"}
# (flow, tangential motion): label and line. Thinner lines lie on top: lines that coincide all show.
SCHEMES = {("mean_curvature", "none"): ("(5.1)", {"color": style.BLUE, "linewidth": 1.6}),
           ("mean_curvature", "minimal_deformation"): ("(5.1), minimal deformation rate",
                                                       {"color": style.GREEN, "linewidth": 1.6}),
           ("dziuk", "none"): ("Dziuk", {"color": style.VERMILLION, "linewidth": 1.0,
                                         "linestyle": style.DASHES["dashed"]}),
           ("bgn", "none"): ("BGN", {"color": style.PURPLE, "linewidth": 1.0})}
QUANTITIES = {"worst_angle": "smallest angle (degrees)", "worst_radius_ratio": "worst radius ratio"}


def draw(table, folder):
    """Yields (name, figure). TableError when there is nothing to show; `folder` is not needed."""
    rows = [row for row in table["rows"] if label_of(row, "surface") in SURFACES and _scheme(row) in SCHEMES]
    runs = {}
    for row in filter(has_series, rows):
        runs.setdefault((label_of(row, "surface"), _scheme(row)), []).append(row)
    runs = {key: finest(found) for key, found in runs.items() if any(series(row, name) for row in found
                                                                     for name in QUANTITIES)}
    if not runs:
        raise TableError(f"no series {', '.join(QUANTITIES)} of {', '.join(SURFACES)}")
    yield "gallery/tangential_motion", _figure(runs, rows)


def _scheme(row):
    return label_of(row, "flow"), label_of(row, "tangential")


def _figure(runs, rows):
    surfaces = [surface for surface in SURFACES if any(of == surface for of, _ in runs)]
    legend = {SCHEMES[scheme][0]: SCHEMES[scheme][1] for scheme in SCHEMES
              if any(of == scheme for _, of in runs)}
    headings = [[SURFACES[surface] for surface in surfaces], [""] * len(surfaces)]
    figure, grid = time_series.panels(headings, legend, _notes(runs, rows, surfaces))
    for (name, label), axes_row in zip(QUANTITIES.items(), grid):
        for surface, axes in zip(surfaces, axes_row):
            values, end = [], 0
            for scheme, (_, line) in SCHEMES.items():
                row = runs.get((surface, scheme))
                if row:
                    values.append(time_series.draw_series(axes, row, name, line, (0, np.inf)))
                    end = max(end, max(row["series"]["t"]))
            time_series.scale(axes, np.concatenate(values))
            axes.set_ylim(bottom=0)
            axes.set_xlim(0, end or 1)
        axes_row[0].set_ylabel(label, labelpad=2)
    return figure


def _notes(runs, rows, surfaces):
    """Mesh and step size of the runs, and which runs stopped or are missing."""
    notes = []
    for surface in surfaces:
        settings = dict.fromkeys(rf"{style.nodes_label(row['nodes'])}, $\tau = {row['tau']:.3g}$"
                                 for (of, _), row in runs.items() if of == surface)
        name = SURFACES[surface]
        notes += style.wrap(f"{name[0].upper()}{name[1:]}: {'; '.join(settings)}.")
    return notes + time_series.stopped_notes(runs.values(), _name) + time_series.failure_notes(rows, _name)


def _name(row):
    return f"{SURFACES[label_of(row, 'surface')]}, {SCHEMES[_scheme(row)][0]}"


if __name__ == "__main__":
    run("tangential_motion", draw, __doc__)
