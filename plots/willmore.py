# SPDX-License-Identifier: GPL-3.0-or-later
"""What the figures of Willmore flow share: the least energies, and errors beside the energy at the end.

W = 1/2 int H^2: 8 pi for a sphere of any radius, 4 pi^2 for the Clifford torus.
"""
import math
import statistics

import numpy as np

import style
from convergence import NORMS, QUANTITIES, ROUND_OFF, Panel, checked_curves, curves_of, draw_panels, failure_notes
from table import succeeded
from time_series import positive

SPHERE = (8 * math.pi, r"$8\pi$")
TORUS = (4 * math.pi**2, r"$4\pi^2$")
ERRORS = ("x", "nu", "H")


def limit_of(surface):
    """(W*, its name) of the surface that a flow from this one tends to."""
    return TORUS if "torus" in surface else SPHERE


def errors_and_energy(rows, norm, degree, limit):
    """Figures 7.1, 7.3 and 7.4: errors of x, nu and H, and of the Willmore energy at the end, against the mesh width.

    A line for each step size, and the theory's order, which is the degree; there is none for the energy. Runs that did not finish are missing and
    counted below; when there are no others, the figure says just that.
    """
    if not any(map(succeeded, rows)):
        return style.notice([f"None of {len(rows)} runs finished. The first: {rows[0]['status']}."])
    panels, skipped = [], {}
    for quantity in ERRORS:
        lines, skipped[quantity] = checked_curves(rows, quantity, norm, "h")
        panels.append(Panel(QUANTITIES[quantity], lines, "h", degree))
    energies, skipped["the energy"] = curves_of(rows, lambda row: _energy_error(row, limit[0]), "h", smallest=ROUND_OFF)
    panels.append(Panel(f"$|W - {limit[1].strip('$')}|${_end(rows)}", energies, "h"))
    notes = failure_notes(rows, skipped)
    return draw_panels(panels, f"error in {NORMS[norm]}", notes, columns=4)


def _energy_error(row, limit):
    energy = (row.get("values") or {}).get("willmore_energy")
    return None if energy is None else abs(energy - limit)


def _end(rows):
    ends = [row["tau"] * row["steps"] for row in rows if succeeded(row) and row.get("steps")]
    return f", $t = {statistics.median(ends):.3g}$" if ends else ""


def finest(rows):
    """The run on the mesh with most nodes, of these the one with the smallest step size."""
    return max(rows, key=lambda row: (row["nodes"], -row["tau"]))


def from_limit(limit):
    """values -> |W - W*|, NaN where it has no logarithm."""
    return lambda values: positive(np.abs(values - limit[0]))
