# SPDX-License-Identifier: GPL-3.0-or-later
"""Growth of a tumour: surfaces coloured by the activator u1, and the time series of one run.

Usage: python3 plots/tumour_growth.py results/paper/tumour_growth.json figures
Writes figures/gallery/tumour_growth.{pdf,png}, of the finest mesh and the smallest step size.
"""
import os

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

import style
from script import run
from surfaces import draw_surface, extent, read_surface, view
from table import TableError, has_series

VIEW = view(30, 20)
PANELS, LABELS = 1.3, 0.42  # heights in inches


def draw(table, folder):
    rows = [row for row in table["rows"] if has_series(row) and row.get("snapshots")]
    if not rows:
        raise TableError("no run has snapshots")
    row = max(rows, key=lambda row: (row["nodes"], -row["tau"]))
    place = os.path.join(folder, "cells", "tumour_growth", row["cell"])
    surfaces = [(entry["t"], read_surface(os.path.join(place, entry["file"]))) for entry in row["snapshots"]]
    yield "gallery/tumour_growth", _figure(row, surfaces)


def _figure(row, surfaces):
    boxes = [extent(surface, VIEW) for _, surface in surfaces]
    widths = np.array([box[1] - box[0] for box in boxes])
    tallest = max(box[3] - box[2] for box in boxes)
    room, gap = 0.86, 0.012
    scale = (room - gap * (len(boxes) - 1)) * style.WIDTH / widths.sum()  # inches a unit
    pictures = scale * tallest
    height = pictures + PANELS + 3 * LABELS
    figure = Figure(figsize=(style.WIDTH, height))
    all_values = np.concatenate([surface.data["u1"] for _, surface in surfaces[1:]])
    mappable = ScalarMappable(Normalize(all_values.min(), all_values.max()), "viridis")

    left = 0.005
    middle = (PANELS + 2.4 * LABELS + pictures / 2) / height
    for (t, surface), box, width in zip(surfaces, boxes, widths):
        high = scale * (box[3] - box[2]) / height
        axes = figure.add_axes([left, middle - high / 2, scale * width / style.WIDTH, high])
        axes.set(xlim=box[:2], ylim=box[2:])
        axes.set_axis_off()
        draw_surface(axes, surface, VIEW, facets_per_side=2, linewidth=0.12, colours=(surface.data["u1"], mappable))
        centre = left + scale * width / style.WIDTH / 2
        figure.text(centre, (PANELS + 1.9 * LABELS) / height, f"$t = {t:.3g}$", ha="center")
        left += scale * width / style.WIDTH + gap
    bar = figure.add_axes([0.905, middle - 0.42 * pictures / height, 0.013, 0.84 * pictures / height])
    figure.colorbar(mappable, cax=bar).set_label("activator $u_1$")

    times = row["series"]["t"]
    for i, (names, label) in enumerate(((("min_u1", "max_u1"), "min and max of $u_1$"), (("area",), "area"))):
        axes = figure.add_axes([0.09 + 0.49 * i, LABELS / height, 0.40, PANELS / height])
        for name in names:
            axes.plot(times, row["series"][name], color="#0072B2")
        axes.set(xlabel="$t$", xlim=(0, times[-1]))
        axes.set_ylabel(label, labelpad=2)
        axes.grid(True)
    nodes = f"{row['nodes']:,}".replace(",", "{,}")
    figure.text(0.09, 1 - 0.1 / height, rf"$N = {nodes}$, $\tau = {row['tau']:.3g}$", va="center")
    return figure


if __name__ == "__main__":
    run("tumour_growth", draw, __doc__)
