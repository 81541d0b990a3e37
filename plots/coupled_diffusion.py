# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 1-5 of Nick (2018), section 7.4: surface evolution coupled to diffusion on the surface, errors at the end.

Usage: python3 plots/coupled_diffusion.py results/paper/coupled_diffusion.json figures
Writes figures/nick18/fig1 .. fig5.{pdf,png}: errors of x against tau and h, then of u, in the L2 norm and the H1
seminorm, lifted as in the thesis; Figure 5 has the difference of u by (2.19) and by (7.2), always in its nodal H1 norm.
Figures 1-4 are left out when the table has none of their runs ("convergence"), Figure 5 likewise ("difference").
"""
import math
import statistics

import style
from convergence import QUANTITIES, Panel, checked_curves, curves, draw_panels, failure_notes
from script import run
from table import TableError, label_of, succeeded

NORMS = ("nodal", "lifted")  # the default is what the thesis plots
DIFFERENCE = ("u_difference", "nodal_H1")
DIFFERENCE_LABEL = r"$\Vert\, u_h^1 - u_h^2 \,\Vert_{H^1(\Gamma_h[\mathbf{x}_*])}$"
VARIANTS = ("$u_h^1$: (2.19), mass matrices of the extrapolated surfaces; "
            "$u_h^2$: (7.2), at earlier times of the computed ones.")
THESIS_BDF, THESIS_SECONDS_RATIO = 3, 1.4


def draw(table, norm):
    """Yields (name, figure) for what the table has. TableError when there is nothing, or a figure would be empty."""
    degree = table.get("parameters", {}).get("degree", 2)
    convergence, difference = (_runs(table["rows"], kind) for kind in ("convergence", "difference"))
    if not convergence and not difference:
        raise TableError('no rows with run "convergence" or "difference"')
    if convergence:
        rows = of_main_bdf(convergence)
        for quantity, names in {"x": ("nick18/fig1", "nick18/fig2"), "u": ("nick18/fig3", "nick18/fig4")}.items():
            for name, variable in zip(names, ("tau", "h")):
                yield name, errors_figure(rows, quantity, norm, variable, degree)
    if difference:
        yield "nick18/fig5", difference_figure(difference)


def _runs(rows, kind):
    return [row for row in rows if label_of(row, "run") == kind and label_of(row, "bdf")]


def of_main_bdf(rows):
    """The rows of BDF3, as in the thesis, or of the lowest order where nothing with BDF3 succeeded."""
    orders = {label_of(row, "bdf") for row in rows if succeeded(row)} or {label_of(row, "bdf") for row in rows}
    main = THESIS_BDF if THESIS_BDF in orders else min(orders)
    return [row for row in rows if label_of(row, "bdf") == main]


def errors_figure(rows, quantity, norm, variable, degree):
    """Figures 1-4: an L2 panel, where order degree + 1 is observed in space, and one with the H1 seminorm."""
    panels, skipped = [], {}
    for title, name, space in (("$L^2$ norm", "L2", degree + 1), ("$H^1$ seminorm", "H1_semi", degree)):
        lines, skipped[f"{quantity} in the {title}"] = checked_curves(rows, quantity, f"{norm}_{name}", variable)
        order, faster = (space, (space + 1,)) if variable == "h" else (label_of(rows[0], "bdf"), ())
        panels.append(Panel(f"{title}, {norm}", lines, variable, order, faster))
    return draw_panels(panels, f"error of the {QUANTITIES[quantity]}{_end(rows)}", failure_notes(rows, skipped))


def _end(rows):
    ends = {f"{row['tau'] * row['steps']:.3g}" for row in rows if succeeded(row) and row.get("steps")}
    return f" at $t = {ends.pop()}$" if len(ends) == 1 else " at the end"


def difference_figure(rows):
    """Figure 5: the difference against tau and against h, and against tau for all BDF methods on one mesh.

    The thesis finds the two variants "basically identical" and shows BDF3. Their difference has order q - 1 in tau,
    one less than the errors, and does not depend on h: hence the slopes, and none against h.
    """
    main = of_main_bdf(rows)
    bdf = label_of(main[0], "bdf")
    in_time, in_space = (checked_curves(main, *DIFFERENCE, variable)[0] for variable in ("tau", "h"))
    panels = [Panel(f"BDF{bdf}, time", in_time, "tau", bdf - 1), Panel(f"BDF{bdf}, space", in_space, "h")]
    shared = _finest_shared_mesh(rows)
    methods, _ = curves(shared, *DIFFERENCE, "tau", lambda row: (-label_of(row, "bdf"), f"BDF{label_of(row, 'bdf')}"))
    if len(methods) > 1:
        for curve in methods:
            curve.order = int(curve.label[len("BDF"):]) - 1
        panels.append(Panel(f"time, {style.nodes_label(shared[0]['nodes'])}", methods, "tau"))
    notes = [VARIANTS, *_seconds_note(main, bdf)]
    skipped = {"the difference": curves(rows, *DIFFERENCE, "tau")[1]}
    notes += failure_notes(rows, skipped, lambda row: f"BDF{label_of(row, 'bdf')}")
    return draw_panels(panels, DIFFERENCE_LABEL, notes)


def _finest_shared_mesh(rows):
    """The runs on one mesh: of those with the most BDF methods the finest."""
    meshes = {}
    for row in filter(succeeded, rows):
        meshes.setdefault(float(f"{row['h']:.6g}"), []).append(row)
    return max(meshes.items(), default=(0, []), key=lambda item: (len({label_of(row, "bdf") for row in item[1]}), -item[0]))[1]


def _seconds_note(rows, bdf):
    """The measured cost of (7.2)."""
    ratios = [(row.get("values") or {}).get("seconds_ratio") for row in rows if succeeded(row)]
    ratios = [ratio for ratio in ratios if isinstance(ratio, (int, float)) and 0 < ratio < math.inf]
    if not ratios:
        return []
    runs = f"the median of {len(ratios)} runs" if len(ratios) > 1 else "one run"
    return [f"(7.2) takes {statistics.median(ratios):.2f} times as long as (2.19): {runs} with BDF{bdf}. "
            f"The thesis measured {THESIS_SECONDS_RATIO}."]


if __name__ == "__main__":
    run("coupled_diffusion", draw, __doc__, "lifted", NORMS)
