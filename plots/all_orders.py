# SPDX-License-Identifier: GPL-3.0-or-later
"""The orders of all flows: polynomial degree k = 1..4 against BDF q = 1..5.

Usage: python3 plots/all_orders.py results/paper/all_orders.json figures
Writes figures/gallery/all_orders.{pdf,png}: for each flow one grid with the orders in tau, one with those in h in H1 and
one with those in h in L2; a cell says the order of each of its quantities, its colour how far the lowest is from what is
expected (q, k, k + 1). Errors in space are extrapolated to tau = 0 (experiments/all_orders.cpp).
"""
import math

import matplotlib
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

import style
from script import run
from table import TableError, label_of

DEGREES, ORDERS = (1, 2, 3, 4), (1, 2, 3, 4, 5)
LABELS = ("flow", "degree", "bdf", "run")
FLOWS = {
    "mean_curvature": ("mean curvature flow, (5.1)", ("x", "v", "nu", "H")),
    "minimal_deformation": ("(5.1), minimal deformation rate", ("x", "v", "nu", "H")),
    "dziuk": ("mean curvature flow, Dziuk", ("x", "v", "nu", "H")),
    "generalised_mean_curvature": (r"generalised mean curvature flow, $V = H^2$", ("x", "v", "nu", "V")),
    "coupled_diffusion": ("surface coupled to diffusion", ("x", "v", "u")),
    "willmore": ("Willmore flow", ("x", "nu", "H")),
    "helfrich": ("Helfrich flow", ("x", "nu", "H")),
    "cahn_hilliard": ("Cahn–Hilliard", ("u", "w")),
}
NAMES = {"nu": r"\nu"}
# Heading, run, norm, variable, and the order that is expected of degree k and BDF q.
GRIDS = (
    (r"order in $\tau$, nodal $H^1$ (expected $q$)", "time", "nodal_H1", "tau", lambda k, q: q),
    ("order in $h$, lifted $H^1$ (expected $k$)", "space", "lifted_H1", "h", lambda k, q: k),
    ("order in $h$, lifted $L^2$ (expected $k+1$)", "space", "lifted_L2", "h", lambda k, q: k + 1),
)
# From one order too little to one too much; the middle is white, and lightness falls faster to the side of too little.
DEVIATION = matplotlib.colors.LinearSegmentedColormap.from_list(
    "deviation", [(0, "#B2450E"), (0.3, "#F2B48A"), (0.44, "#FFFFFF"), (0.56, "#FFFFFF"), (1, "#CBE1F4")])
NOTES = ("Orders in $h$ with BDF1, 2, 3: nodal values are extrapolated in $\\tau$ until their error in time is of order 4.\n"
         "hidden: the steps cause more than a fifth of an error in space;   –: the errors determine no order")
UNSTABLE = {"facecolor": "0.25", "edgecolor": "white"}
HIDDEN = {"facecolor": "0.93", "edgecolor": "0.7", "hatch": "////"}


def draw(table, _norm):
    """Yields (name, figure). TableError when the table has no fits of these flows."""
    rows = {}
    for row in table["rows"]:
        rows.setdefault(tuple(label_of(row, name) for name in LABELS), []).append(row)
    fits = {}
    for fit in table.get("fits", []):
        fits[tuple(label_of(fit, name) for name in LABELS), fit["quantity"], fit["norm"], fit["variable"]] = fit["order"]
    flows = [flow for flow in FLOWS if any(key[0] == flow for key in rows)]
    if not flows:
        raise TableError(f"no rows of {', '.join(FLOWS)}")
    yield "gallery/all_orders", _figure(flows, rows, fits)


def state_of(rows):
    """"missing", "failed" (a run, or the small steps that it is compared with), "unstable" or "ok"."""
    if not rows:
        return "missing"
    if any(row["status"] != "ok" for row in rows):
        return "failed"
    return "unstable" if any(row.get("values", {}).get("unstable", 0) for row in rows) else "ok"


def is_hidden(rows, quantity, norm):
    """Whether the error in time hides that in space in some of the rows."""
    return any(f"{quantity}_{norm}_hidden" in row.get("values", {}) for row in rows)


