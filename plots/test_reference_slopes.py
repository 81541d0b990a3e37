# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of the reference slopes as they are drawn."""
import unittest

import numpy as np

from convergence import Curve, Panel, draw_panels
from testing import data_lines, exponents_to_points, references, slopes_of, sphere_figures


class ReferenceSlopes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.figures = sphere_figures()

    def test_reference_lines_have_the_slope_they_name(self):
        for figure in self.figures.values():
            for axes in figure.axes:
                self.assertGreaterEqual(len(references(axes)), 1)
                for line in references(axes):
                    (x0, y0), (x1, y1) = exponents_to_points(axes, line)
                    named = float(line.get_gid().split("^{")[1].split("}")[0])
                    self.assertAlmostEqual((y1 - y0) / (x1 - x0), named, places=6)

    def test_reference_lines_stay_below_the_data_and_inside(self):
        for figure in self.figures.values():
            for axes in figure.axes:
                for line in references(axes):
                    corners = line.get_transform().transform(np.array(line.get_data()).T)
                    self.assertTrue(all(axes.bbox.contains(*corner) for corner in corners))
                    points = exponents_to_points(axes, line)
                    x = np.linspace(*points[:, 0], 50)
                    for curve in data_lines(axes):
                        data = np.log10(curve.get_xydata())
                        below = np.interp(x, *points.T) < np.interp(x, *data.T)
                        self.assertTrue(np.all(below[(x >= data[0, 0]) & (x <= data[-1, 0])]))

    def test_a_curve_with_an_order_of_its_own_has_its_slope_below_it_in_its_colour(self):
        tau = np.geomspace(0.005, 0.1, 5)
        orders = (1, 2, 3)
        lines = [Curve(f"q{p}", np.column_stack([tau, tau**p]), p) for p in orders]
        figure = draw_panels([Panel("one", lines, "tau"), Panel("other", lines[:1], "tau")], "error")
        axes = figure.axes[0]
        self.assertEqual(slopes_of(figure)[0], [r"$O(\tau)$" if p == 1 else r"$O(\tau^{%d})$" % p for p in orders])
        for p, line, curve in zip(orders, references(axes), data_lines(axes)):
            self.assertEqual(line.get_color(), curve.get_color())
            x, y = exponents_to_points(axes, line).T
            self.assertTrue(np.all(p * x > y))  # log tau^p, below the curve
            if p < 3:
                self.assertTrue(np.all((p + 1) * x < y))  # and above the next one
        self.assertEqual(len(figure.legends), 2)


if __name__ == "__main__":
    unittest.main()
