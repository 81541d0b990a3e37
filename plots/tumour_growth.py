# SPDX-License-Identifier: GPL-3.0-or-later
"""Growth of a tumour: surfaces coloured by the activator u1, and the time series of one run.

Usage: python3 plots/tumour_growth.py results/paper/tumour_growth.json figures
Writes figures/gallery/tumour_growth.{pdf,png}, of the finest mesh and the smallest step size.
"""
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

import style
from script import run
from snapshots import Snapshots, Strip
from surfaces import view
from table import TableError, has_series

STEM = "tumour_growth"
VIEW = view(30, 20)
DASHES = style.DASHES["dashed"], style.DASHES["solid"]  # of minimum and maximum
PANELS, LABELS = 1.3, 0.42  # heights in inches


def draw(table, folder):
    rows = [row for row in table["rows"] if has_series(row) and row.get("snapshots")]
    if not rows:
        raise TableError("no run has snapshots")
    row = max(rows, key=lambda row: (row["nodes"], -row["tau"]))
    yield "gallery/tumour_growth", _figure(row, Strip(Snapshots(row, folder, STEM).files, VIEW, 0.87 * style.WIDTH))


def _figure(row, strip):
    bottom = PANELS + 1.75 * LABELS
    height = bottom + strip.height + 0.25
    figure = Figure(figsize=(style.WIDTH, height))
    all_values = np.concatenate([surface.data["u1"] for surface in strip.surfaces[1:] or strip.surfaces])
    mappable = ScalarMappable(Normalize(all_values.min(), all_values.max()), "viridis")
    strip.draw(figure, 0.03, bottom, facets_per_side=2, linewidth=0.12,
               colours=lambda surface: (surface.data["u1"], mappable))
    middle = (bottom + strip.height - strip.pictures / 2) / height
    bar = figure.add_axes([0.905, middle - 0.42 * strip.pictures / height, 0.013, 0.84 * strip.pictures / height])
    figure.colorbar(mappable, cax=bar).set_label("activator $u_1$")

    times = row["series"]["t"]
    for i, (names, label) in enumerate(((("min_u1", "max_u1"), "min and max of $u_1$"), (("area",), "area"))):
        axes = figure.add_axes([0.09 + 0.49 * i, LABELS / height, 0.40, PANELS / height])
        for name, dashes in zip(names, DASHES[-len(names):]):
            axes.plot(times, row["series"][name], color=style.BLUE, linestyle=dashes, label=name[:3])
        if len(names) > 1:
            axes.legend(loc="upper left", handlelength=2.6, labelspacing=0.25)
        axes.set(xlabel="$t$", xlim=(0, times[-1]))
        axes.set_ylabel(label, labelpad=2)
        axes.grid(True)
    figure.text(0.09, 1 - 0.1 / height, rf"{style.nodes_label(row['nodes'])}, $\tau = {row['tau']:.3g}$", va="center")
    return figure


if __name__ == "__main__":
    run(STEM, draw, __doc__)
