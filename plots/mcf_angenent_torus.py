# SPDX-License-Identifier: GPL-3.0-or-later
"""Mean curvature flow of the self-shrinking torus: errors of (5.1) and of Dziuk's scheme over h, and orders in tau.

Usage: python3 plots/mcf_angenent_torus.py results/paper/mcf_angenent_torus.json figures
Writes figures/gallery/mcf_angenent_torus.{pdf,png}, errors against the exact solution for the smallest step size of
each scheme, degree and triangulation, and mcf_angenent_torus_time.{pdf,png}: (5.1) by BDF 1 to 5 against the same
discretisation with small steps, always in the nodal counterpart of the norm. Each is left out where the table has none
of its runs ("convergence", "order").
"""
import style
from convergence import NORMS, NORMS_AT_A_TIME, QUANTITIES as NAMES, Panel, curves_of, draw_panels, failure_notes
from script import run
from table import TableError, label_of, succeeded

QUANTITIES = ("x", "v", "nu", "H")
NORM = "lifted_H1"  # of the exact surface: where the theory's orders show
FLOWS = {"mean_curvature": "(5.1)", "dziuk": "Dziuk"}
TRIANGULATIONS = {"grid": "", "unstructured": " unstructured"}


def draw(table, norm):
    """Yields (name, figure) for what the table has. TableError when there is nothing."""
    space, time = ([row for row in table["rows"] if label_of(row, "run") == kind and label_of(row, "flow") in FLOWS]
                   for kind in ("convergence", "order"))
    time = [row for row in time if label_of(row, "flow") == "mean_curvature" and label_of(row, "degree") == 2]
    if not space and not time:
        raise TableError('no rows with run "convergence" or "order" of a known flow')
    if space:
        yield "gallery/mcf_angenent_torus", space_figure(space, norm)
    if time:
        yield "gallery/mcf_angenent_torus_time", time_figure(time, norm.replace("lifted", "nodal"))


def _variant(row):
    return tuple(label_of(row, name) for name in ("flow", "degree", "triangulation"))


def drawn_rows(rows):
    """Of each scheme, degree and triangulation the BDF method with the most meshes, with its smallest step size."""
    chosen = []
    good = [row for row in rows if succeeded(row)]
    for variant in dict.fromkeys(map(_variant, good)):
        methods = {}
        for row in good:
            if _variant(row) == variant:
                methods.setdefault(label_of(row, "bdf"), []).append(row)
        _, of_method = max(methods.items(), key=lambda item: (len({row["nodes"] for row in item[1]}), item[0]))
        tau = min(row["tau"] for row in of_method)
        chosen += [row for row in of_method if row["tau"] < 1.01 * tau]
    return chosen


def _label(row):
    """What makes a line, with a number that orders the lines: first those of (5.1)."""
    flow, degree, triangulation = _variant(row)
    place = list(FLOWS).index(flow), degree, triangulation != "grid"
    return -(place[0] * 100 + place[1] * 10 + place[2]), (
        f"{FLOWS[flow]} $P_{degree}${TRIANGULATIONS.get(triangulation, f' {triangulation}')}")


def space_figure(rows, norm):
    """Errors over h. The theory's order, degree or one more in L2, is drawn below the lines of (5.1) on grids."""
    chosen = drawn_rows(rows)
    panels, skipped = [], {}
    for quantity in QUANTITIES:
        lines, skipped[quantity] = curves_of(chosen, lambda row, q=quantity: row["errors"].get(q, {}).get(norm), "h",
                                             _label, 1e-14)
        for line in lines:
            if line.label.startswith("(5.1)") and "unstructured" not in line.label:
                line.order = int(line.label.split("$P_")[1][0]) + norm.endswith("L2")
        panels.append(Panel(NAMES[quantity], lines, "h"))
    return draw_panels(panels, f"error in {NORMS[norm]}", [*_setting(chosen), *failure_notes(rows, skipped)])


def _setting(rows):
    """BDF methods and step sizes of the lines."""
    settings = {}
    for row in rows:
        settings.setdefault(rf"BDF{label_of(row, 'bdf')}, $\tau = {row['tau']:.3g}$", []).append(_label(row)[1])
    return style.wrap("; ".join(f"{', '.join(dict.fromkeys(labels))}: {setting}"
                                for setting, labels in settings.items()) + ".")


def time_figure(rows, norm):
    """Errors over tau, each BDF method with its order."""
    panels, skipped = [], {}
    for quantity in QUANTITIES:
        lines, skipped[quantity] = curves_of(rows, lambda row, q=quantity: row["errors"].get(q, {}).get(norm), "tau",
                                             lambda row: (-label_of(row, "bdf"), f"BDF{label_of(row, 'bdf')}"), 1e-14)
        for line in lines:
            line.order = int(line.label[len("BDF"):])
        panels.append(Panel(NAMES[quantity], lines, "tau"))
    return draw_panels(panels, f"error in {NORMS_AT_A_TIME[norm]}, at $t = 0.2$", failure_notes(rows, skipped))


if __name__ == "__main__":
    run("mcf_angenent_torus", draw, __doc__, NORM)
