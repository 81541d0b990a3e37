# SPDX-License-Identifier: GPL-3.0-or-later
"""Convergence figures: errors against step size or mesh width, log-log, with reference slopes."""
import functools
import math
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

import style
from reference_slopes import place_slopes
from table import TableError, succeeded

ROUND_OFF = 1e-14  # smaller errors are noise, and zero has no logarithm

QUANTITIES = {"x": "surface $x$", "v": "velocity $v$", "nu": r"normal $\nu$", "H": "mean curvature $H$",
              "u": "solution $u$", "w": "chemical potential $w$", "V": "normal velocity $V$", "z": "$z$"}
NORMS = {"nodal_L2": "$L^\\infty(L^2)$, nodal", "nodal_H1": "$L^\\infty(H^1)$, nodal",
         "nodal_H1_semi": "$L^\\infty(H^1)$ seminorm, nodal",
         "lifted_L2": "$L^\\infty(L^2)$, lifted", "lifted_H1": "$L^\\infty(H^1)$, lifted",
         "lifted_H1_semi": "$L^\\infty(H^1)$ seminorm, lifted",
         "quadrature_L2": "$L^\\infty(L^2)$, quadrature", "quadrature_H1": "$L^\\infty(H^1)$, quadrature",
         "quadrature_H1_semi": "$L^\\infty(H^1)$ seminorm, quadrature",
         "closest_L2": "$L^2$ at the end, closest point", "closest_H1": "$H^1$ at the end, closest point",
         "closest_H1_semi": "$H^1$ seminorm at the end, closest point"}
# The same without the maximum over time.
NORMS_AT_A_TIME = {norm: name.replace(r"L^\infty(", "", 1).replace(")", "", 1) for norm, name in NORMS.items()}
AXES = {"tau": r"step size $\tau$", "h": "mesh width $h$"}
SYMBOLS = {"tau": r"\tau", "h": "h"}

# Inches: what surrounds the panels.
LEFT, RIGHT, GAP_X, GAP_Y = 0.56, 0.06, 0.50, 0.30
PANEL_HEIGHT, TITLE, X_LABELS, LINE = 2.05, 0.22, 0.40, 0.165
LEGEND_ENTRY = 0.95  # room for one in a legend above one panel


@dataclass
class Curve:
    """One marked line: errors of one mesh against tau, or of one step size against h; points (n, 2), sorted.

    The theory's `order` of this line alone, if it has one, is drawn below it in its colour.
    """
    label: str
    points: np.ndarray
    order: float = None


@dataclass
class Panel:
    """One panel: its curves against `variable` ("tau" or "h").

    A dashed line shows the theory's `order` of all curves, a dotted one the highest order of `faster` that some curve
    follows (slope within 0.35).
    """
    title: str
    curves: list
    variable: str
    order: float = None
    faster: tuple = ()


def curves(rows, quantity, norm, variable, group=None):
    """(curves, skipped): a Curve per mesh (`variable` "tau") or per step size ("h"), from coarse to fine, and how many
    errors of successful runs cannot be shown (missing, not finite, or round-off).

    All quantities of the same rows get the same curves in the same order; a curve may be empty.
    `group(row)`: what makes other curves, a number (the highest comes first) and a label.
    """
    return curves_of(rows, lambda row: row["errors"].get(quantity, {}).get(norm), variable, group, ROUND_OFF)


def curves_of(rows, quantity, variable, group=None, smallest=-math.inf):
    """`curves` of any `quantity(row)`; not shown is what is no finite number, or below `smallest`."""
    groups, skipped = {}, 0
    for row in filter(succeeded, rows):
        points = groups.setdefault(group(row) if group else _group(row, variable), [])
        value = quantity(row)
        if isinstance(value, (int, float)) and math.isfinite(value) and value >= smallest:
            points.append((row[variable], value))
        else:
            skipped += 1
    ordered = sorted(groups.items(), key=lambda item: item[0][0], reverse=True)
    return [Curve(label, np.array(sorted(points)).reshape(-1, 2)) for (_, label), points in ordered], skipped


