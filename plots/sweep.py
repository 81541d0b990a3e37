# SPDX-License-Identifier: GPL-3.0-or-later
"""A phase diagram of a sweep (`evolve CONFIG.json --set ..`): one quantity over two varied keys.

Usage: /usr/bin/python3 plots/sweep.py FOLDER/table.json --x parameters.gamma --y parameters.b --colour max_u1 [--output STEM]
Writes FOLDER/sweep.{pdf,png}. A name is a varied key (its last part is enough), tau, steps, h, nodes, seconds, status, or
a number of the rows: max_u1, area, u_unlifted_L2, .. Runs that failed are crossed out; what they say is in the table.
"""
import math
import os
import re
import sys

import matplotlib
from matplotlib.figure import Figure
from matplotlib.patches import Patch

import style
from script import parser_of
from table import TableError, has_series, read_table, succeeded

ROW_KEYS = ("tau", "steps", "h", "nodes", "seconds", "status")
MOST_WRITTEN = 80  # numbers are written into the cells of smaller diagrams
CELL = 0.62  # inches, at most
LEFT, RIGHT, BOTTOM, TOP, BAR = 0.9, 0.9, 0.55, 0.25, 0.14


def value_of(row, name):
    """What a row has under a name; None when it has nothing."""
    labels = row.get("labels", {})
    if name in labels:
        return labels[name]
    ends = [key for key in labels if key.rsplit(".", 1)[-1] == name]
    if len(ends) == 1:
        return labels[ends[0]]
    if name == "status":
        return row["status"].split(":")[0].split(" at ")[0]
    if name in ROW_KEYS:
        return row.get(name)
    if name in row.get("values", {}):
        return row["values"][name]
    for quantity, norms in (row.get("errors") or {}).items():
        for norm, error in norms.items():
            if name == f"{quantity}_{norm}":
                return error
    return None


def known_names(rows):
    """All names of some row, for messages."""
    names = set(ROW_KEYS)
    for row in rows:
        names.update(row.get("labels", {}), row.get("values", {}))
        names.update(f"{quantity}_{norm}" for quantity, norms in (row.get("errors") or {}).items() for norm in norms)
    return ", ".join(sorted(names))


def places(rows, name):
    """The different values on an axis: numbers ascending, then words in the order of the table."""
    values = list(dict.fromkeys(value_of(row, name) for row in rows))
    if None in values:
        raise TableError(f"{name}: not every row has it; expected one of {known_names(rows)}")
    numbers = [value for value in values if isinstance(value, (int, float))]
    return sorted(numbers) + [value for value in values if value not in numbers]


def selected(rows, conditions):
    """The rows that have these values: "key=value" each."""
    for condition in conditions:
        name, _, text = condition.partition("=")
        rows = [row for row in rows if written(value_of(row, name)) == text]
        if not rows:
            raise TableError(f"--where {condition}: no row has this value")
    return rows


def label_of(name):
    """The last part of a name, for an entry of an array with the array's: gamma, diffusion.1."""
    return re.search(r"[^.]+(\.\d+)*$", name)[0]


def three_digits(value):
    """1.80, 12.5, 102, 1.00e+03: all with three significant digits."""
    return f"{value:#.3g}".rstrip(".")


def written(value):
    return f"{value:.6g}" if isinstance(value, (int, float)) else str(value)


def is_number(value):
    return isinstance(value, (int, float)) and math.isfinite(value)


