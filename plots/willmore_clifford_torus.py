# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 7.4 of Kovács, Li, Lubich (2021): Willmore flow of a Clifford torus, and which step sizes are stable.

Usage: python3 plots/willmore_clifford_torus.py results/paper/willmore_clifford_torus.json figures
Writes figures/kll21/fig7_4.{pdf,png}: errors and energy against the mesh width on grids that are uniform in isothermal
coordinates, BDF1 with extrapolated F; figures/gallery/clifford_torus_graded.{pdf,png}: the same on unstructured meshes
with a size function; and figures/gallery/clifford_torus_stability.{pdf,png}: which runs finish with F implicit or extrapolated, BDF1 or 2.
"""
import math
import re

from matplotlib.colors import LinearSegmentedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch

import style
from convergence import NORMS
from script import run
from table import TableError, label_of, succeeded
from willmore import TORUS, errors_and_energy

NORM = "nodal_H1"  # what the authors plot
PAPER = {"run": "convergence", "F": "extrapolated", "bdf": 1, "theta": "no"}
FIGURES = {"isothermal": "kll21/fig7_4", "graded": "gallery/clifford_torus_graded"}
FAILED = {"facecolor": "#F6D8C4", "edgecolor": style.VERMILLION}
# Dark is accurate; the palest blue still differs from the colour of failure, and black letters are readable on all.
ACCURACY = LinearSegmentedColormap.from_list("accuracy", ["#5FA2CE", "#E6F0F7"])
LEFT, RIGHT, CELL, HEADING, AXIS, LINE = 1.25, 0.05, 0.27, 0.24, 0.36, 0.165  # inches


def draw(table, norm):
    """Yields (name, figure) for what the table has. TableError when it has none of these runs."""
    rows = table["rows"]
    paper = [row for row in rows if all(label_of(row, key, value) == value for key, value in PAPER.items())]
    paper = {mesh: [row for row in paper if label_of(row, "triangulation") == mesh] for mesh in FIGURES}
    stability = [row for row in rows if label_of(row, "run") == "stability"]
    if not any(paper.values()) and not stability:
        raise TableError('no rows with run "convergence" (BDF1, F "extrapolated", no theta) or "stability"')
    for mesh, figure in FIGURES.items():
        if paper[mesh]:
            yield figure, errors_and_energy(paper[mesh], norm, table.get("parameters", {}).get("degree", 2), TORUS)
    if stability:
        yield "gallery/clifford_torus_stability", stability_figure(stability, norm)


def stability_figure(rows, norm):
    """A table for each mesh: a line for each variant, a column for each step size; the error of x where a run finished.

    A run that failed may not know its mesh: its level or its label `triangulation` says which one it is.
    """
    tables = _meshes(rows)
    taus = sorted({_rounded(row["tau"]) for row in rows if _is_positive(row.get("tau"))}, reverse=True)
    variants = sorted({_variant(row) for row in rows})
    errors = [error for error in (_error(row, norm) for row in rows) if error]
    scale = LogNorm(min(errors), max(max(errors), 1.01 * min(errors))) if errors else None
    notes = style.wrap(f"Blue: error of $x$ in {NORMS[norm]}. Orange: the run failed, at the time $t$ if known. Empty: "
                       "not run.")
    table_height = HEADING + CELL * len(variants)
    height = len(tables) * table_height + AXIS + LINE * len(notes) + 0.04
    figure = Figure(figsize=(style.WIDTH, height))
    for i, (heading, of_mesh) in enumerate(tables.items()):
        y = height - i * table_height - table_height
        axes = figure.add_axes([LEFT / style.WIDTH, y / height, 1 - (LEFT + RIGHT) / style.WIDTH,
                                CELL * len(variants) / height])
        figure.text(LEFT / style.WIDTH, (y + table_height - HEADING + 0.05) / height, heading, va="bottom")
        _draw_table(axes, of_mesh, taus, variants, norm, scale)
        axes.tick_params(labelbottom=i == len(tables) - 1)
    axes.set_xlabel(r"step size $\tau$", labelpad=2)
    for i, note in enumerate(reversed(notes)):
        figure.text(0.05 / style.WIDTH, (0.04 + i * LINE) / height, note, fontsize=7.5, va="bottom")
    return figure


def _draw_table(axes, rows, taus, variants, norm, scale):
    axes.set(xlim=(-0.5, len(taus) - 0.5), ylim=(len(variants) - 0.5, -0.5))
    axes.set_xticks(range(len(taus)), [f"{tau:.3g}" for tau in taus])
    axes.set_yticks(range(len(variants)), [f"BDF{bdf}, $F$ {F}" for F, bdf in variants])
    axes.tick_params(length=0, which="both")
    for side in axes.spines.values():
        side.set_visible(False)
    for row in rows:
        if not _is_positive(row.get("tau")):
            continue
        column, line = taus.index(_rounded(row["tau"])), variants.index(_variant(row))
        error = _error(row, norm)
        look = {"facecolor": ACCURACY(scale(error)) if error else "0.93", "edgecolor": "none"}
        text, colour = (style.power_of_ten(error) if error else "done"), "black"
        if not succeeded(row):
            look, text, colour = FAILED, _failure(row), "#8A3B00"
        axes.add_patch(_box(column, line, look))
        axes.text(column, line, text, ha="center", va="center", fontsize=7.5, color=colour, gid=row.get("cell"))


def _box(column, line, look):
    return FancyBboxPatch((column - 0.46, line - 0.42), 0.92, 0.84, boxstyle="round,pad=0,rounding_size=0.06",
                          linewidth=0.6, **look)


def _failure(row):
    """When a run failed, as far as its status says so."""
    time = re.search(r"\bt = (\d[\d.]*(e[+-]?\d+)?)", row["status"])
    return f"$t = {float(time[1]):.2g}$" if time else "failed"


def _meshes(rows):
    """{heading: rows} of one mesh each, coarse to fine."""
    groups = {}
    for row in rows:
        groups.setdefault((row.get("level", 0), label_of(row, "triangulation", "")), []).append(row)
    tables = {}
    for (level, mesh), group in sorted(groups.items()):
        nodes = [row["nodes"] for row in group if succeeded(row)]
        size = style.nodes_label(nodes[0]) if nodes else f"mesh {level}"
        tables.setdefault(f"{size}, {mesh} mesh" if mesh else size, []).extend(group)
    return tables


def _variant(row):
    return label_of(row, "F", "?"), label_of(row, "bdf", 0)


def _rounded(tau):
    return float(f"{tau:.6g}")


def _is_positive(value):
    return isinstance(value, (int, float)) and 0 < value < math.inf


def _error(row, norm):
    """The error of x of a run that finished; None when it is not known."""
    error = row["errors"].get("x", {}).get(norm) if succeeded(row) else None
    return error if _is_positive(error) else None


if __name__ == "__main__":
    run("willmore_clifford_torus", draw, __doc__, NORM)
