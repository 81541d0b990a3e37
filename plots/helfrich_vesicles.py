# SPDX-License-Identifier: GPL-3.0-or-later
"""Vesicles: stationary shapes of Helfrich flow with given area and volume.

Usage: python3 plots/helfrich_vesicles.py results/paper/helfrich_vesicles.json figures
Writes figures/gallery/helfrich_energies.{pdf,png}: the energy over the reduced volume, on the branches of prolate and
oblate shapes, and the errors of energies over the number of nodes, beside those of others' codes; and
figures/gallery/helfrich_vesicles.{pdf,png}: the shapes.
"""
import json
import os

import numpy as np

import style
import time_series
from script import run
from snapshots import Snapshots, surface_grid
from surfaces import draw_surface, extent, read_surface, view
from table import TableError, label_of
from willmore import finest

STEM = "helfrich_vesicles"
REFERENCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "reference")
BRANCHES = {"prolate": ("prolate", style.BLUE, "o"), "oblate": ("oblate", style.VERMILLION, "s"),
            "red_blood_cell": ("from a red blood cell", style.GREEN, "^")}
PICTURED = ("prolate", "oblate")
TILT = 20
ENERGY = "$E/(8\\pi)$ over the reduced volume"
ERROR = "relative error of $E$ over the number of nodes"


def draw(table, folder):
    """Yields (name, figure); `folder` is the table's. TableError when there is nothing to show."""
    rows = [row for row in table["rows"] if label_of(row, "branch") in BRANCHES and (row.get("values") or {}).get("energy")]
    if not rows:
        raise TableError(f"no energies of the branches {', '.join(BRANCHES)}")
    notes = time_series.stopped_notes(table["rows"], _name) + time_series.failure_notes(table["rows"], _name)
    yield "gallery/helfrich_energies", energies_figure(rows, notes)
    pictures = {}
    for row in rows:
        if label_of(row, "branch") in PICTURED and Snapshots(row, folder, STEM).files and _curvature(row) == 0:
            pictures.setdefault((label_of(row, "branch"), _volume(row)), []).append(row)
    if pictures:
        yield "gallery/helfrich_vesicles", shapes_figure({key: finest(rows) for key, rows in pictures.items()}, folder)


def _volume(row):
    return float(label_of(row, "volume"))


def _curvature(row):
    return float(label_of(row, "curvature"))


def _name(row):
    branch = BRANCHES.get(label_of(row, "branch"), (label_of(row, "branch"),))[0]
    return f"{branch}, $v = {label_of(row, 'volume')}$"


def branch_curve(shapes):
    """(v, E/(8 pi)) through the shapes of a branch. At constant area 4 pi the slope is -lambda_V/6."""
    shapes = sorted(shapes, key=lambda shape: shape["v"])
    v, energy = [], []
    for left, right in zip(shapes, shapes[1:]):
        h = right["v"] - left["v"]
        s = np.linspace(0, 1, 30)
        v.append(left["v"] + h * s)
        energy.append((1 + 2 * s) * (1 - s)**2 * left["E_over_8pi"] + s**2 * (3 - 2 * s) * right["E_over_8pi"]
                      - h / 6 * (s * (1 - s)**2 * left["lambda_V"] - s**2 * (1 - s) * right["lambda_V"]))
    return np.concatenate(v), np.concatenate(energy)


def _reference(*names):
    with open(os.path.join(REFERENCE, *names), encoding="utf-8") as file:
        return json.load(file)


