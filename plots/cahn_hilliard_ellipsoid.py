# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 2-5 of Beschle and Kovács (2022), section 9.1: the Cahn-Hilliard equation on an evolving ellipsoid.

Usage: python3 plots/cahn_hilliard_ellipsoid.py results/paper/cahn_hilliard_ellipsoid.json figures
Writes figures/bk22/fig2 .. fig5.{pdf,png}: the error of u plus that of w with BDF1 against h (2) and tau (3), and with
BDF3 (4, 5), in L^infinity(L2) and L^infinity(H1). The nodal norms, of the difference to the interpolated solution, show
what the paper describes: more than O(h) in H1, and orders in tau there; the lifted H1 norm (--norm lifted) is O(h), an
error of interpolation that hides the one in time. The runs start from Ritz maps with theta ("ritz_theta"), because
maxima over n >= 0 need both; those from interpolated values are in the table only. The paper leaves out flat curves;
here all of them are drawn. The figures of a method without any such run are left out.
"""
from convergence import ROUND_OFF, Panel, curves_of, draw_panels, failure_notes
from script import run
from table import TableError, label_of

NORMS = ("nodal", "lifted")
FIGURES = {1: ("bk22/fig2", "bk22/fig3"), 3: ("bk22/fig4", "bk22/fig5")}
START = r"Started from Ritz maps, with $\vartheta$; maxima over all $n \geq 0$."


def draw(table, norm):
    """Yields (name, figure) for what the table has. TableError when there is nothing, or a figure would be empty."""
    rows = [row for row in table["rows"] if label_of(row, "run") == "ritz_theta"]
    degree = min((label_of(row, "degree", 1) for row in rows), default=1)
    methods = {bdf: [row for row in rows if (label_of(row, "bdf"), label_of(row, "degree", 1)) == (bdf, degree)]
               for bdf in FIGURES}
    if not any(methods.values()):
        raise TableError('no rows with run "ritz_theta" and bdf 1 or 3')
    for bdf, names in FIGURES.items():
        for name, variable in zip(names, ("h", "tau")):
            if methods[bdf]:
                yield name, errors_figure(methods[bdf], norm, variable, degree, bdf)


def errors_figure(rows, norm, variable, degree, bdf):
    """A panel with the L2 norms, order degree + 1 in space, and one with the H1 norms, where nodal ones do so, too."""
    panels, skipped = [], {}
    for name, space, faster in (("L2", degree + 1, ()), ("H1", degree, (degree + 1,))):
        title = f"$L^\\infty({name[0]}^{name[1]})$"
        lines, skipped[title] = curves_of(rows, lambda row, key=f"{norm}_{name}": error_of_both(row, key), variable,
                                          smallest=ROUND_OFF)
        if not any(len(line.points) for line in lines):
            raise TableError(f"no errors of u and w in the norm {norm}_{name} with BDF{bdf}")
        order, faster = (space, faster) if variable == "h" else (bdf, ())
        panels.append(Panel(f"{title}, {norm}, BDF{bdf}", lines, variable, order, faster))
    return draw_panels(panels, "error of $u$ + error of $w$", [START, *failure_notes(rows, skipped)])


def error_of_both(row, norm):
    """The error of u plus that of w, each a maximum over time; None where one is missing."""
    errors = [row["errors"].get(quantity, {}).get(norm) for quantity in ("u", "w")]
    return sum(errors) if all(isinstance(error, (int, float)) for error in errors) else None


if __name__ == "__main__":
    run("cahn_hilliard_ellipsoid", draw, __doc__, "nodal", NORMS)
