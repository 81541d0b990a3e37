# SPDX-License-Identifier: GPL-3.0-or-later
"""Convergence figures: errors against step size or mesh width, log-log, with reference slopes."""
import math
import textwrap
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

import style
from reference_slopes import place_slopes
from table import TableError, succeeded

ROUND_OFF = 1e-14  # smaller errors are noise, and zero has no logarithm

QUANTITIES = {"x": "surface $x$", "v": "velocity $v$", "nu": r"normal $\nu$", "H": "mean curvature $H$",
              "u": "solution $u$", "w": "chemical potential $w$", "V": "normal velocity $V$", "z": "$z$"}
NORMS = {"nodal_L2": "$L^\\infty(L^2)$", "nodal_H1": "$L^\\infty(H^1)$", "nodal_H1_semi": "$L^\\infty(H^1)$ seminorm",
         "lifted_L2": "$L^\\infty(L^2)$, lifted", "lifted_H1": "$L^\\infty(H^1)$, lifted",
         "lifted_H1_semi": "$L^\\infty(H^1)$ seminorm, lifted"}
AXES = {"tau": r"step size $\tau$", "h": "mesh width $h$"}
SYMBOLS = {"tau": r"\tau", "h": "h"}

# Inches: what surrounds the panels.
LEFT, RIGHT, GAP_X, GAP_Y = 0.56, 0.06, 0.50, 0.30
PANEL_HEIGHT, TITLE, X_LABELS, LINE = 2.05, 0.22, 0.40, 0.165


@dataclass
class Curve:
    """One marked line: errors of one mesh against tau, or of one step size against h; points (n, 2), sorted."""
    label: str
    points: np.ndarray


def curves(rows, quantity, norm, variable):
    """(curves, skipped): a Curve per mesh (`variable` "tau") or per step size ("h"), from coarse to fine, and how many
    errors of successful runs cannot be shown (missing, not finite, or round-off).

    All quantities of the same rows get the same curves in the same order; a curve may be empty.
    """
    groups, skipped = {}, 0
    for row in filter(succeeded, rows):
        points = groups.setdefault(_group(row, variable), [])
        error = row["errors"].get(quantity, {}).get(norm)
        if isinstance(error, (int, float)) and ROUND_OFF <= error < math.inf:
            points.append((row[variable], error))
        else:
            skipped += 1
    ordered = sorted(groups.items(), key=lambda item: item[0][0], reverse=True)
    return [Curve(label, np.array(sorted(points)).reshape(-1, 2)) for (_, label), points in ordered], skipped


def _group(row, variable):
    """What the runs of one line have in common: the number that orders the lines, and the line's label."""
    if variable == "tau":
        nodes = f"{row['nodes']:,}".replace(",", "{,}")
        return float(f"{row['h']:.6g}"), f"$N = {nodes}$"
    tau = float(f"{row['tau']:.6g}")
    return tau, rf"$\tau = {tau:.3g}$"


def observed_order(curve):
    """Least-squares slope of a curve in log-log; NaN for fewer than two points."""
    if len(np.unique(curve.points[:, 0])) < 2:
        return math.nan
    return np.polyfit(*np.log(curve.points.T), 1)[0]