def energies_figure(rows, notes):
    """Left the branches with the computed energies, right the errors."""
    reference, others = _reference("independent", "helfrich.json"), _reference("published", "vesicle_triangle_codes.json")
    shown = [branch for branch in BRANCHES if any(label_of(row, "branch") == branch for row in rows)]
    legend = {BRANCHES[branch][0]: _mark(branch) for branch in shown}
    legend["axisymmetric shape equations"] = {"color": "black", "linewidth": 0.8}
    legend["others, flat triangles"] = {"color": "black", "marker": "x", "linestyle": "none"}
    text = ["Dotted: not stable. Filled: $H_0 = 1.5$. Others: Jülicher's scheme as published in cselab/corpuscles.", *notes]
    figure, ((left, right),) = time_series.panels([[ENERGY, ERROR]], legend, text, abreast=2)
    for branch in PICTURED:
        stable = [shape for shape in reference["shapes"] if shape["branch"] == branch and shape["H0"] == 0]
        v, energy = branch_curve(stable)
        unstable = v > reference["oblate_loses_3d_stability_above_v"] if branch == "oblate" else v < 0
        for part, dashes in ((~unstable, "-"), (unstable, style.DASHES["dotted"])):
            left.plot(v[part], energy[part], color=BRANCHES[branch][1], linestyle=dashes, linewidth=0.8,
                      gid=f"branch {branch}")
    crossing = reference["crossing"]
    left.plot(crossing["v"], crossing["E_over_8pi"], marker="+", color="black", linestyle="none", gid="crossing")
    left.annotate(f"$v = {crossing['v']:.5f}$", (crossing["v"], crossing["E_over_8pi"]), (8, 6),
                  textcoords="offset points", fontsize=8)
    for row in rows:
        filled = {"markerfacecolor": BRANCHES[label_of(row, "branch")][1]} if _curvature(row) > 0 else {}
        style_of = _mark(label_of(row, "branch")) | filled
        if _curvature(row) == 0:
            left.plot(_volume(row), row["values"]["energy"], **style_of)
        error = row["errors"]["energy"]["surface"]
        right.loglog(row["nodes"], error / row["values"]["reference_energy"], **style_of)
    vertices = [count / 2 + 2 for count in others["triangles"]]  # of a closed surface without handles
    right.loglog(vertices, others["relative_error"], color="black", marker="x", linestyle="none", gid="others")
    low, high = (extreme(row["nodes"] for row in rows) for extreme in (min, max))
    top = max(row["errors"]["energy"]["surface"] / row["values"]["reference_energy"] for row in rows)
    right.loglog([low, high], [2 * top, 2 * top * (low / high)**2], color="0.5", linestyle=style.DASHES["dashed"],
                 linewidth=0.8, gid="slope")
    right.annotate("$O(h^4)$", ((low * high)**0.5, 2 * top * low / high), (3, 3), textcoords="offset points", fontsize=8.5)
    left.set_xlabel("$v$", labelpad=1)
    right.set_xlabel("nodes", labelpad=1)
    style.log_ticks(right.xaxis, *right.get_xlim(), right.get_window_extent().width * 72 / figure.dpi)
    return figure


def _mark(branch):
    _, colour, marker = BRANCHES[branch]
    return {"color": colour, "marker": marker, "linestyle": "none", "markerfacecolor": "white", "markersize": 4}


def shapes_figure(pictures, folder):
    """A row for each branch, a column for each reduced volume; the axis is upright."""
    branches = [branch for branch in PICTURED if any(key[0] == branch for key in pictures)]
    volumes = sorted({key[1] for key in pictures}, reverse=True)
    surfaces, boxes = [], []
    for branch in branches:
        rotation = view(20, TILT, up=3)
        surfaces.append([])
        boxes.append([])
        for volume in volumes:
            row = pictures.get((branch, volume))
            surface = row and read_surface(Snapshots(row, folder, STEM).last()[1])
            surfaces[-1].append((surface, rotation))
            boxes[-1].append(extent(surface, rotation) if surface else None)
    titles = [f"$v = {volume:g}$" for volume in volumes]
    figure, grid = surface_grid(boxes, [BRANCHES[branch][0] for branch in branches], titles,
                                "Stationary shapes of area $4\\pi$ and reduced volume $v$, $H_0 = 0$")
    for axes_row, surface_row in zip(grid, surfaces):
        for axes, (surface, rotation) in zip(axes_row, surface_row):
            if surface:
                draw_surface(axes, surface, rotation, facets_per_side=3, linewidth=0.12)
    return figure


if __name__ == "__main__":
    run(STEM, draw, __doc__)
