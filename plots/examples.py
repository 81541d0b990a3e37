# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the example configurations: the surface at some times, coloured by a nodal field.

Usage: python3 plots/examples.py BUILD/samples DOCS
Writes DOCS/example_NAME.png for each of EXAMPLES from the snapshots of `make samples`.
"""
import os
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

import style
from report_html import small_png
from snapshots import Strip, evenly
from surfaces import view
from table import TableError

PICTURES = 4  # at most
WIDTH = 1000  # pixels
# name -> nodal field (None: the surface with its elements), its label, and the view
EXAMPLES = {
    "genus2": (None, "", view(90, 15, up=3)),
    "turing": ("u1", "$u_1$", view(20, 35, up=3)),
    "brusselator": ("u1", "$u_1$", view(-65, 20, up=3)),
    "fitzhugh_nagumo": ("u1", "$u_1$", view(-65, 20, up=3)),
    "gray_scott": ("u2", "$u_2$", view(20, 20, up=3)),
    "vesicle": ("H", "$H$", view(20, 35, up=3)),
    "swimmer": ("u", "$u$", view(-75, 60, up=3)),
}


def snapshots(collection):
    """[(t, path)] of a ParaView collection (.pvd). Raises TableError when it cannot be read."""
    try:
        entries = ElementTree.parse(collection).getroot().iter("DataSet")
        return [(float(entry.get("timestep")), os.path.join(os.path.dirname(collection), entry.get("file")))
                for entry in entries]
    except (OSError, ElementTree.ParseError, TypeError, ValueError) as error:
        raise TableError(f"{collection}: no collection of snapshots ({error}); run make samples") from error


def time_label(t):
    return f"$t = {t:.4g}$"


def picture(files, field, label, rotation):
    """The surfaces side by side, in one scale of lengths and one of colours."""
    strip = Strip(evenly(files, PICTURES), rotation, (0.87 if field else 0.97) * style.WIDTH)
    height = strip.height + 0.1
    figure = Figure(figsize=(style.WIDTH, height))
    if field is None:
        strip.draw(figure, 0.03, 0.05, facets_per_side=3, label=time_label)
        return figure
    values = np.concatenate([surface.data[field] for surface in strip.surfaces[1:]])
    mappable = ScalarMappable(Normalize(values.min(), values.max()), "viridis")
    strip.draw(figure, 0.03, 0.05, facets_per_side=2, linewidth=0, label=time_label,
               colours=lambda surface: (surface.data[field], mappable))
    middle = (0.05 + strip.height - strip.pictures / 2) / height
    bar = figure.add_axes([0.905, middle - 0.42 * strip.pictures / height, 0.013, 0.84 * strip.pictures / height])
    figure.colorbar(mappable, cax=bar).set_label(label)
    return figure


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    samples, docs = sys.argv[1:]
    try:
        for name, (field, label, rotation) in EXAMPLES.items():
            figure = picture(snapshots(os.path.join(samples, name, name, "surfaces.pvd")), field, label, rotation)
            with tempfile.NamedTemporaryFile(suffix=".png") as large:
                figure.savefig(large.name, dpi=2 * WIDTH / style.WIDTH)
                with open(os.path.join(docs, f"example_{name}.png"), "wb") as file:
                    file.write(small_png(large.name, WIDTH))
    except (TableError, OSError) as error:
        sys.exit(f"{os.path.basename(sys.argv[0])}: {error}")


if __name__ == "__main__":
    main()
