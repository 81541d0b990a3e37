# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of convergence.py."""
import math
import unittest

import numpy as np

from convergence import Curve, Panel, convergence_figure, curves, draw_panels
from mcf_sphere import QUANTITIES
from table import TableError
from testing import data_lines, references, sphere_figures, synthetic_table


class Convergence(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.figures = sphere_figures()

    def test_lines_and_legend_are_those_of_the_table(self):
        for widths, exponents in (((0.49, 0.35, 0.245), range(8)), ((0.49,), range(4)), ((0.49, 0.35), (3,)),
                                  (np.geomspace(1, 0.1, 10), range(10))):
            table = synthetic_table(widths, exponents)
            for variable, count in (("tau", len(widths)), ("h", len(exponents))):
                figure = convergence_figure(table["rows"], QUANTITIES, "nodal_H1", variable, order=2)
                self.assertEqual(len(figure.axes), 4)
                self.assertEqual(len(figure.legends[0].get_texts()), count)
                for axes in figure.axes:
                    self.assertEqual(len(data_lines(axes)), count)

    def test_panels_span_equally_many_decades(self):
        for figure in self.figures.values():
            spans = [np.ptp(np.log10(axes.get_ylim())) for axes in figure.axes]
            np.testing.assert_allclose(spans, spans[0])

    def test_the_norm_is_the_one_asked_for(self):
        rows = synthetic_table((0.49, 0.35), (2,))["rows"]
        axes = convergence_figure(rows, ("x",), "lifted_H1", "h", order=2).axes[0]
        self.assertEqual(max(data_lines(axes)[0].get_ydata()), rows[0]["errors"]["x"]["lifted_H1"])
        self.assertIn("lifted", axes.get_ylabel())

    def test_failed_runs_are_left_out_and_counted(self):
        table = synthetic_table()
        for row in table["rows"][:2]:
            row.update(status="failed: degenerate element 12 at step 3", errors={}, h=0, nodes=0)
        figure = convergence_figure(table["rows"], QUANTITIES, "nodal_H1", "tau", order=3)
        self.assertEqual([text.get_text() for text in figure.texts], [r"2 of 40 runs failed: level 0 with $\tau$ = 0.2, 0.1."])
        self.assertEqual(len(data_lines(figure.axes[0])[0].get_xdata()), 6)

    def test_errors_without_a_logarithm_are_left_out_and_counted(self):
        table = synthetic_table()
        for row, value in zip(table["rows"], (0, 1e-15, None, math.nan, math.inf)):
            row["errors"]["x"]["nodal_H1"] = value
        shown, skipped = curves(table["rows"], "x", "nodal_H1", "tau")
        self.assertEqual((len(shown[0].points), skipped), (3, 5))
        for row in table["rows"]:
            row["errors"]["H"]["nodal_H1"] = 0
        figure = convergence_figure(table["rows"], QUANTITIES, "nodal_H1", "tau", order=3)
        self.assertIn("5 of x, 40 of H", figure.texts[0].get_text())
        self.assertIn("all errors below", figure.axes[3].texts[0].get_text())

    def test_axes_and_slopes_belong_to_the_variable_of_each_panel(self):
        points = np.array([[0.1, 1e-3], [0.2, 8e-3]])
        panels = [Panel("time", [Curve("a", points)], "tau", 3), Panel("space", [Curve("b", 3 * points)], "h")]
        time, space = draw_panels(panels, "error", ["a note"]).axes
        self.assertIn("tau", time.get_xlabel())
        self.assertIn("mesh width", space.get_xlabel())
        self.assertEqual([len(references(axes)) for axes in (time, space)], [1, 0])
        np.testing.assert_allclose(np.array(space.get_xlim()), 3 * np.array(time.get_xlim()))
        panels[1].curves = [Curve("b", np.empty((0, 2)))]
        self.assertIn("all errors below", draw_panels(panels, "error").axes[1].texts[0].get_text())
        with self.assertRaisesRegex(TableError, "all errors"):
            draw_panels(panels[1:], "error")


if __name__ == "__main__":
    unittest.main()
