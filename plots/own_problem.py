# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapshots of a run of evolve side by side, coloured by one of its fields, a vector field by its length.

Usage: /usr/bin/python3 plots/own_problem.py RUN.pvd [FIELD OUTPUT.png] [--times 0,0.1,0.5]
For example: /usr/bin/python3 plots/own_problem.py build/turing/surfaces.pvd u1 turing.png
Without FIELD: lists the fields of the file. Without --times the pictures are nearest to four equally spaced times.
"""
import os
import sys
import xml.etree.ElementTree

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

import style
from script import parser_of
from snapshots import Strip
from surfaces import read_surface, view
from table import TableError

SHOWN = 4
LEFT, BOTTOM, MARGIN = 0.03, 0.05, 0.03  # inches
BAR_GAP, BAR_WIDTH = 0.12, 0.09


def files_of(collection):
    """[(t, path)] of a PVD collection, in the order of time."""
    try:
        entries = xml.etree.ElementTree.parse(collection).getroot().iter("DataSet")
        files = [(float(entry.get("timestep")), os.path.join(os.path.dirname(collection), entry.get("file"))) for entry in entries]
    except (xml.etree.ElementTree.ParseError, TypeError, ValueError) as error:
        raise TableError(f"{collection}: no PVD collection: {error}") from error
    if not files:
        raise TableError(f"{collection}: no snapshots in it")
    return sorted(files, key=lambda file: file[0])


def nearest(files, times):
    """The snapshots nearest to these times, each once, in the order of time."""
    chosen = {min(range(len(files)), key=lambda i: abs(files[i][0] - t)) for t in times}
    return [files[i] for i in sorted(chosen)]


def equal_times(files):
    return np.linspace(files[0][0], files[-1][0], SHOWN)


def numbers_of(surface, field):
    """Nodal values (N,): those of a scalar field, the lengths of a vector field. Raises TableError."""
    if field not in surface.data:
        raise TableError(f"no field {field}; there are {', '.join(sorted(surface.data))}")
    values = np.asarray(surface.data[field], float)
    return values if values.ndim == 1 else np.linalg.norm(values, axis=1)


def names_of(surface):
    """A line for each field."""
    return [name + (" (vectors, drawn by their lengths)" if np.ndim(values) > 1 else "")
            for name, values in sorted(surface.data.items())]


def figure_of(files, field):
    """The figure of these snapshots. To be saved with bbox_inches="tight": few pictures are narrower than a page."""
    strip = Strip(files, view(30, 40), 0.87 * style.WIDTH)
    values = np.concatenate([numbers_of(surface, field) for surface in strip.surfaces])
    mappable = ScalarMappable(Normalize(values.min(), values.max()), "viridis")
    figure = Figure(figsize=(style.WIDTH, strip.height + 0.1))
    width, height = figure.get_size_inches()
    strip.draw(figure, LEFT - strip.left, BOTTOM, facets_per_side=2, linewidth=0.12,
               colours=lambda surface: (numbers_of(surface, field), mappable))
    right = LEFT + 0.87 * style.WIDTH - 2 * strip.left
    middle = BOTTOM + strip.height - strip.pictures / 2
    bar = figure.add_axes([(right + BAR_GAP) / width, (middle - 0.42 * strip.pictures) / height, BAR_WIDTH / width,
                           0.84 * strip.pictures / height])
    figure.colorbar(mappable, cax=bar).set_label(f"|{field}|" if np.ndim(strip.surfaces[0].data[field]) > 1 else field)
    return figure


def times_of(text):
    """The numbers of --times. Raises TableError."""
    try:
        return [float(word) for word in text.split(",")]
    except ValueError as error:
        raise TableError(f"--times {text}: expected numbers with commas between them, such as 0,0.1,0.5") from error


def main():
    parser = parser_of(__doc__)
    parser.add_argument("collection", metavar="RUN.pvd", help="the snapshots of a run")
    parser.add_argument("field", metavar="FIELD", nargs="?", help="what colours show; without it the fields are listed")
    parser.add_argument("output", metavar="OUTPUT.png", nargs="?", help="the picture; its folder is created")
    parser.add_argument("--times", metavar="T,T,..", help="the pictures are the snapshots nearest to these times")
    arguments = parser.parse_args()
    if arguments.field and not arguments.output:
        parser.error(f"expected OUTPUT.png after the field {arguments.field}")
    try:
        files = files_of(arguments.collection)
        if not arguments.field:
            print("\n".join(names_of(read_surface(files[-1][1]))))
            return
        times = times_of(arguments.times) if arguments.times else equal_times(files)
        chosen = nearest(files, times)
        if arguments.times and len(chosen) < len(times):
            print(f"{parser.prog}: pictures: {len(chosen)} instead of {len(times)}; the times of {arguments.collection} are "
                  + ", ".join(f"{t:g}" for t, _ in files), file=sys.stderr)
        figure = figure_of(chosen, arguments.field)
        os.makedirs(os.path.dirname(os.path.abspath(arguments.output)), exist_ok=True)
        try:
            figure.savefig(arguments.output, dpi=200, bbox_inches="tight", pad_inches=MARGIN)
        except ValueError as error:  # a kind of file that matplotlib does not write
            raise TableError(f"{arguments.output}: {error}") from error
    except TableError as error:
        sys.exit(f"{parser.prog}: {error}")
    except OSError as error:
        sys.exit(f"{parser.prog}: {error.filename}: {error.strerror}")


if __name__ == "__main__":
    main()
