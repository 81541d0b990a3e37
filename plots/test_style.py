# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of style.py."""
import math
import unittest

import numpy as np
from matplotlib.figure import Figure

import style


class Style(unittest.TestCase):
    def test_line_styles_differ_and_grow_lighter(self):
        styles = style.line_styles(10)
        self.assertEqual(len({s["marker"] for s in styles}), 10)
        lightness = [np.dot(s["color"][:3], (0.299, 0.587, 0.114)) for s in styles]
        self.assertTrue(np.all(np.diff(lightness) > 0))
        self.assertLess(lightness[-1], 0.75)

    def test_step_sizes_and_mesh_widths_close_together_have_readable_labels(self):
        for low, high in ((0.265, 0.39), (0.34, 0.4999), (0.09, 0.13)):
            axis = Figure().add_axes([0, 0, 1, 1]).xaxis
            style.log_ticks(axis, low, high, 120)
            ticks = axis.get_majorticklocs()
            self.assertTrue(len(ticks) >= 2 and low <= ticks[0] and ticks[-1] <= high)
            self.assertGreater(120 * np.diff(np.log(ticks)).min() / math.log(high / low), 15)


if __name__ == "__main__":
    unittest.main()