def convergence_figure(rows, quantities, norm, variable, order, faster=()):
    """A figure with one panel per quantity: errors in `norm` against `variable` ("tau" or "h").

    A dashed line shows the theory's `order` in every panel, a dotted one the highest order of `faster` that some curve
    of the panel follows (slope within 0.35). All panels span equally many decades: equal orders look equally steep.
    Failed runs are counted under the figure. Raises TableError when there is nothing to show.
    """
    panels = {quantity: curves(rows, quantity, norm, variable) for quantity in quantities}
    for quantity, (lines, _) in panels.items():
        if not any(len(line.points) for line in lines) and not _shows_round_off(rows, quantity, norm):
            raise TableError(f"no errors of {quantity} in the norm {norm}")
    if not any(len(line.points) for lines, _ in panels.values() for line in lines):
        raise TableError(f"all errors in the norm {norm} are below {ROUND_OFF:g}")
    lines = [lines for lines, _ in panels.values()]
    labels = [line.label for line in lines[0]]
    notes = _notes(rows, {quantity: skipped for quantity, (_, skipped) in panels.items()})
    figure, all_axes, styles = _frame(len(panels), labels, notes)
    for i, (axes, quantity, data) in enumerate(zip(all_axes, quantities, lines)):
        axes.set_title(QUANTITIES.get(quantity, quantity), pad=4)
        if i >= len(all_axes) - _columns(len(all_axes)):
            axes.set_xlabel(AXES[variable], labelpad=2)
        if i % _columns(len(all_axes)) == 0:
            axes.set_ylabel(f"error in {NORMS.get(norm, norm)}", labelpad=3)
        for curve, line_style in zip(data, styles):
            axes.plot(*curve.points.T, **line_style)
        if not any(len(curve.points) for curve in data):
            axes.yaxis.set_visible(False)
            axes.text(0.5, 0.5, f"all errors below {_power(ROUND_OFF)}", transform=axes.transAxes, ha="center")
    _scale_and_reference(all_axes, lines, order, faster, variable)
    return figure


def _shows_round_off(rows, quantity, norm):
    """Whether some error is there, but so small that it is not drawn."""
    errors = [row["errors"].get(quantity, {}).get(norm) for row in filter(succeeded, rows)]
    return any(isinstance(error, (int, float)) and error < ROUND_OFF for error in errors)


def _notes(rows, skipped):
    """The lines under the figure: what is not shown, and why."""
    notes = []
    failed = [row for row in rows if not succeeded(row)]
    if failed:
        names = [str(row.get("cell", "?")) for row in failed]
        more = f" and {len(names) - 6} more" if len(names) > 6 else ""
        notes.append(f"{len(failed)} of {len(rows)} runs failed: {', '.join(names[:6])}{more}.")
    if any(skipped.values()):
        counts = ", ".join(f"{count} of {quantity}" for quantity, count in skipped.items() if count)
        notes.append(f"Errors not shown (missing or below {_power(ROUND_OFF)}): {counts}.")
    return [line for note in notes for line in textwrap.wrap(note, 125)]


def _power(value):
    return f"$10^{{{round(math.log10(value))}}}$"


def _columns(panels):
    return min(panels, 2) if panels != 3 else 3


def _frame(panels, labels, notes):
    """The figure with empty panels, one legend for all of them on top, and the notes below."""
    columns = _columns(panels)
    rows = math.ceil(panels / columns)
    legend_columns = len(labels) if len(labels) <= 5 else math.ceil(len(labels) / 2)
    legend_columns = min(legend_columns, 5)
    legend_rows = math.ceil(len(labels) / legend_columns)
    top = legend_rows * LINE + TITLE + 0.04
    bottom = X_LABELS + LINE * len(notes)
    height = top + rows * PANEL_HEIGHT + (rows - 1) * (GAP_Y + TITLE - 0.05) + bottom
    figure = Figure(figsize=(style.WIDTH, height))
    width = min((style.WIDTH - LEFT - RIGHT - (columns - 1) * GAP_X) / columns, 1.8 * PANEL_HEIGHT)
    margin = (style.WIDTH - LEFT - RIGHT - (columns - 1) * GAP_X - columns * width) / 2
    all_axes = []
    for i in range(panels):
        row, column = divmod(i, columns)
        y = height - top - PANEL_HEIGHT - row * (PANEL_HEIGHT + GAP_Y + TITLE - 0.05)
        x = LEFT + margin + column * (width + GAP_X)
        axes = figure.add_axes([x / style.WIDTH, y / height, width / style.WIDTH, PANEL_HEIGHT / height])
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.grid(True)
        all_axes.append(axes)
    styles = style.line_styles(len(labels))
    handles = [all_axes[0].plot([], [], label=label, **line_style)[0] for label, line_style in zip(labels, styles)]
    by_rows = [i for column in range(legend_columns) for i in range(column, len(handles), legend_columns)]
    figure.legend([handles[i] for i in by_rows], [labels[i] for i in by_rows], loc="upper center", ncol=legend_columns,
                  bbox_to_anchor=(0.5, 1.0), borderaxespad=0.1, labelspacing=0.25, columnspacing=1.6, handlelength=2.2)
    for i, note in enumerate(reversed(notes)):
        figure.text(LEFT / style.WIDTH, (0.04 + i * LINE) / height, note, fontsize=7.5, va="bottom")
    return figure, all_axes, styles


