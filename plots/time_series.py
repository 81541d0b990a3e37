# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of quantities over time: panels in rows with a heading each, one legend on top, notes below."""
import math

import numpy as np
from matplotlib import ticker
from matplotlib.figure import Figure

import style
from table import has_series, series, succeeded

# Inches: what surrounds the panels.
LEFT, RIGHT, GAP_X, BELOW = 0.56, 0.10, 0.50, 0.36
PANEL_HEIGHT, HEADING, LINE = 1.62, 0.20, 0.165


def panels(headings, labels, notes=(), above=0.0, abreast=4):
    """(figure, axes[row][column]): an empty figure with one panel for each heading in rows of `headings`.

    A heading may be as long as the empty ones beside it allow. `labels`: {label: keyword arguments of `plot`}, the
    legend, at most `abreast` in a row. `notes`: lines at the foot. `above`: inches that stay free at the top.
    """
    columns = max(map(len, headings))
    legend_rows = math.ceil(len(labels) / abreast)
    legend_columns = math.ceil(len(labels) / legend_rows)
    top, bottom = above + legend_rows * LINE + 0.05, LINE * len(notes)
    row_height = HEADING + PANEL_HEIGHT + BELOW
    height = top + len(headings) * row_height + bottom
    figure = Figure(figsize=(style.WIDTH, height))
    width = (style.WIDTH - LEFT - RIGHT - (columns - 1) * GAP_X) / columns
    grid = []
    for row, texts in enumerate(headings):
        y = height - top - (row + 1) * row_height + BELOW
        grid.append([])
        for column, text in enumerate(texts):
            x = LEFT + column * (width + GAP_X)
            figure.text(x / style.WIDTH, (y + PANEL_HEIGHT + 0.06) / height, text, va="bottom")
            axes = figure.add_axes([x / style.WIDTH, y / height, width / style.WIDTH, PANEL_HEIGHT / height])
            axes.grid(True)
            axes.set_xlabel("$t$", labelpad=1)
            grid[-1].append(axes)
    handles = [grid[0][0].plot([], [], label=label, **line_style)[0] for label, line_style in labels.items()]
    by_rows = [i for column in range(legend_columns) for i in range(column, len(handles), legend_columns)]
    figure.legend([handles[i] for i in by_rows], [list(labels)[i] for i in by_rows], loc="upper center",
                  ncol=legend_columns, bbox_to_anchor=(0.5, 1 - above / height), borderaxespad=0.1,
                  labelspacing=0.25, columnspacing=1.6, handlelength=2.6)
    add_notes(figure, notes)
    return figure, grid


def add_notes(figure, notes):
    """Writes lines at the foot of a figure, which has room for them."""
    for i, note in enumerate(reversed(notes)):
        y = (0.04 + i * LINE) / figure.get_size_inches()[1]
        figure.text(LEFT / style.WIDTH, y, note, fontsize=7.5, va="bottom")


def failure_notes(rows, name=None):
    """The lines of a note that says which runs failed; none when all are there. `name(row)`: see style.in_words."""
    failed = [row for row in rows if not has_series(row)]
    return style.wrap(f"{len(failed)} of {len(rows)} runs failed: {style.in_words(failed, name)}.") if failed else []


def stopped_notes(rows, name=None):
    """The lines of a note that says which runs stopped at a singularity; none when none did."""
    stopped = [row for row in rows if has_series(row) and not succeeded(row)]
    return style.wrap(f"Stopped early, as singular: {style.in_words(stopped, name)}.") if stopped else []


def draw_series(axes, row, name, line_style, span, change=None):
    """Draws one quantity of a run; returns its values at times in `span`, those that are numbers.

    `change(values)`: what is drawn instead of the values, such as the distance from a limit.
    """
    found = series(row, name)
    if found is None:
        return np.empty(0)
    t, values = found
    values = change(values) if change else values
    axes.plot(t, values, **line_style)
    return values[(t >= span[0]) & (t <= span[1]) & np.isfinite(values)]


def positive(values):
    """The values, NaN where they have no logarithm: nothing is drawn there."""
    return np.where(values > 0, values, math.nan)


def scale(axes, values, logarithmic=False):
    """Fits the vertical axis to the values; labels a logarithmic one with round numbers. Equal values stay visible."""
    values = values[values > 0] if logarithmic else values
    if len(values) == 0:
        return
    if logarithmic:
        axes.set_yscale("log")
        values = np.log10(values)
    room = max(0.06 * np.ptp(values), 0.01 if logarithmic else 1e-4 * np.abs(values).max())
    low, high = values.min() - room, values.max() + room
    axes.set_ylim(*(10**np.array([low, high]) if logarithmic else (low, high)))
    if logarithmic:
        _label_logarithmic(axes.yaxis, low, high)


def _label_logarithmic(axis, low, high):
    """At least four round numbers between 10^low and 10^high; powers of ten are wide, so two of them are enough."""
    plain = low >= -3.3 and high <= 5
    for mantissas in ((1,), (1, 3), (1, 2, 5), (1, 1.5, 2, 3, 5, 7)):
        ticks = [m * 10.0**d for d in range(-20, 21) for m in mantissas if low <= math.log10(m) + d <= high]
        if len(ticks) >= (2 if mantissas == (1,) and not plain else 4):
            axis.set_major_locator(ticker.FixedLocator(ticks[::math.ceil(len(ticks) / 8)]))
            axis.set_major_formatter(ticker.FuncFormatter(
                lambda value, _: f"{value:g}" if plain else style.power_of_ten(value)))
            axis.set_minor_locator(ticker.NullLocator())
            return
