# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 8 of Beschle, Kovács (2022): solutions from interpolated initial values, and from Ritz maps with theta.

Usage: python3 plots/cahn_hilliard_initial_values.py results/paper/cahn_hilliard_initial_values.json figures
Writes figures/bk22/fig8.{pdf,png}: both solutions u on the evolving ellipsoid at several times.
"""
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

import style
import time_series
from script import run
from snapshots import Snapshots, evenly, shared_times, surface_grid
from surfaces import draw_surface, extent, read_surface, view
from table import TableError, has_series, label_of

STEM = "cahn_hilliard_initial_values"
SCHEMES = {"interpolation": "interpolation, (3.12)", "ritz_theta": r"Ritz map and $\vartheta$, (3.15)"}
CONSTANT = "unit"  # for which max |u| = 1 at the start
VIEW = view(-55, 25, up=3)
ROWS = 5
BAR, BAR_HEIGHT, BAR_LABELS = 2.6, 0.11, 0.36  # inches


def draw(table, folder):
    """Yields the figure; `folder` is the table's. TableError when no run has snapshots."""
    rows = [row for row in table["rows"]
            if label_of(row, "initial") in SCHEMES and label_of(row, "constant") == CONSTANT]
    runs = finest_runs(rows)
    if not runs:
        raise TableError(f"no snapshots of the schemes {' and '.join(SCHEMES)}")
    columns = {scheme: Snapshots(row, folder, STEM) for scheme, row in runs.items()}
    yield "bk22/fig8", surfaces_figure(runs, columns, table.get("parameters", {}).get("epsilon"),
                                       time_series.failure_notes(rows))


def finest_runs(rows):
    """{scheme: row} on the finest mesh that has most of the schemes, with the smallest step size."""
    found = {}
    for row in rows:
        if has_series(row) and row.get("snapshots"):
            found.setdefault((row["nodes"], row["tau"]), {})[label_of(row, "initial")] = row
    if not found:
        return {}
    _, _, runs = max(((len(runs), (nodes, -tau), runs) for (nodes, tau), runs in found.items()),
                     key=lambda entry: entry[:2])
    return {scheme: runs[scheme] for scheme in SCHEMES if scheme in runs}


def surfaces_figure(runs, columns, epsilon, notes):
    """A row of surfaces for each time, a column for each scheme, one scale and one colour bar."""
    times, found = zip(*evenly(shared_times(list(columns.values())), ROWS))
    surfaces = [[file and read_surface(file[1]) for file in files] for files in found]
    boxes = [[surface and extent(surface, VIEW) for surface in row] for row in surfaces]
    row = next(iter(runs.values()))
    heading = f"{style.nodes_label(row['nodes'])}, " + rf"$\tau = {row['tau']:.3g}$"
    heading += rf", $\varepsilon = {epsilon:g}$" if epsilon else ""
    notes_height = time_series.LINE * len(notes)
    figure, grid = surface_grid(boxes, [f"$t = {t:.3g}$" for t in times], [SCHEMES[scheme] for scheme in runs], heading,
                                foot=BAR_HEIGHT + BAR_LABELS + notes_height)
    shown = [surface for row in surfaces for surface in row if surface]
    bound = max(np.abs(surface.data["u"]).max() for surface in shown)
    mappable = ScalarMappable(Normalize(-bound, bound), "RdBu_r")
    for axes_row, surface_row in zip(grid, surfaces):
        for axes, surface in zip(axes_row, surface_row):
            if surface is not None:
                draw_surface(axes, surface, VIEW, facets_per_side=2, linewidth=0.1,
                             colours=(surface.data["u"].ravel(), mappable))
    width, height = figure.get_size_inches()
    bar = figure.add_axes([(width - BAR) / 2 / width, (notes_height + BAR_LABELS) / height, BAR / width,
                           BAR_HEIGHT / height])
    figure.colorbar(mappable, cax=bar, orientation="horizontal").set_label("$u_h$", labelpad=1)
    time_series.add_notes(figure, notes)
    return figure


if __name__ == "__main__":
    run(STEM, draw, __doc__)