def _figure(flows, rows, fits):
    width, line, row_gap, head = style.WIDTH, 0.104, 0.30, 0.30
    heights = [4 * (line * len(FLOWS[flow][1]) + 0.05) for flow in flows]
    foot = 0.94
    height = head + sum(heights) + row_gap * len(flows) + foot
    figure = Figure(figsize=(width, height))
    left, gap = 0.30, 0.16
    grid_width = (width - left - 0.02 - gap * (len(GRIDS) - 1)) / len(GRIDS)
    y = height - head
    for number, (flow, grid_height) in enumerate(zip(flows, heights)):
        title, quantities = FLOWS[flow]
        figure.text(left / width, (y - 0.02) / height, f"{title}: "
                    + ", ".join(f"${NAMES.get(q, q)}$" for q in quantities), ha="left", va="top", fontsize=9)
        y -= row_gap - 0.08
        for column, grid in enumerate(GRIDS):
            box = ((left + column * (grid_width + gap)) / width, (y - grid_height) / height, grid_width / width,
                   grid_height / height)
            axes = figure.add_axes(box, gid=f"{flow} {grid[1]} {grid[2]}")
            _grid(axes, flow, quantities, grid, rows, fits)
            if number == 0:
                figure.text(box[0] + box[2] / 2, (height - 0.05) / height, grid[0], ha="center", va="top", fontsize=9)
            if column == 0:
                axes.set_yticks([0.5, 1.5, 2.5, 3.5], [f"$P_{k}$" for k in DEGREES])
            if flow == flows[-1]:
                axes.set_xticks([c + 0.5 for c in range(5)], [f"BDF{q}" for q in ORDERS])
        y -= grid_height + 0.08
    _legend(figure, foot, height)
    return figure


def _grid(axes, flow, quantities, grid, rows, fits):
    _, kind, norm, variable, expected = grid
    axes.set(xlim=(0, 5), ylim=(4, 0), xticks=[], yticks=[])
    axes.tick_params(length=0)
    for i, degree in enumerate(DEGREES):
        for j, bdf in enumerate(ORDERS):
            key = (flow, degree, bdf, kind)
            of_cell = rows.get(key, [])
            orders = [fits.get((key, quantity, norm, variable)) for quantity in quantities]
            hidden = [is_hidden(of_cell, quantity, norm) for quantity in quantities]
            _cell(axes, j, i, state_of(of_cell), orders, hidden, expected(degree, bdf))


def _cell(axes, x, y, state, orders, hidden, expected):
    """One cell: the orders below each other, or why there are none."""
    def box(**look):
        axes.add_patch(Rectangle((x, y), 1, 1, linewidth=0.5, **look))

    def write(text, row=0, count=1, **look):
        axes.text(x + 0.5, y + (row + 0.5) / count * 0.9 + 0.05, text, ha="center", va="center", fontsize=6.6, **look)

    if state == "missing":
        box(facecolor="white", edgecolor="0.8")
    elif state in ("failed", "unstable"):
        box(**UNSTABLE)
        write(state, color="white")
    elif all(order is None for order in orders) and any(hidden):
        box(**HIDDEN)
        write("hidden", bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8})
    else:
        known = [order for order in orders if order is not None]
        lowest = min(known) - expected if known else 0
        box(facecolor=DEVIATION(min(max((lowest + 1) / 2, 0.0), 1.0)), edgecolor="0.7")
        for row, (order, is_concealed) in enumerate(zip(orders, hidden)):
            text = f"{order:.1f}".replace("-", "−") if order is not None else ("hidden" if is_concealed else "–")
            dark = lowest < -0.8
            write(text, row, len(orders), color="white" if dark else "black")


def _legend(figure, foot, height):
    samples = [(DEVIATION(0.0), "one order or more too low"), (DEVIATION(0.25), "half an order too low"),
               (DEVIATION(0.5), "as expected"), (DEVIATION(1.0), "one order or more above")]
    patches = [Patch(facecolor=colour, edgecolor="0.7", label=label) for colour, label in samples]
    patches += [Patch(**UNSTABLE, label="unstable"), Patch(**HIDDEN, label="all hidden by the error in time")]
    figure.legend(handles=patches, loc="lower center", ncol=3, bbox_to_anchor=(0.5, 0.30 / height), fontsize=8)
    figure.text(0.5, 0.04 / height, NOTES, ha="center", va="bottom", fontsize=8)


if __name__ == "__main__":
    run("all_orders", draw, __doc__, "lifted_H1")
