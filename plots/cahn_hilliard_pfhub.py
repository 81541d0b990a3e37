# SPDX-License-Identifier: GPL-3.0-or-later
"""Benchmark 1d of PFHub: spinodal decomposition on a sphere, total energies over time beside the published ones.

Usage: python3 plots/cahn_hilliard_pfhub.py results/paper/cahn_hilliard_pfhub.json figures
Writes figures/pfhub/fig1d.{pdf,png}: the energy of every run, and c on the sphere at several times, for the run with the
published resolution that comes farthest and for the finest one that comes as far.
"""
import json
import os

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

import style
import time_series
from script import run
from snapshots import Snapshots, Strip, evenly
from surfaces import view
from table import TableError, has_series, label_of, series

STEM = "cahn_hilliard_pfhub"
PUBLISHED = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "reference", "published", "pfhub_1d.json")
VIEW = view(30, 20)
PICTURES = 7
FIRST_TIME = 1  # of the logarithmic axis
# sqrt(2 kappa 5) 0.4^3 / 6 is the energy of a flat interface per length, 2 pi 100 the length of a great circle.
GREAT_CIRCLE = np.sqrt(2 * 2 * 5) * 0.4**3 / 6 * 2 * np.pi * 100
COLOURS = (style.SKY_BLUE, style.BLUE, style.ORANGE, style.GREEN, style.PURPLE)
PANEL, AXIS, LEFT = 2.9, 0.42, 0.56  # inches
LABEL, STRIP_GAP = 0.24, 0.13  # left of the strips and above them


def draw(table, folder):
    """Yields (name, figure); `folder` is the table's. TableError when no run has an energy."""
    rows = [row for row in table["rows"] if has_series(row) and series(row, "energy")]
    if not rows:
        raise TableError("no run has the series energy")
    rows.sort(key=lambda row: (not _has_moose_steps(row), row["nodes"], -label_of(row, "tolerance", 0)))
    strips = [(_mesh(row), Strip(evenly(Snapshots(row, folder, STEM).files, PICTURES), VIEW,
                                 style.WIDTH - LABEL - 0.62)) for row in _pictured(rows, folder)]
    yield "pfhub/fig1d", _figure(rows, strips, time_series.failure_notes(table["rows"]))


def _pictured(rows, folder):
    """Of the runs that come farthest the one with about the published number of nodes, and the finest."""
    candidates = [row for row in rows if Snapshots(row, folder, STEM).files]
    if not candidates:
        return []
    last = max(series(row, "t")[0][-1] for row in candidates)
    candidates = [row for row in candidates if series(row, "t")[0][-1] >= last]
    published = min(candidates, key=lambda row: abs(row["nodes"] - 6000))
    finest = max(candidates, key=lambda row: row["nodes"])
    return [published] if finest is published else [published, finest]


def _mesh(row):
    return f"$P_{label_of(row, 'degree', '')}$, {style.nodes_label(row['nodes'])}"


def _has_moose_steps(row):
    return label_of(row, "stepping") == "moose"


def _name(row):
    if _has_moose_steps(row):
        return f"{_mesh(row)}, backward Euler, MOOSE's steps"
    return f"{_mesh(row)}, BDF{label_of(row, 'bdf')}, tol. {style.power_of_ten(label_of(row, 'tolerance'))}"


def _line_styles(rows):
    """A colour for each run, dashes by elements and steps; on a mesh that is there already a thinner line on top."""
    colours = iter(COLOURS * len(rows))
    meshes, styles = set(), []
    for row in rows:
        if _has_moose_steps(row):
            styles.append({"color": style.VERMILLION, "linestyle": style.DASHES["short"], "linewidth": 1.4, "zorder": 3})
            continue
        mesh = _mesh(row)
        styles.append({"color": next(colours), "linewidth": 0.7 if mesh in meshes else 1.5,
                       "linestyle": style.DASHES["dash-dot" if label_of(row, "degree") == 2 else "solid"]})
        meshes.add(mesh)
    return styles


def published():
    """(source, times, energies) of the published run."""
    with open(PUBLISHED, encoding="utf-8") as file:
        values = json.load(file)
    return values["source"], np.array(values["t"], float), np.array(values["energy"], float)


def _figure(rows, strips, notes):
    note_height = time_series.LINE * len(notes)
    pictures = sum(strip.height + STRIP_GAP for _, strip in strips)
    height = pictures + 0.16 + PANEL + AXIS + note_height
    figure = Figure(figsize=(style.WIDTH, height))
    mappable = ScalarMappable(Normalize(0.3, 0.7), "viridis")
    bottom = height - 0.04
    for label, strip in strips:
        bottom -= strip.height + STRIP_GAP
        strip.draw(figure, LABEL, bottom, facets_per_side=2, linewidth=0, label=_time_label,
                   colours=lambda surface: (surface.data["c"], mappable))
        figure.text(0.02 / style.WIDTH, (bottom + strip.height - strip.pictures / 2) / height, label, rotation=90,
                    ha="left", va="center", fontsize=8)
    if strips:
        top = height - 0.04
        bar = figure.add_axes([1 - 0.5 / style.WIDTH, (bottom + 0.3) / height, 0.09 / style.WIDTH,
                               (top - bottom - 0.45) / height])
        figure.colorbar(mappable, cax=bar, ticks=np.linspace(0.3, 0.7, 5)).set_label("$c$", labelpad=1)
    _energies(figure, [LEFT / style.WIDTH, (AXIS + note_height) / height, 1 - (LEFT + 0.1) / style.WIDTH,
                       PANEL / height], rows)
    time_series.add_notes(figure, notes)
    return figure


def _time_label(t):
    return f"$t = {t:.3g}$" if t < 1000 else rf"$t = {t:,.0f}$".replace(",", "{,}")


def _energies(figure, place, rows):
    axes = figure.add_axes(place)
    for row, line_style in zip(rows, _line_styles(rows)):
        t, energy = series(row, "energy")
        shown = t > 0
        axes.plot(t[shown], energy[shown], label=_name(row), **line_style)
    _, t, energy = published()
    axes.plot(t[t > 0], energy[t > 0], "o", color="black", markersize=4.5, markerfacecolor="white",
              markeredgewidth=1.0, zorder=4, label="MOOSE (PFHub)")
    last = max(t.max(), max(series(row, "t")[0][-1] for row in rows))
    axes.set_xscale("log")
    axes.set_xlim(FIRST_TIME, 1.3 * last)
    axes.set_xlabel("$t$", labelpad=1)
    time_series.scale(axes, np.concatenate([energy, [GREAT_CIRCLE]]), logarithmic=True)
    axes.set_ylabel(r"energy  $\int\, f(c) + \frac{\kappa}{2}\, |\nabla c|^2$", labelpad=2)
    style.limit_line(axes, GREAT_CIRCLE, "one great circle between the phases")
    axes.grid(True)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 0.07), fontsize=8, labelspacing=0.3, handlelength=2.8)


if __name__ == "__main__":
    run(STEM, draw, __doc__)