def phase_diagram(table, x, y, colour, where=()):
    """The figure: a coloured square for each row. Raises TableError for unknown names, and for two rows in one place."""
    rows = selected(table["rows"], where)
    columns, lines = places(rows, x), places(rows, y)
    if all(value_of(row, colour) is None for row in rows):
        raise TableError(f"{colour}: no row has it; expected one of {known_names(rows)}")
    grid = {}
    for row in rows:
        place = columns.index(value_of(row, x)), lines.index(value_of(row, y))
        if place in grid:
            raise TableError(f"two rows with {x} = {written(value_of(row, x))} and {y} = {written(value_of(row, y))}; "
                             "expected one: --where KEY=VALUE selects rows")
        grid[place] = row
    cell = min(CELL, (style.WIDTH - LEFT - RIGHT) / len(columns))
    width, height = cell * len(columns), min(CELL, max(cell, 0.3)) * len(lines)
    figure = Figure(figsize=(LEFT + width + RIGHT, BOTTOM + height + TOP))
    axes = figure.add_axes([LEFT / figure.get_figwidth(), BOTTOM / figure.get_figheight(),
                            width / figure.get_figwidth(), height / figure.get_figheight()])
    values = {place: value_of(row, colour) for place, row in grid.items()}
    words = list(dict.fromkeys(value for value in values.values() if isinstance(value, str)))
    _colour_words(axes, values, words) if words else _colour_numbers(figure, axes, grid, values, colour)
    for (i, j), row in grid.items():
        if not succeeded(row):
            axes.plot([i - 0.5, i + 0.5], [j - 0.5, j + 0.5], [i - 0.5, i + 0.5], [j + 0.5, j - 0.5], color="0.35",
                      linewidth=0.7, gid="failed")
    axes.set_xlim(-0.5, len(columns) - 0.5)
    axes.set_ylim(-0.5, len(lines) - 0.5)
    axes.set_xticks(range(len(columns)), [written(value) for value in columns])
    axes.set_yticks(range(len(lines)), [written(value) for value in lines])
    axes.tick_params(length=0)
    axes.set_xlabel(label_of(x))
    axes.set_ylabel(label_of(y))
    axes.set_title(colour if not where else f"{colour}, {', '.join(where)}", pad=4)
    return figure


def _square(axes, place, colour):
    axes.add_patch(matplotlib.patches.Rectangle((place[0] - 0.5, place[1] - 0.5), 1, 1, facecolor=colour,
                                                edgecolor="white", linewidth=0.6))


def _colour_words(axes, values, words):
    palette = (style.SKY_BLUE, style.ORANGE, style.GREEN, style.PURPLE, style.BLUE, style.VERMILLION)
    colours = {word: palette[i % len(palette)] for i, word in enumerate(words)}
    for place, value in values.items():
        _square(axes, place, colours.get(value, "white"))
    axes.legend([Patch(facecolor=colours[word]) for word in words], words, loc="upper left", bbox_to_anchor=(1.0, 1.0),
                handlelength=1)


def _colour_numbers(figure, axes, grid, values, name):
    """Viridis from the smallest to the largest number, over logarithms where these differ by more than 30 times."""
    good = [value for place, value in values.items() if is_number(value) and has_series(grid[place])]
    low, high = (min(good), max(good)) if good else (0, 1)
    if low == high:
        low, high = low - 0.5 * (abs(low) or 1), high + 0.5 * (abs(high) or 1)
    scale = matplotlib.colors.LogNorm if low > 0 and high > 30 * low else matplotlib.colors.Normalize
    colours = matplotlib.cm.ScalarMappable(scale(low, high), "viridis")
    for place, value in values.items():
        shown = is_number(value) and has_series(grid[place])
        colour = colours.to_rgba(value) if shown else (0.9, 0.9, 0.9, 1)
        _square(axes, place, colour)
        if shown and len(values) <= MOST_WRITTEN:
            light = 0.299 * colour[0] + 0.587 * colour[1] + 0.114 * colour[2] > 0.5
            axes.text(*place, three_digits(value), ha="center", va="center", fontsize=7, color="black" if light else "white")
    box = axes.get_position()
    bar = figure.add_axes([box.x1 + 0.1 / figure.get_figwidth(), box.y0, BAR / figure.get_figwidth(), box.height])
    figure.colorbar(colours, cax=bar)
    bar.set_gid(f"colours of {name}")


def main():
    parser = parser_of(__doc__)
    parser.add_argument("table", help="FOLDER/table.json of evolve --set")
    parser.add_argument("--x", required=True, metavar="NAME", help="the horizontal axis")
    parser.add_argument("--y", required=True, metavar="NAME", help="the vertical axis")
    parser.add_argument("--colour", required=True, metavar="NAME", help="what is drawn")
    parser.add_argument("--where", action="append", default=[], metavar="NAME=VALUE",
                        help="only rows with this value; needed when more than two keys vary")
    parser.add_argument("--output", metavar="STEM", help="writes STEM.pdf and STEM.png (default: FOLDER/sweep)")
    arguments = parser.parse_args()
    try:
        table = read_table(arguments.table, "evolve", has_series)
        figure = phase_diagram(table, arguments.x, arguments.y, arguments.colour, arguments.where)
        style.save(figure, arguments.output or os.path.join(os.path.dirname(arguments.table), "sweep"))
    except TableError as error:
        sys.exit(f"{parser.prog}: {arguments.table}: {error}")
    except OSError as error:
        sys.exit(f"{parser.prog}: {error.filename}: {error.strerror}")


if __name__ == "__main__":
    main()
