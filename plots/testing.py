# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of several modules share: synthetic tables and surfaces, and what a figure shows."""
import contextlib
import functools
import io
import json
import os
import runpy
import subprocess
import sys
import unittest.mock

import meshio
import numpy as np

import mcf_sphere
from surfaces import Surface
from table import SCHEMA

FOLDER = os.path.dirname(os.path.abspath(__file__))


def synthetic_table(widths=(0.49, 0.35, 0.245, 0.173, 0.123), exponents=range(8)):
    """A table like that of mcf_sphere: tau^3 and h^3 in x and v, no tau in nu, h^4 in H."""
    rows = []
    for level, h in enumerate(widths):
        for k in exponents:
            tau = 0.2 * 2.0**-k
            time, space = 3e-2 * (tau / 0.2)**3, (h / 0.49)**3
            errors = {"x": time + 1.5e-3 * space, "v": 10 * time + 4e-3 * space, "nu": 6.5e-4 * space,
                      "H": 0.02 * time + 1.8e-4 * space * h / 0.49}
            rows.append({"cell": f"h{level}_tau{k}", "level": level, "h": h, "nodes": round(2562 * (0.49 / h)**2),
                         "tau": tau, "steps": 3 * 2**k, "status": "ok",
                         "errors": {q: {"nodal_H1": e, "lifted_H1": 1.1 * e} for q, e in errors.items()}})
    return {"schema": SCHEMA, "experiment": "mcf_sphere", "paper": "kll19", "parameters": {}, "rows": rows}


@functools.cache
def sphere_figures():
    """The figures of mcf_sphere from the synthetic table; tests look at them only."""
    return dict(mcf_sphere.draw(synthetic_table(), "nodal_H1"))


def run_script(stem, table, folder, *options):
    """Runs plots/STEM.py: `folder`/table.json -> `folder`/figures. In this process, which has matplotlib already.

    `table`: a table, or the text of the file. Returns returncode, stdout and stderr, as a process has them.
    """
    script, *arguments = _command(stem, table, folder, options)
    said, complained, code = io.StringIO(), io.StringIO(), 0
    with unittest.mock.patch("sys.argv", [script, *arguments]), contextlib.redirect_stdout(said), \
            contextlib.redirect_stderr(complained):
        try:
            runpy.run_path(script, run_name="__main__")
        except SystemExit as end:  # the interpreter prints a text, and exits with 1
            code = end.code if isinstance(end.code, int) else int(end.code is not None)
            if isinstance(end.code, str):
                print(end.code, file=sys.stderr)
    return subprocess.CompletedProcess([script, *arguments], code, said.getvalue(), complained.getvalue())


def run_process(stem, table, folder, *options):
    """The same as a process of its own, with its own random hashes."""
    command = [sys.executable, *_command(stem, table, folder, options)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def _command(stem, table, folder, options):
    path = os.path.join(folder, "table.json")
    with open(path, "w", encoding="utf-8") as file:
        file.write(table if isinstance(table, str) else json.dumps(table))
    return [os.path.join(FOLDER, f"{stem}.py"), path, os.path.join(folder, "figures"), *options]


def figure_named(name, figures):
    """Of what `draw` yields; figures that come after it are not drawn."""
    return next(figure for found, figure in figures if found == name)


def data_lines(axes):
    return [line for line in axes.lines if len(line.get_xdata()) and not (line.get_gid() or "").startswith("limit")
            and not is_reference(line)]


def is_reference(line):
    return (line.get_gid() or "").startswith("reference")


def texts_of(figure):
    """What the figure says outside of its axes."""
    return " ".join(text.get_text() for text in figure.texts)


def references(axes):
    return [line for line in axes.lines if is_reference(line)]


def slopes_of(figure):
    """What the reference lines of each panel name."""
    return [[line.get_gid().removeprefix("reference ") for line in references(axes)] for axes in figure.axes]


def exponents_to_points(axes, line):
    """A line of the panel in log10 of its data coordinates."""
    to_data = line.get_transform() + axes.transData.inverted()
    return np.log10(to_data.transform(np.array(line.get_data()).T))


def lines_of(axes):
    return [line for line in axes.lines if len(line.get_xdata()) > 2]


def sphere(subdivisions, centre=(0, 0, 0)):
    """A quadratic surface with all nodes on a unit sphere, outward."""
    corners = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
    points = list(corners)
    triangles = [(i, j, k) for i in (0, 1) for j in (2, 3) for k in (4, 5)]
    triangles = [(i, j, k) if np.linalg.det(corners[[i, j, k]]) > 0 else (i, k, j) for i, j, k in triangles]
    for level in range(subdivisions + 1):
        middles = {}

        def middle(i, j, middles=middles):
            key = min(i, j), max(i, j)
            if key not in middles:
                middles[key] = len(points)
                points.append((points[i] + points[j]) / np.linalg.norm(points[i] + points[j]))
            return middles[key]

        quadratic = [(i, j, k, middle(i, j), middle(j, k), middle(k, i)) for i, j, k in triangles]
        if level < subdivisions:
            triangles = [t for i, j, k, a, b, c in quadratic for t in ((i, a, c), (a, j, b), (c, b, k), (a, b, c))]
    return Surface(np.array(points) + centre, np.array(quadratic), {})


def write_surface(path, surface):
    """A snapshot as the experiments write it."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    meshio.write(path, meshio.Mesh(surface.points, [("triangle6", surface.triangles)]))


def limits_of(axes):
    """Heights of the dashed lines that mark limits."""
    return [line.get_ydata()[0] for line in axes.lines if (line.get_gid() or "").startswith("limit")]
