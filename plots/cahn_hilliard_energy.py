# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 6 and 7 of Beschle, Kovács (2022): the Ginzburg-Landau energy on an ellipsoid that swells and shrinks.

Usage: python3 plots/cahn_hilliard_energy.py results/paper/cahn_hilliard_energy.json figures
Writes figures/bk22/fig6 and fig7.{pdf,png}: the energy over [0, 0.2] and over [0, 1], a line for each mesh.
"""
import numpy as np
from matplotlib.figure import Figure

import style
import time_series
from script import run
from table import TableError, has_series, label_of, series

STEM = "cahn_hilliard_energy"
BDF = 2
ENDS = {"bk22/fig6": 0.2, "bk22/fig7": 1.0}
SETTLED = 0.4  # from here on the finest energies are periodic
FINEST = 3  # that many meshes are shown there
INSET = (0.34, 0.44, 0.42, 0.50)  # of the panel: left, bottom, width, height
LEFT, RIGHT, TOP, BOTTOM, HEIGHT = 0.48, 0.17, 0.26, 0.36, 3.3  # inches; HEIGHT of the panel


def draw(table, folder):
    """Yields (name, figure) for what the table has. TableError when there are no energies."""
    rows = [row for row in table["rows"] if label_of(row, "bdf") == BDF]
    lines = energies(rows)
    if not lines:
        raise TableError(f"no energies with BDF{BDF}")
    epsilon = table.get("parameters", {}).get("epsilon")
    for name, end in ENDS.items():
        # Runs that reach this figure's part of the time beyond the other figure's.
        shorter = max((other for other in ENDS.values() if other < end), default=0)
        shown = [row for row in lines if max(row["series"]["t"]) > shorter * (1 + 1e-9)]
        if shown:
            yield name, energy_figure(shown, end, epsilon, time_series.failure_notes(rows))


def energies(rows):
    """The rows with an energy, from coarse to fine; of several on one mesh the one with the smallest step size."""
    finest = {}
    for row in rows:
        if has_series(row) and series(row, "energy"):
            known = finest.setdefault(row["nodes"], row)
            finest[row["nodes"]] = min(known, row, key=lambda row: row["tau"])
    return [finest[nodes] for nodes in sorted(finest)]


def energy_figure(rows, end, epsilon, notes):
    """One panel with a line for each row, up to time `end`."""
    below = BOTTOM + time_series.LINE * len(notes)
    height = TOP + HEIGHT + below
    figure = Figure(figsize=(style.WIDTH, height))
    axes = figure.add_axes([LEFT / style.WIDTH, below / height, (style.WIDTH - LEFT - RIGHT) / style.WIDTH,
                            HEIGHT / height])
    lines = list(zip(rows, style.line_styles(len(rows))))
    for i, (_, line) in enumerate(lines):  # markers of neighbouring lines are separated, those of one line equally far
        line["markevery"] = (0.02 + 0.1 * i / len(rows), 0.1)
    draw_energies(axes, lines, (0, end))
    axes.set(xlim=(0, end), xlabel="$t$")
    axes.set_ylabel("Ginzburg–Landau energy", labelpad=2)
    axes.xaxis.labelpad = 1
    axes.grid(True)
    axes.legend(loc="upper right", labelspacing=0.25, handlelength=2.6)
    if settled_range(rows[-1], end):
        inset = axes.inset_axes(INSET)
        draw_energies(inset, lines[-FINEST:], (SETTLED, end))
        inset.set(xlim=(SETTLED, end), ylim=settled_range(rows[-1], end))
        inset.grid(True)
    taus = sorted({style.power_of_ten(row["tau"]).strip("$") for row in rows})
    heading = [f"BDF{BDF}", *(rf"$\tau = {tau}$" for tau in taus)]
    heading += [rf"$\varepsilon = {epsilon:g}$"] if epsilon else []
    figure.text(LEFT / style.WIDTH, 1 - 0.06 / height, ", ".join(heading), va="top")
    time_series.add_notes(figure, notes)
    return figure


def draw_energies(axes, lines, span):
    """Draws the energies of (row, line style) over a span of time."""
    for row, line in lines:
        t, energy = series(row, "energy")
        inside = (t >= span[0]) & (t <= span[1] * (1 + 1e-9))
        axes.plot(t[inside], energy[inside], **line, label=style.nodes_label(row["nodes"]))


def settled_range(row, end):
    """The energies of a run from SETTLED on, with some room; None when it is too short or does not change."""
    t, energy = series(row, "energy")
    late = energy[(t >= SETTLED) & (t <= end * (1 + 1e-9)) & np.isfinite(energy)]
    if len(late) < 2 or np.ptp(late) == 0:
        return None
    return late.min() - 0.25 * np.ptp(late), late.max() + 0.25 * np.ptp(late)


if __name__ == "__main__":
    run(STEM, draw, __doc__)