def _group(row, variable):
    """What the runs of one line have in common: the number that orders the lines, and the line's label."""
    if variable == "tau":
        return float(f"{row['h']:.6g}"), style.nodes_label(row["nodes"])
    tau = float(f"{row['tau']:.6g}")
    return tau, rf"$\tau = {tau:.3g}$"


def observed_order(curve):
    """Least-squares slope of a curve in log-log; NaN for fewer than two points."""
    if len(np.unique(curve.points[:, 0])) < 2:
        return math.nan
    return np.polyfit(*np.log(curve.points.T), 1)[0]


def convergence_figure(rows, quantities, norm, variable, order, faster=()):
    """A figure with one panel per quantity: errors in `norm` against `variable` ("tau" or "h").

    The theory's `order`, and those of `faster` that the data follow, are drawn in every panel (see Panel). Failed runs
    are counted under the figure. Raises TableError when there is nothing to show.
    """
    data = {quantity: checked_curves(rows, quantity, norm, variable) for quantity in quantities}
    panels = [Panel(QUANTITIES.get(quantity, quantity), lines, variable, order, faster)
              for quantity, (lines, _) in data.items()]
    notes = failure_notes(rows, {quantity: skipped for quantity, (_, skipped) in data.items()})
    return draw_panels(panels, f"error in {NORMS.get(norm, norm)}", notes)


def checked_curves(rows, quantity, norm, variable):
    """What `curves` returns. Raises TableError when no error is there, not even one below round-off."""
    lines, skipped = curves(rows, quantity, norm, variable)
    if not any(len(line.points) for line in lines) and not _shows_round_off(rows, quantity, norm):
        raise TableError(f"no errors of {quantity} in the norm {norm}")
    return lines, skipped


def draw_panels(panels, y_label, notes=(), columns=None):
    """A figure of panels with `notes` below: one legend when all have the same lines, otherwise one above each.

    All panels of errors span equally many decades: equal orders over the same variable look equally steep. `columns`:
    how many panels stand side by side, if that matters. Raises TableError when all panels are empty.
    """
    columns = columns or _columns(len(panels))
    if not any(len(line.points) for panel in panels for line in panel.curves):
        raise TableError(f"all errors are below {ROUND_OFF:g}")
    legends = [[line.label for line in panel.curves] for panel in panels]
    if all(labels == legends[0] for labels in legends):
        legends = legends[:1]
    figure, all_axes = _frame(len(panels), columns, legends, notes)
    for i, (axes, panel) in enumerate(zip(all_axes, panels)):
        axes.set_title(panel.title, pad=4)
        if i >= len(all_axes) - columns:
            axes.set_xlabel(AXES[panel.variable], labelpad=2)
        if i % columns == 0:
            axes.set_ylabel(y_label, labelpad=3)
        for curve, line_style in zip(panel.curves, style.line_styles(len(panel.curves))):
            axes.plot(*curve.points.T, **line_style)
        if not any(len(curve.points) for curve in panel.curves):
            axes.yaxis.set_visible(False)
            axes.text(0.5, 0.5, f"all errors below {_power(ROUND_OFF)}", transform=axes.transAxes, ha="center")
    _scale_and_reference(all_axes, panels)
    return figure


def _shows_round_off(rows, quantity, norm):
    """Whether some error is there, but so small that it is not drawn."""
    errors = [row["errors"].get(quantity, {}).get(norm) for row in filter(succeeded, rows)]
    return any(isinstance(error, (int, float)) and error < ROUND_OFF for error in errors)


