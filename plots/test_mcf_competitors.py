# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of mcf_competitors.py."""
import os
import tempfile
import unittest

import mcf_competitors
from table import SCHEMA, TableError, label_of
from testing import run_script, texts_of

VARIANTS = (("mean_curvature", 2, 3), ("dziuk", 2, 3), ("dziuk", 2, 1), ("bgn", 2, 1), ("bgn", 1, 1))


def competitor_row(surface, variant, level, k, **changes):
    flow, degree, bdf = variant
    seconds = {"mean_curvature": 2, "dziuk": 1, "bgn": 40}[flow] * 0.01 * 2**(level + k)
    error = 0.1 * 2.0**(-bdf * k) + 0.01 * 2.0**(-1.5 * level)
    return {"cell": f"{surface}_{flow}_p{degree}_bdf{bdf}_h{level}_tau{k}",
            "labels": {"surface": surface, "flow": flow, "degree": degree, "bdf": bdf}, "level": level,
            "h": 0.5 * 2**(-level / 2), "nodes": 1000 * 2**level, "tau": 0.05 / 2**k, "steps": 12 * 2**k, "status": "ok",
            "errors": {"x": {"nodal_L2": error, "nodal_H1": 3 * error}},
            "values": {"seconds_of_steps": seconds, "distance": error / 5}, **changes}


def competitors_table():
    rows = [competitor_row(surface, variant, level, k) for surface in mcf_competitors.SURFACES for variant in VARIANTS
            for level in range(2) for k in range(3)]
    return {"schema": SCHEMA, "experiment": "mcf_competitors", "paper": "esfem", "parameters": {}, "rows": rows}


def draw(rows, norm="nodal_L2"):
    (name, figure), = mcf_competitors.draw({"rows": rows}, norm)
    assert name == "gallery/mcf_competitors", name
    return figure


class Competitors(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.table = competitors_table()
        cls.figure = draw(cls.table["rows"])

    def test_all_runs_are_marked_and_the_best_are_joined(self):
        self.assertEqual(len(self.figure.axes), 4)
        for axes in self.figure.axes:
            self.assertEqual((axes.get_xscale(), axes.get_yscale()), ("log", "log"))
            lines = [line for line in axes.lines if len(line.get_xdata())]
            marks, joined = lines[::2], lines[1::2]
            self.assertEqual([len(line.get_xdata()) for line in marks], [6] * len(VARIANTS))
            self.assertEqual({line.get_linestyle() for line in marks}, {"None"})
            for all_runs, best in zip(marks, joined):
                self.assertLessEqual(len(best.get_xdata()), 6)
                self.assertEqual(min(best.get_ydata()), min(all_runs.get_ydata()))

    def test_the_frontier_has_what_no_other_run_beats(self):
        points = [(2, 1), (1, 3), (3, 2), (4, 0.5), (2, 5)]
        self.assertEqual(mcf_competitors.frontier(points), [(1, 3), (2, 1), (4, 0.5)])
        self.assertEqual(mcf_competitors.frontier([]), [])

    def test_schemes_have_colours_and_methods_have_dashes(self):
        legend = self.figure.legends[0]
        colours = {}
        for text, line in zip(legend.get_texts(), legend.get_lines()):
            colours.setdefault(text.get_text().split(",")[0], set()).add(line.get_color())
        self.assertEqual({name: len(of) for name, of in colours.items()}, {"(5.1)": 1, "Dziuk": 1, "BGN": 1})
        self.assertEqual(len(legend.get_texts()), len(VARIANTS))

    def test_the_norm_is_the_one_asked_for(self):
        self.assertIn("H^1", draw(self.table["rows"], "nodal_H1").axes[0].get_ylabel())

    def test_failed_runs_are_counted_and_a_surface_may_be_missing(self):
        rows = [row for row in self.table["rows"] if label_of(row, "surface") == "sphere"]
        rows[0] = {**rows[0], "status": "failed: singular"}
        figure = draw(rows)
        self.assertEqual(len(figure.axes), 2)
        self.assertIn("1 of 30 runs failed", texts_of(figure))
        self.assertNotIn("torus", texts_of(figure))

    def test_nothing_to_show_is_an_error(self):
        with self.assertRaises(TableError):
            draw([{**row, "values": {}} for row in self.table["rows"]])

    def test_the_script_writes_the_figure(self):
        with tempfile.TemporaryDirectory() as folder:
            done = run_script("mcf_competitors", self.table, folder)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertTrue(os.path.exists(f"{folder}/figures/gallery/mcf_competitors.pdf"))


if __name__ == "__main__":
    unittest.main()