def _scale_and_reference(all_axes, lines, order, faster, variable):
    """Sets equal ranges, then draws the reference slopes; widens the ranges until every slope finds a place."""
    logs = [np.concatenate([np.log10(curve.points) for curve in data]) for data in lines]
    x = np.concatenate(logs)[:, 0]
    pad = 0.06 * np.ptp(x) if np.ptp(x) > 0 else 0.3
    x_range = np.array([x.min() - pad, x.max() + pad])
    middles = [(log[:, 1].min() + log[:, 1].max()) / 2 if len(log) else -16 for log in logs]
    span = max([2.0] + [1.12 * np.ptp(log[:, 1]) for log in logs if len(log)])
    room = 0.0
    for _ in range(20):
        y_ranges = [middle + np.array([-span / 2 - room, span / 2]) for middle in middles]
        places = [_places(axes, data, x_range, y_range, order, faster, variable)
                  for axes, data, y_range in zip(all_axes, lines, y_ranges)]
        if None not in places:
            break
        room += 0.06 * span
    for axes, y_range, references in zip(all_axes, y_ranges, places):
        axes.set_xlim(10**x_range)
        axes.set_ylim(10**y_range)
        style.log_ticks(axes.xaxis, *10**x_range, _size_in_points(axes)[0])
        for (label, dashes), placement in references or []:
            _draw_reference(axes, label, dashes, placement)


def _size_in_points(axes):
    """Width and height of the panel."""
    return axes.get_position().size * axes.figure.get_size_inches() * 72


def _places(axes, data, x_range, y_range, order, faster, variable):
    """[((label, dashes), Placement)] for the slopes of one panel, or None when one of them does not fit."""
    shown = [curve for curve in data if len(curve.points)]
    slopes = [observed_order(curve) for curve in shown]
    if all(math.isnan(slope) for slope in slopes):
        return []  # nothing that a slope could be compared with
    followed = max((p for p in faster if any(abs(slope - p) <= 0.35 for slope in slopes)), default=None)
    orders = [order] if followed is None else [followed, order]
    size = _size_in_points(axes)
    per_decade = size / [np.ptp(x_range), np.ptp(y_range)]
    origin = [x_range[0], y_range[0]]
    polylines = [(np.log10(curve.points) - origin) * per_decade for curve in shown]
    labels = [(f"$O({SYMBOLS[variable]}^{{{p:g}}})$", (0, (4, 2.5)) if p == order else (0, (1, 1.5)))
              for p in orders]
    placements = place_slopes(size, polylines, [p * per_decade[1] / per_decade[0] for p in orders],
                              [_label_size(axes, label) for label, _ in labels])
    return placements and list(zip(labels, placements))


def _label_size(axes, label):
    text = axes.text(0, 0, label, fontsize=8.5)
    box = text.get_window_extent()
    text.remove()
    return np.array(box.size) * 72 / axes.figure.dpi


def _draw_reference(axes, label, dashes, placement):
    size = _size_in_points(axes)
    start, end = np.array(placement.start) / size, np.array(placement.end) / size
    line, = axes.plot(*np.array([start, end]).T, transform=axes.transAxes, color="black", linestyle=dashes,
                      linewidth=1.0)
    line.set_gid("reference " + label)
    axes.text(*(np.array(placement.label) / size), label, transform=axes.transAxes, fontsize=8.5, va="bottom")