def failure_notes(rows, skipped, name=None):
    """The lines under a figure: what is not shown, and why. `skipped`: {quantity: how many of its errors}.

    `name(row)`: what tells runs apart beside mesh and step size.
    """
    notes = []
    failed = [row for row in rows if not succeeded(row)]
    if failed:
        notes.append(f"{len(failed)} of {len(rows)} runs failed: {style.in_words(failed, name)}.")
    if any(skipped.values()):
        counts = ", ".join(f"{count} of {quantity}" for quantity, count in skipped.items() if count)
        notes.append(f"Errors not shown (missing or below {_power(ROUND_OFF)}): {counts}.")
    return [line for note in notes for line in style.wrap(note)]


def _power(value):
    return f"$10^{{{round(math.log10(value))}}}$"


def _columns(panels):
    return min(panels, 2) if panels != 3 else 3


def _frame(panels, columns, legends, notes):
    """The figure with empty panels and the notes below: a legend on top for all of them, or one above each."""
    rows = math.ceil(panels / columns)
    width = min((style.WIDTH - LEFT - RIGHT - (columns - 1) * GAP_X) / columns, 1.8 * PANEL_HEIGHT)
    most = 5 if len(legends) == 1 else int((width + GAP_X) / LEGEND_ENTRY)
    legend_rows = max(math.ceil(len(labels) / _legend_columns(labels, most)) for labels in legends)
    above = 0 if len(legends) == 1 else legend_rows * LINE
    gap = GAP_Y + TITLE - 0.05 + above
    top = legend_rows * LINE + TITLE + 0.04
    bottom = X_LABELS + LINE * len(notes)
    height = top + rows * PANEL_HEIGHT + (rows - 1) * gap + bottom
    figure = Figure(figsize=(style.WIDTH, height))
    margin = (style.WIDTH - LEFT - RIGHT - (columns - 1) * GAP_X - columns * width) / 2
    all_axes = []
    for i in range(panels):
        row, column = divmod(i, columns)
        y = height - top - PANEL_HEIGHT - row * (PANEL_HEIGHT + gap)
        x = LEFT + margin + column * (width + GAP_X)
        axes = figure.add_axes([x / style.WIDTH, y / height, width / style.WIDTH, PANEL_HEIGHT / height])
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.grid(True)
        all_axes.append(axes)
    for axes, labels in zip(all_axes, legends):
        box = axes.get_position()
        anchor = (0.5, 1.0) if len(legends) == 1 else ((box.x0 + box.x1) / 2, box.y1 + (TITLE + above) / height)
        _draw_legend(axes, labels, _legend_columns(labels, most), anchor)
    for i, note in enumerate(reversed(notes)):
        figure.text(LEFT / style.WIDTH, (0.04 + i * LINE) / height, note, fontsize=7.5, va="bottom")
    return figure, all_axes


def _legend_columns(labels, most):
    """How many entries stand side by side: `most` at most, and in two rows about equally many."""
    return min(len(labels) if len(labels) <= most else math.ceil(len(labels) / 2), most)


def _draw_legend(axes, labels, columns, anchor):
    """A legend of the figure, its upper edge's middle at `anchor`; the entries are ordered by rows."""
    handles = [axes.plot([], [], label=label, **line_style)[0]
               for label, line_style in zip(labels, style.line_styles(len(labels)))]
    by_rows = [i for column in range(columns) for i in range(column, len(handles), columns)]
    axes.figure.legend([handles[i] for i in by_rows], [labels[i] for i in by_rows], loc="upper center", ncol=columns,
                       bbox_to_anchor=anchor, borderaxespad=0.1, labelspacing=0.25, columnspacing=1.6,
                       handlelength=2.2)


def _scale_and_reference(all_axes, panels):
    """Sets the ranges of all axes, then draws reference slopes."""
    x = [np.log10(np.concatenate([curve.points[:, 0] for curve in panel.curves])) for panel in panels]
    x_ranges = [_x_range(np.concatenate([xs for xs, other in zip(x, panels) if other.variable == panel.variable]))
                for panel in panels]
    for axes, x_range in zip(all_axes, x_ranges):
        axes.set_xlim(10**x_range)
        style.log_ticks(axes.xaxis, *10**x_range, _size_in_points(axes)[0])
    _scale_errors(all_axes, panels, x_ranges)


