# SPDX-License-Identifier: GPL-3.0-or-later
"""Surface diffusion of an ellipsoid: it becomes a sphere of the same volume.

Usage: python3 plots/surface_diffusion.py results/paper/surface_diffusion.json figures
Writes figures/gallery/surface_diffusion.{pdf,png}: the surface at several times (of the finest run), the area, how much
the volume, which the flow keeps, has changed, and how far the surface is from round. Shown are all step sizes of the
setting "paper" on its finest mesh, and the finest run of each other setting.
"""
import math

import numpy as np

import style
import time_series
from script import run
from snapshots import Snapshots, Strip, evenly
from surfaces import read_surface, upright_view
from table import TableError, has_series, label_of, series
from willmore import finest

STEM = "surface_diffusion"
SETTINGS = {"paper": "fixed steps", "unprojected": "fixed steps, no projections", "adaptive": "adaptive steps",
            "accurate": "small adaptive steps", "relaxed": "adaptive steps, relaxation"}
TILT = 20
PICTURES = 6
VOLUME = "volume, $|V(t) / V(0) - 1|$"
AREA = "area; dashed: sphere"
ELONGATION = r"$\max |x| - \min |x|$"


def draw(table, folder):
    """Yields (name, figure); `folder` is the table's. TableError when there are no series and no snapshots."""
    shown = [row for row in table["rows"] if has_series(row) and (series(row, "area") or series(row, "volume"))]
    if not shown:
        raise TableError("no series area or volume")
    pictured = [row for row in shown if Snapshots(row, folder, STEM).files]
    strip = None
    if pictured:
        files = evenly(Snapshots(finest(pictured), folder, STEM).files, PICTURES)
        strip = Strip(files, upright_view(read_surface(files[0][1]), TILT), 0.98 * style.WIDTH)
    shown = _selected(shown)
    yield "gallery/surface_diffusion", _figure(shown, strip, _meshes(shown) + time_series.stopped_notes(shown, _name)
                                               + time_series.failure_notes(table["rows"], _name))


def _selected(rows):
    """All step sizes of the setting "paper" on its finest mesh, largest first, and the finest run of each other one."""
    settings = {}
    for row in rows:
        settings.setdefault(label_of(row, "setting", "paper"), []).append(row)
    paper = settings.pop("paper", [])
    nodes = max((row["nodes"] for row in paper), default=0)
    return (sorted((row for row in paper if row["nodes"] == nodes), key=lambda row: -row["tau"])
            + [finest(settings[name]) for name in sorted(settings)])


def _name(row):
    setting = label_of(row, "setting", "paper")
    return SETTINGS.get(setting, setting)


def _meshes(rows):
    counts = sorted({row["nodes"] for row in rows})
    return style.wrap(f"{', '.join(map(style.nodes_label, counts))}. Fixed steps of size $\\tau$, adaptive ones at "
                      "most that large.")


def _figure(rows, strip, notes):
    labels = [rf"{_name(row)}, $\tau = {row['tau']:.3g}$" for row in rows]
    lines = style.line_styles(len(rows))
    above = strip.height + 0.14 if strip else 0.0
    figure, ((left, middle, right),) = time_series.panels([[AREA, VOLUME, ELONGATION]],
                                                          dict(zip(labels, lines)), notes, above, abreast=3)
    if strip:
        strip.draw(figure, 0.01 * style.WIDTH, figure.get_size_inches()[1] - strip.height - 0.04, facets_per_side=2,
                   linewidth=0.12)
    areas, drifts, elongations, end = [], [], [], 0
    for i, (row, line) in enumerate(zip(rows, lines)):
        t = row["series"]["t"]
        every = max(len(t) // 8, 1)
        line = {**line, "markevery": (min(i * every // len(rows), len(t) - 1), every)}  # markers side by side
        areas.append(time_series.draw_series(left, row, "area", line, (0, np.inf)))
        # The first steps, where nothing has changed yet, would make the axis long.
        drifts.append(time_series.draw_series(middle, row, "volume", line, (t[-1] / 50, np.inf), _drift))
        elongations.append(time_series.draw_series(right, row, "elongation", line, (0, np.inf), time_series.positive))
        end = max(end, max(t))
    volumes = [found[1][0] for found in (series(row, "volume") for row in rows[::-1]) if found]
    sphere = [(36 * math.pi * volume**2)**(1 / 3) for volume in volumes[:1] if volume > 0]
    time_series.scale(left, np.concatenate([*areas, sphere]))
    for area in sphere:
        style.limit_line(left, area)
    time_series.scale(middle, np.concatenate(drifts), logarithmic=True)
    time_series.scale(right, np.concatenate(elongations), logarithmic=True)
    for axes in (left, middle, right):
        axes.set_xlim(0, end or 1)
    return figure


def _drift(volume):
    """|V(t) / V(0) - 1|, NaN where it has no logarithm."""
    return time_series.positive(np.abs(volume / volume[0] - 1))


if __name__ == "__main__":
    run(STEM, draw, __doc__)
