# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of willmore_projection.py."""
import os
import tempfile
import unittest

import numpy as np

import willmore_projection
from table import SCHEMA, TableError
from testing import lines_of, run_script

LABELS = {"flow": "willmore", "F": "extrapolated", "mesh_of": "icosphere", "degree": 2, "bdf": 2, "radius": 1.0}


def projection_row(run, projection, tau, **changes):
    """An error of order q, or of 0.3 with projections after each step; |nu_h| - 1 of the equation for a sphere."""
    labels = LABELS | {"run": run, "projection": projection} | changes
    row = {"cell": f"{run}_{projection}_{tau}_{labels['bdf']}_{labels['radius']}_{labels['F']}", "labels": labels, "level": 0, "h": 1.0,
           "nodes": 162, "tau": tau, "steps": 4, "status": "ok", "errors": {}, "series": {}}
    error = 1e-3 * tau ** (0.3 if projection == "projected" else labels["bdf"])
    if run == "length":
        t = np.linspace(0, 0.5 * labels["radius"] ** 4, 21)
        rate = {"none": 8, "coefficients": -4}[projection] / labels["radius"] ** 4
        row["series"] = {"t": t.tolist(), "nu_excess": (1e-3 * np.exp(rate * t)).tolist()}
    else:
        row["errors"] = {"u": {"nodal_L2": error}, "x": {"nodal_H1": error, "nodal_L2": error}}
    return row


def projection_table():
    rows = [projection_row("order", projection, tau, bdf=bdf) for projection in willmore_projection.PROJECTIONS
            for bdf in (1, 2, 3) for tau in (0.02, 0.01, 0.005)]
    rows += [projection_row("sphere", projection, tau) for projection in willmore_projection.PROJECTIONS for tau in (0.1, 0.05)]
    rows += [projection_row("length", projection, 0.01, radius=radius) for projection in ("none", "coefficients")
             for radius in (1.0, 1.5)]
    rows.append(projection_row("order", "none", 0.01, F="implicit"))
    return {"schema": SCHEMA, "experiment": "willmore_projection", "paper": "kll21", "parameters": {}, "rows": rows}


class Projection(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.table = projection_table()
        cls.figures = dict(willmore_projection.draw(cls.table, ""))

    def test_a_panel_for_each_method_and_one_for_the_sphere(self):
        figure = self.figures["gallery/willmore_projection"]
        titles = [axes.get_title() for axes in figure.axes]
        self.assertEqual([title.rsplit(" ", 1)[-1] for title in titles], ["BDF1", "BDF2", "BDF3", "BDF2"])
        self.assertIn("sphere", titles[-1])
        self.assertEqual({text.get_text() for text in figure.legends[0].get_texts()}, set(willmore_projection.PROJECTIONS.values()))

    def test_runs_of_other_variants_are_left_out(self):
        axes = self.figures["gallery/willmore_projection"].axes[1]
        self.assertEqual([len(line.get_xdata()) for line in lines_of(axes)][:3], [3, 3, 3])

    def test_lengths_over_scaled_time(self):
        axes, = self.figures["gallery/willmore_projection_length"].axes
        drawn = [line for line in axes.lines if len(line.get_xdata()) == 21]
        self.assertEqual(len(drawn), 4)
        for line in drawn:
            self.assertAlmostEqual(line.get_xdata()[-1], 0.5)
        self.assertAlmostEqual(drawn[0].get_ydata()[-1], np.exp(4))

    def test_what_is_missing_is_left_out_and_nothing_is_an_error(self):
        lengths = [row for row in self.table["rows"] if row["labels"]["run"] == "length"]
        self.assertEqual([name for name, _ in willmore_projection.draw({"rows": lengths}, "")], ["gallery/willmore_projection_length"])
        with self.assertRaises(TableError):
            list(willmore_projection.draw({"rows": [projection_row("other", "none", 1)]}, ""))

    def test_script(self):
        with tempfile.TemporaryDirectory() as folder:
            done = run_script("willmore_projection", self.table, folder)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            for name in self.figures:
                self.assertTrue(os.path.getsize(os.path.join(folder, "figures", name + ".pdf")))


if __name__ == "__main__":
    unittest.main()