def _scale_errors(all_axes, panels, x_ranges):
    """Sets equal vertical ranges, then draws the slopes; widens the ranges until every slope finds a place."""
    logs = [np.concatenate([np.log10(curve.points) for curve in panel.curves]) for panel in panels]
    middles = [(log[:, 1].min() + log[:, 1].max()) / 2 if len(log) else -16 for log in logs]
    span = max([2.0] + [1.12 * np.ptp(log[:, 1]) for log in logs if len(log)])
    room = 0.0
    for _ in range(20):
        y_ranges = [middle + np.array([-span / 2 - room, span / 2]) for middle in middles]
        places = [_places(*of_panel) for of_panel in zip(all_axes, panels, x_ranges, y_ranges)]
        if None not in places:
            break
        room += 0.06 * span
    for axes, y_range, references in zip(all_axes, y_ranges, places):
        axes.set_ylim(10**y_range)
        for label, look, placement in references or []:
            _draw_reference(axes, label, look, placement)


def _x_range(x):
    """Ends of an axis that shows all of x with its markers, and default ends without any x."""
    if not len(x):
        return np.array([-1.0, 0.0])
    pad = 0.08 * np.ptp(x) if np.ptp(x) > 0 else 0.3
    return np.array([x.min() - pad, x.max() + pad])


def _size_in_points(axes):
    """Width and height of the panel."""
    return axes.get_position().size * axes.figure.get_size_inches() * 72


def _places(axes, panel, x_range, y_range):
    """[(label, arguments of `plot`, Placement)] for the slopes of one panel, or None when one of them does not fit."""
    shown = [curve for curve in panel.curves if len(curve.points)]
    slopes = [observed_order(curve) for curve in shown]
    if all(math.isnan(slope) for slope in slopes):
        return []  # nothing that a slope could be compared with
    followed = max((p for p in panel.faster if any(abs(slope - p) <= 0.35 for slope in slopes)), default=None)
    size = _size_in_points(axes)
    per_decade = size / [np.ptp(x_range), np.ptp(y_range)]
    origin = [x_range[0], y_range[0]]
    polylines = [(np.log10(curve.points) - origin) * per_decade for curve in shown]
    dashed, dotted = ({"color": "black", "linestyle": (0, pattern)} for pattern in ((4, 2.5), (1, 1.5)))
    references = [(p, look, None) for p, look in ((followed, dotted), (panel.order, dashed)) if p]
    styles = {curve.label: look for curve, look in zip(panel.curves, style.line_styles(len(panel.curves)))}
    for curve, slope, polyline in zip(shown, slopes, polylines):
        if curve.order and not math.isnan(slope):
            references.append((curve.order, {**dashed, "color": styles[curve.label]["color"]}, polyline))
    orders, looks, owners = zip(*references) if references else ((), (), ())
    labels = [f"$O({SYMBOLS[panel.variable]}{'' if p == 1 else f'^{{{p:g}}}'})$" for p in orders]
    placements = place_slopes(size, polylines, [p * per_decade[1] / per_decade[0] for p in orders],
                              [_label_size(label) for label in labels], owners)
    return None if placements is None else list(zip(labels, looks, placements))


@functools.cache
def _label_size(label):
    """In points. The same in all figures, and formulas are parsed slowly."""
    figure = Figure()
    box = figure.text(0, 0, label, fontsize=8.5).get_window_extent()
    return np.array(box.size) * 72 / figure.dpi


def _draw_reference(axes, label, look, placement):
    size = _size_in_points(axes)
    start, end = np.array(placement.start) / size, np.array(placement.end) / size
    line, = axes.plot(*np.array([start, end]).T, transform=axes.transAxes, linewidth=1.0, **look)
    line.set_gid("reference " + label)
    axes.text(*(np.array(placement.label) / size), label, transform=axes.transAxes, fontsize=8.5, va="bottom")
