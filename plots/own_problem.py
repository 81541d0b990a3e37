# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapshots of a run of evolve side by side, coloured by one of its fields.

Usage: python3 plots/own_problem.py RUN.pvd FIELD OUTPUT.png      for example build/turing/surfaces.pvd u1 turing.png
"""
import os
import sys
import xml.etree.ElementTree

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

import style
from snapshots import Strip, evenly
from surfaces import view
from table import TableError

SHOWN = 4


def files_of(collection):
    """[(t, path)] of a PVD collection."""
    try:
        entries = xml.etree.ElementTree.parse(collection).getroot().iter("DataSet")
        return [(float(entry.get("timestep")), os.path.join(os.path.dirname(collection), entry.get("file"))) for entry in entries]
    except (xml.etree.ElementTree.ParseError, TypeError, ValueError) as error:
        raise TableError(f"{collection}: no PVD collection: {error}") from error


def figure_of(files, field):
    """The figure of at most SHOWN of the snapshots."""
    strip = Strip(evenly(files, SHOWN), view(30, 40), 0.87 * style.WIDTH)
    for surface in strip.surfaces:
        if field not in surface.data:
            raise TableError(f"no field {field}; there are {', '.join(sorted(surface.data))}")
    values = np.concatenate([surface.data[field] for surface in strip.surfaces[1:] or strip.surfaces])
    mappable = ScalarMappable(Normalize(values.min(), values.max()), "viridis")
    figure = Figure(figsize=(style.WIDTH, strip.height + 0.1))
    strip.draw(figure, 0.03, 0.05, facets_per_side=2, linewidth=0.12, colours=lambda surface: (surface.data[field], mappable))
    middle = (0.05 + strip.height - strip.pictures / 2) / figure.get_figheight()
    bar = figure.add_axes([0.905, middle - 0.42 * strip.pictures / figure.get_figheight(), 0.013,
                           0.84 * strip.pictures / figure.get_figheight()])
    figure.colorbar(mappable, cax=bar).set_label(field)
    return figure


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__.strip())
    collection, field, output = sys.argv[1:]
    try:
        figure_of(files_of(collection), field).savefig(output, dpi=200)
    except (TableError, OSError) as error:
        sys.exit(f"{os.path.basename(sys.argv[0])}: {error}")


if __name__ == "__main__":
    main()
