# SPDX-License-Identifier: GPL-3.0-or-later
"""Willmore flow by three schemes: Kovács, Li, Lubich (2021), Dziuk (2008), and Barrett, Garcke, Nürnberg (2008).

Usage: python3 plots/willmore_competitors.py results/paper/willmore_competitors.json figures
Writes figures/gallery/willmore_competitors.{pdf,png}: errors of the surface over time where the exact solution is known,
and how far the energy is from its limit.
"""
import numpy as np
from matplotlib import ticker

import style
import time_series
from convergence import NORMS_AT_A_TIME
from script import run
from table import TableError, has_series, label_of, series
from willmore import finest, from_limit, limit_of

ERROR = "x_nodal_H1"
SURFACES = {"sphere": "sphere", "clifford_torus": "Clifford torus", "ellipsoid": "ellipsoid"}
# Thinner lines lie on top: lines that coincide all show.
SCHEMES = {"willmore": ("KLL", style.BLUE, 1.9), "dziuk_willmore": ("Dziuk", style.VERMILLION, 3.4),
           "bgn_willmore": ("BGN", style.PURPLE, 0.8)}
DEGREES = {2: ("quadratic", style.DASHES["solid"]), 1: ("linear", style.DASHES["dashed"])}
# The energy of the discrete surface is the same functional for all schemes; W(H_h) is of a scheme's own H_h.
ENERGIES = ("kappa_energy", "willmore_energy")


def draw(table, folder):
    """Yields (name, figure). TableError when there is nothing to show; `folder` is not needed."""
    rows = [row for row in table["rows"] if label_of(row, "flow") in SCHEMES
            and label_of(row, "surface") in SURFACES and label_of(row, "degree") in DEGREES]
    runs = {}
    for row in filter(has_series, rows):
        runs.setdefault(tuple(label_of(row, name) for name in ("surface", "flow", "degree")), []).append(row)
    runs = {key: finest(runs[key]) for key in sorted(runs, key=_order)}
    errors = {surface: _of(runs, surface, ERROR) for surface in SURFACES}
    energies = {surface: _of(runs, surface, *ENERGIES) for surface in SURFACES}
    panels = [[surface for surface in SURFACES if found[surface]] for found in (errors, energies)]
    if not any(panels):
        raise TableError(f"no series {ERROR}, {', '.join(ENERGIES)} of {', '.join(SURFACES)}")
    yield "gallery/willmore_competitors", _figure(panels, errors, energies, _notes(runs, rows))


def _order(key):
    surface, scheme, degree = key
    return list(SURFACES).index(surface), list(SCHEMES).index(scheme), list(DEGREES).index(degree)


def _of(runs, surface, *names):
    """{(scheme, degree): (row, name of its series)} of the runs with one of these series, the first that they have."""
    found = {}
    for (of, *variant), row in runs.items():
        name = next((name for name in names if series(row, name)), None)
        if of == surface and name:
            found[tuple(variant)] = row, name
    return found


def _line(scheme, degree):
    return {"color": SCHEMES[scheme][1], "linestyle": DEGREES[degree][1], "linewidth": SCHEMES[scheme][2],
            "zorder": 2 - 0.1 * SCHEMES[scheme][2]}


def _label(scheme, degree):
    return f"{SCHEMES[scheme][0]}, {DEGREES[degree][0]}"


def _figure(panels, errors, energies, notes):
    variants = {variant for found in (errors, energies) for of_surface in found.values() for variant in of_surface}
    legend = {_label(*variant): _line(*variant) for variant in sorted(variants, key=lambda v: _order(("sphere", *v)))}
    headings = [[SURFACES[surface] for surface in panels[0]],
                [f"{SURFACES[surface]}, $W^* = {limit_of(surface)[1].strip('$')}$" for surface in panels[1]]]
    figure, grid = time_series.panels([texts for texts in headings if texts], legend, notes)
    labels = [f"error of $x$ in {NORMS_AT_A_TIME[ERROR.removeprefix('x_')]}", r"$|W(\kappa_h) - W^*|$"]
    for found, surfaces, label, axes_row in zip((errors, energies), panels, labels, _aligned(grid, panels)):
        for i, (surface, axes) in enumerate(zip(surfaces, axes_row)):
            values, end = [], 0
            change = time_series.positive if found is errors else from_limit(limit_of(surface))
            for variant, (row, name) in found[surface].items():
                values.append(time_series.draw_series(axes, row, name, _line(*variant), (0, np.inf), change))
                end = max(end, max(row["series"]["t"]))
            time_series.scale(axes, np.concatenate(values), logarithmic=True)
            axes.set_xlim(0, end or 1)
            # A label at the very end would be cut off.
            axes.xaxis.set_major_locator(ticker.MaxNLocator(4, steps=[1, 2, 5, 10], prune="upper"))
            if i == 0:
                axes.set_ylabel(label, labelpad=2)
    return figure


def _aligned(grid, panels):
    """The rows of the grid for the rows of `panels`, an empty row having none."""
    rows = iter(grid)
    return [next(rows) if surfaces else [] for surfaces in panels]


def _which(variants, every):
    """Which of `every` (scheme, degree) these are, as short as can be said."""
    if len(variants) == len(every):
        return ""
    for part, names in ((1, DEGREES), (0, SCHEMES)):
        kinds = {variant[part] for variant in variants}
        if len(variants) == sum(variant[part] in kinds for variant in every):
            return f" ({', '.join(name for key, (name, *_) in names.items() if key in kinds)})"
    return f" ({'; '.join(_label(*variant) for variant in variants)})"


def _number(tau):
    return f"{tau:.3g}" if tau >= 1e-4 else style.power_of_ten(tau).strip("$")


def _notes(runs, rows):
    """Mesh and step size of the runs, what the energies are, and which runs are missing."""
    notes = []
    for surface in SURFACES:
        settings = {}
        for (of, *variant), row in runs.items():
            if of == surface:
                setting = rf"{style.nodes_label(row['nodes'])}, $\tau = {_number(row['tau'])}$"
                settings.setdefault(setting, []).append(tuple(variant))
        if settings:
            every = [variant for variants in settings.values() for variant in variants]
            texts = [setting + _which(variants, every) for setting, variants in settings.items()]
            name = SURFACES[surface]
            notes.append(f"{name[0].upper()}{name[1:]}: {'; '.join(texts)}.")
    own = [_label(scheme, degree) for surface in SURFACES
           for (scheme, degree), (_, name) in _of(runs, surface, *ENERGIES).items() if name != ENERGIES[0]]
    if own:
        notes.append(f"With the scheme's own $H_h$ in place of $\\kappa_h$: {'; '.join(dict.fromkeys(own))}.")
    return ([line for note in notes for line in style.wrap(note)] + time_series.stopped_notes(runs.values(), _name)
            + time_series.failure_notes(rows, _name))


def _name(row):
    return f"{SURFACES[label_of(row, 'surface')]}, {_label(label_of(row, 'flow'), label_of(row, 'degree'))}"


if __name__ == "__main__":
    run("willmore_competitors", draw, __doc__)
