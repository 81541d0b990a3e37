# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 2-5 of Beschle and Kovács (2022), section 9.1: the Cahn-Hilliard equation on an evolving ellipsoid.

Usage: python3 plots/cahn_hilliard_ellipsoid.py results/paper/cahn_hilliard_ellipsoid.json figures
Writes figures/bk22/fig2 .. fig5.{pdf,png}: the error of u plus that of w with BDF1 against h (2) and tau (3), and with
BDF3 (4, 5), in L^infinity(L2) and L^infinity(H1). Above is the paper's own setting: lifted norms, started from
interpolated values; w(0) does not converge there, so the maxima are over n >= q. Below are runs from Ritz maps with
theta, which maxima over n >= 0 need, in nodal norms (or those of --norm), of the difference to the interpolated
solution: they show what the paper describes, more than O(h) in H1, and orders in tau there. The lifted H1 norm is O(h),
an error of interpolation that hides the one in time. The paper leaves out flat curves; here all of them are drawn. The
figures of a method without any run from Ritz maps are left out.
"""
import numpy as np

import style
from convergence import ROUND_OFF, Curve, Panel, curves_of, draw_panels, failure_notes
from script import run
from table import TableError, label_of

NORMS = ("nodal", "lifted")
FIGURES = {1: ("bk22/fig2", "bk22/fig3"), 3: ("bk22/fig4", "bk22/fig5")}
STARTS = {"interpolation": "interpolated start", "ritz_theta": r"Ritz maps, $\vartheta$"}
PAPER = (r"Above: the paper's setting, interpolated initial values, no $\vartheta$; $w_h(0)$ does not converge, so the "
         r"maxima are over $n \geq q$, and grow as $n = q$ comes closer to 0.")
BETTER = r"Started from Ritz maps, with $\vartheta$; maxima over all $n \geq 0$."


def draw(table, norm):
    """Yields (name, figure) for what the table has. TableError when there is nothing, or a figure would be empty."""
    rows = [row for row in table["rows"] if label_of(row, "run") in STARTS]
    ritz = [row for row in rows if label_of(row, "run") == "ritz_theta"]
    degree = min((label_of(row, "degree", 1) for row in ritz), default=1)
    if not any(label_of(row, "bdf") in FIGURES and label_of(row, "degree", 1) == degree for row in ritz):
        raise TableError('no rows with run "ritz_theta" and bdf 1 or 3')
    for bdf, names in FIGURES.items():
        of_method = [row for row in rows if (label_of(row, "bdf"), label_of(row, "degree", 1)) == (bdf, degree)]
        by_start = {start: [row for row in of_method if label_of(row, "run") == start] for start in STARTS}
        for name, variable in zip(names, ("h", "tau")):
            if by_start["ritz_theta"]:
                yield name, errors_figure(by_start, norm, variable, degree, bdf)


def errors_figure(by_start, norm, variable, degree, bdf):
    """Panels with the L2 norms, order degree + 1 in space, and the H1 norms, where nodal ones do so, too: a row for the
    runs from interpolated values, if there are any, and one for those from Ritz maps. One legend for all."""
    panels, notes, better = [], [], BETTER
    for start, kind in (("interpolation", "lifted"), ("ritz_theta", norm)):
        skipped = {}
        if not by_start[start]:
            continue
        for name, space, faster in (("L2", degree + 1, ()), ("H1", degree, (degree + 1,))):
            title = f"$L^\\infty({name[0]}^{name[1]})$"
            lines, skipped[title] = curves_of(by_start[start], lambda row, key=f"{kind}_{name}": error_of_both(row, key),
                                              variable, smallest=ROUND_OFF)
            if not any(len(line.points) for line in lines):
                raise TableError(f"no errors of u and w in the norm {kind}_{name} with BDF{bdf}")
            order, faster = (space, faster) if variable == "h" else (bdf, ())
            panels.append(Panel(f"{title}, {kind}, {STARTS[start]}, BDF{bdf}", lines, variable, order, faster))
        notes += failure_notes(by_start[start], skipped, lambda row, start=start: STARTS[start])
    if len(panels) > 2:
        notes = style.wrap(PAPER) + [f"Below: {better[0].lower()}{better[1:]}", *notes]
        _complete(panels)
    else:
        notes = [better, *notes]
    return draw_panels(panels, "error of $u$ + error of $w$", notes)


def _complete(panels):
    """Gives all panels the same lines, empty ones where there are no runs."""
    labels = max(([line.label for line in panel.curves] for panel in panels), key=len)
    for panel in panels:
        known = {line.label: line for line in panel.curves}
        panel.curves = [known.get(label) or Curve(label, np.empty((0, 2))) for label in labels]


def error_of_both(row, norm):
    """The error of u plus that of w, each a maximum over time; None where one is missing."""
    errors = [row["errors"].get(quantity, {}).get(norm) for quantity in ("u", "w")]
    return sum(errors) if all(isinstance(error, (int, float)) for error in errors) else None


if __name__ == "__main__":
    run("cahn_hilliard_ellipsoid", draw, __doc__, "nodal", NORMS)
