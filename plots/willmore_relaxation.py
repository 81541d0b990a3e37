# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 7.5 of Kovács, Li, Lubich (2021): Willmore flow of general surfaces towards stationary ones.

Usage: python3 plots/willmore_relaxation.py results/paper/willmore_relaxation.json figures
Writes figures/kll21/fig7_5.{pdf,png}: the surfaces of the paper at several times and how far their energy is from its limit; and
figures/gallery/willmore_relaxation.{pdf,png}: how far the energy of every surface is from its limit, in each setting.
"""
import numpy as np

import style
import time_series
from script import run
from snapshots import Snapshots, evenly, shared_times, surface_grid
from surfaces import draw_surface, extent, read_surface, upright_view
from table import TableError, has_series, label_of, series
from willmore import finest, from_limit, limit_of

STEM = "willmore_relaxation"
SURFACES = {"ellipsoid": "ellipsoid", "red_blood_cell": "red blood cell", "perturbed_torus": "perturbed torus",
            "small_ellipsoid": "small ellipsoid", "evans_fung_cell": "Evans–Fung cell", "small_torus": "small torus",
            "small_torus_4": "small torus, four waves"}
PAPER = ("ellipsoid", "red_blood_cell", "perturbed_torus")
# Thinner lines lie on top: lines that coincide all show.
SETTINGS = {"paper": {"color": style.VERMILLION, "linewidth": 2.1}, "adaptive": {"color": style.BLUE, "linewidth": 1.3},
            "relaxed": {"color": style.GREEN, "linewidth": 0.7}}
SETTING_NAMES = {"paper": "fixed steps (paper)", "adaptive": "adaptive steps", "relaxed": "adaptive steps, relaxation"}
ENERGIES = {"willmore_energy": (r"$W(H_h)$", style.DASHES["solid"]),
            "kappa_energy": (r"$W(\kappa_h)$", style.DASHES["dashed"])}
KAPPA = r"$W = \frac{1}{2}\int H^2$. $H_h$ is computed by the flow, $\kappa_h$ is the mean curvature of the surface."
TILT = 32
ROWS = 6  # of surfaces on a page
PANEL, AXIS, LIMIT = 1.15, 0.36, 0.16  # inches: the energies below the surfaces, and their time axis


def draw(table, folder):
    """Yields (name, figure) for what the table has; `folder` is the table's. TableError when there is nothing."""
    runs = {}
    for row in table["rows"]:
        if has_series(row) and label_of(row, "surface") in SURFACES and label_of(row, "setting") in SETTINGS:
            runs.setdefault((label_of(row, "surface"), label_of(row, "setting")), []).append(row)
    runs = {key: finest(rows) for key, rows in runs.items()}
    columns = {surface: runs[surface, "paper"] for surface in PAPER if (surface, "paper") in runs}
    columns = {surface: (row, Snapshots(row, folder, STEM)) for surface, row in columns.items()}
    columns = {surface: (row, snapshots) for surface, (row, snapshots) in columns.items() if snapshots.files}
    energies = {key: row for key, row in runs.items() if any(series(row, name) for name in ENERGIES)}
    if not columns and not energies:
        raise TableError(f"no snapshots and no energies of the surfaces {', '.join(SURFACES)}")
    if columns:
        yield "kll21/fig7_5", surfaces_figure(columns, _lost(table["rows"], PAPER, ("paper",)))
    if energies:
        yield "gallery/willmore_relaxation", energies_figure(energies, _lost(table["rows"], SURFACES, SETTINGS))


def _lost(rows, surfaces, settings):
    """Notes on the runs of a figure that failed or stopped early."""
    of_figure = [row for row in rows if label_of(row, "surface") in surfaces and label_of(row, "setting") in settings]
    def name(row):
        return f"{SURFACES[label_of(row, 'surface')]}, {SETTING_NAMES[label_of(row, 'setting')]}"

    return time_series.stopped_notes(of_figure, name) + time_series.failure_notes(of_figure, name)


