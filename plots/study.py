# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of a convergence study (`study CONFIG.json ..`) against the mesh width and the step size.

Usage: /usr/bin/python3 plots/study.py FOLDER/table.json [FIGURES]
Writes study_h.{pdf,png} where there are several meshes, study_tau.{pdf,png} where there are several step sizes. Dashed
lines show the expected order: k + 1 in L2 and k in H1 for elements of degree k, q for BDFq; dotted ones a higher order
that the errors follow.
"""
import math

from convergence import QUANTITIES, convergence_figure
from script import run
from table import TableError, succeeded

KINDS = ("closest", "lifted", "unlifted", "nodal")  # the first that the table has is drawn
NORMS = ("L2", "H1", "H1_semi")
DEFAULT_DEGREE, DEFAULT_BDF = 2, 3  # those of evolve


def draw(table, norm):
    """The figures of one norm, in the variables that vary."""
    configuration = table.get("parameters", {}).get("configuration", {})
    degree, bdf = configuration.get("degree", DEFAULT_DEGREE), configuration.get("bdf", DEFAULT_BDF)
    full_norm, rows = full_norm_of(table, norm), shown_rows(table)
    quantities = quantities_of(rows, full_norm)
    varied = [variable for variable in ("h", "tau") if len({f"{row[variable]:.6g}" for row in rows if succeeded(row)}) > 1]
    if not varied:
        raise TableError("errors on one mesh with one step size; expected several levels or steps")
    expected = degree + 1 if norm == "L2" else degree
    # Differences to the finest run are steeper than errors: an order that is not theirs would seem to be followed.
    highest = degree + 1 if full_norm.startswith("closest") else degree + 2
    if "h" in varied:
        yield "study_h", convergence_figure(rows, quantities, full_norm, "h", expected, range(expected + 1, highest + 1))
    if "tau" in varied:
        yield "study_tau", convergence_figure(rows, quantities, full_norm, "tau", bdf)


def full_norm_of(table, norm):
    """The norm in the kind that the errors have."""
    found = {name for row in table["rows"] for norms in (row.get("errors") or {}).values() for name in norms}
    for kind in KINDS:
        if f"{kind}_{norm}" in found:
            return f"{kind}_{norm}"
    raise TableError(f"no errors in the norm {norm}")


def shown_rows(table):
    """All but the finest run, to which there is no difference, where the errors are those."""
    return [row for row in table["rows"] if row.get("errors") or not succeeded(row)]


def quantities_of(rows, norm):
    """Those with errors in this norm that are not all zero, in the order of the papers; others follow by name."""
    found = {name for row in rows if succeeded(row) for name, norms in row["errors"].items()
             if isinstance(norms.get(norm), (int, float)) and 0 < norms[norm] < math.inf}
    order = list(QUANTITIES)
    return sorted(found, key=lambda name: (order.index(name) if name in order else len(order), name))


if __name__ == "__main__":
    run("study", draw, __doc__, "L2", NORMS, beside_table=True)
