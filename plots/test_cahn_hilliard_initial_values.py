# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of cahn_hilliard_initial_values.py."""
import os
import pathlib
import tempfile
import unittest

import meshio
import numpy as np

import cahn_hilliard_initial_values
from table import SCHEMA, TableError
from testing import run_script, sphere, texts_of

TIMES = (0, 1, 2, 3, 5)


def run_row(scheme, **changes):
    row = {"cell": f"{scheme}_unit_h2_tau0", "labels": {"initial": scheme, "constant": "unit"}, "level": 2, "h": 0.4,
           "nodes": 4098, "tau": 0.0125, "steps": 400, "status": "ok", "errors": {},
           "series": {"t": [0, 5], "energy": [1, 0]},
           "snapshots": [{"t": t, "file": f"surfaces_{i:04d}.vtu"} for i, t in enumerate(TIMES)]}
    return {**row, **changes}


def table_of(rows):
    return {"schema": SCHEMA, "experiment": "cahn_hilliard_initial_values", "paper": "bk22",
            "parameters": {"epsilon": 0.5}, "rows": rows}


def write_snapshots(folder, cell):
    ball = sphere(1)
    target = pathlib.Path(folder, "cells/cahn_hilliard_initial_values", cell)
    target.mkdir(parents=True)
    for i, t in enumerate(TIMES):
        u = np.clip(ball.points[:, 0] + 0.1 * t * ball.points[:, 2], -0.8, 0.8)
        meshio.Mesh(5 * ball.points, [("triangle", ball.triangles[:, :3])], point_data={"u": u}).write(
            target / f"surfaces_{i:04d}.vtu")


class InitialValues(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = cls.temporary.name
        for scheme in cahn_hilliard_initial_values.SCHEMES:
            write_snapshots(cls.folder, run_row(scheme)["cell"])

    def figure(self, rows):
        (name, figure), = cahn_hilliard_initial_values.draw(table_of(rows), self.folder)
        self.assertEqual(name, "bk22/fig8")
        return figure

    def test_two_columns_five_rows_one_scale_one_bar(self):
        figure = self.figure([run_row("ritz_theta"), run_row("interpolation")])
        *pictures, bar = figure.axes
        self.assertEqual(len(pictures), 10)
        self.assertTrue(all(axes.collections for axes in pictures))
        scales = [axes.get_position().width / np.ptp(axes.get_xlim()) for axes in pictures]
        np.testing.assert_allclose(scales, scales[0])
        np.testing.assert_allclose(bar.get_xlim(), (-0.8, 0.8))  # white is u = 0
        self.assertLess(bar.get_position().y1, min(axes.get_position().y0 for axes in pictures))
        texts = texts_of(figure)
        for text in ("$N = 4{,}098$", r"$\varepsilon = 0.5$", *(f"$t = {t}$" for t in TIMES)):
            self.assertIn(text, texts)
        self.assertLess(texts.index("interpolation, (3.12)"), texts.index("Ritz map"))

    def test_the_finest_mesh_with_both_schemes_is_drawn(self):
        finer = run_row("ritz_theta", cell="finer", nodes=16386)
        others = [run_row("ritz", cell="ritz"), run_row("interpolation", cell="printed", constant="printed")]
        rows = [finer, *others, run_row("ritz_theta"), run_row("interpolation")]
        self.assertEqual(len(self.figure(rows).axes), 11)
        failed = run_row("ritz_theta", status="failed: why", snapshots=[], cell="lost")
        figure = self.figure([failed, run_row("interpolation")])
        self.assertEqual(len(figure.axes), 6)
        self.assertIn(r"1 of 2 runs failed: $N = 4{,}098$ with $\tau$ = 0.0125.", texts_of(figure))

    def test_what_is_missing_is_named(self):
        printed = {"initial": "interpolation", "constant": "printed"}
        for row in (run_row("ritz"), run_row("interpolation", snapshots=[]), run_row("interpolation", labels=printed)):
            with self.assertRaisesRegex(TableError, "no snapshots of the schemes interpolation and ritz_theta"):
                self.figure([row])
        with self.assertRaisesRegex(TableError, "cells/cahn_hilliard_initial_values/lost/.*vtu: no such snapshot"):
            self.figure([run_row("interpolation", cell="lost")])

    def test_the_script_writes_files(self):
        result = run_script("cahn_hilliard_initial_values", table_of([run_row("interpolation")]), self.folder)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        self.assertEqual(sorted(os.listdir(self.folder + "/figures/bk22")), ["fig8.pdf", "fig8.png"])


if __name__ == "__main__":
    unittest.main()