def surfaces_figure(columns, notes):
    """Figure 7.5: a row of surfaces for each time, and the energies below. `columns`: {surface: (row, Snapshots)}."""
    times, found = zip(*evenly(shared_times([snapshots for _, snapshots in columns.values()]), ROWS))
    surfaces = [[file and read_surface(file[1]) for file in files] for files in found]
    views = [upright_view(next(filter(None, column)), TILT) for column in zip(*surfaces)]
    boxes = [[surface and extent(surface, of_column) for surface, of_column in zip(row, views)] for row in surfaces]
    titles = [f"{SURFACES[surface]}, {style.nodes_label(row['nodes'])}" for surface, (row, _) in columns.items()]
    taus = sorted({rf"$\tau = {row['tau']:.3g}$" for row, _ in columns.values()})
    below = AXIS + time_series.LINE * len(notes)
    figure, grid = surface_grid(boxes, [f"$t = {t:.3g}$" for t in times], titles, ", ".join(taus), own_scales=True,
                                foot=PANEL + LIMIT + below)
    for axes_row, surface_row in zip(grid, surfaces):
        for axes, surface, of_column in zip(axes_row, surface_row, views):
            if surface is not None:
                draw_surface(axes, surface, of_column, facets_per_side=2, linewidth=0.12)
    width, height = figure.get_size_inches()
    for i, (above, (surface, (row, _))) in enumerate(zip(grid[0], columns.items())):
        box = above.get_position()
        left, right = box.x0 + 0.3 / width, box.x1 - 0.1 / width
        axes = figure.add_axes([left, below / height, right - left, PANEL / height])
        _draw_energy(axes, surface, row)
        if i == 0:
            axes.set_ylabel("$|W - W^*|$", labelpad=2)
            if any(series(row, name) for name in ENERGIES):
                axes.legend(loc="upper right", borderaxespad=0.3, handlelength=2.2, labelspacing=0.2)
    time_series.add_notes(figure, notes)
    return figure


def _limit_text(surface):
    return f"$W^* = {limit_of(surface)[1].strip('$')}$"


def _draw_energy(axes, surface, row):
    limit = limit_of(surface)
    end = row["tau"] * row["steps"] if row.get("steps") else max(row["series"]["t"])
    lines = {name: {"color": style.BLUE, "linestyle": dashes, "label": label}
             for name, (label, dashes) in ENERGIES.items()}
    values = [time_series.draw_series(axes, row, name, line, (0, 1.001 * end), from_limit(limit))
              for name, line in lines.items()]
    time_series.scale(axes, np.concatenate(values), logarithmic=True)
    axes.set(xlim=(0, end), xlabel="$t$")
    axes.set_title(_limit_text(surface), fontsize=8.5, pad=2)
    axes.xaxis.labelpad = 1
    axes.grid(True)


def energies_figure(runs, notes):
    """The distance of both energies from the limit over time: a panel for each surface, a colour for each setting."""
    surfaces = [surface for surface in SURFACES if any(key[0] == surface for key in runs)]
    legend = {SETTING_NAMES[setting]: line for setting, line in SETTINGS.items() if any(key[1] == setting for key in runs)}
    legend |= {label: {"color": "black", "linestyle": dashes} for label, dashes in ENERGIES.values()}
    headings = [f"{SURFACES[surface]}, {_limit_text(surface)}" for surface in surfaces]
    rows = [headings[i:i + 3] for i in range(0, len(headings), 3)]
    figure, grid = time_series.panels(rows, legend, [KAPPA, *notes], abreast=5)
    all_axes = [axes for row in grid for axes in row]
    for surface, axes in zip(surfaces, all_axes):
        values, end = [], 0
        for setting, line in SETTINGS.items():
            row = runs.get((surface, setting))
            for name, (_, dashes) in ENERGIES.items() if row else ():
                values.append(time_series.draw_series(axes, row, name, {**line, "linestyle": dashes}, (0, np.inf),
                                                      from_limit(limit_of(surface))))
            end = max(end, max(row["series"]["t"])) if row else end
        time_series.scale(axes, np.concatenate(values), logarithmic=True)
        axes.set_xlim(0, end or 1)
        if surface in surfaces[::3]:
            axes.set_ylabel("$|W - W^*|$", labelpad=2)
    return figure


if __name__ == "__main__":
    run(STEM, draw, __doc__)
