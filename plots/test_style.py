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

    def test_lines_are_not_broken_inside_formulas(self):
        lines = style.wrap("one " * 5 + r"$N = 1{,}914$, $\tau = 0.025$ " + "two " * 5, 24)
        self.assertGreater(len(lines), 2)
        self.assertTrue(all(line.count("$") % 2 == 0 and len(line) <= 24 for line in lines))
        self.assertIn("$N = 1{,}914$", " ".join(lines))

    def test_numbers_are_written_as_powers_of_ten(self):
        self.assertEqual([style.power_of_ten(value) for value in (1.26e-2, 1e-6, 2.9999999e5)],
                         [r"$1.3\cdot 10^{-2}$", "$10^{-6}$", r"$3\cdot 10^{5}$"])
        self.assertEqual(style.nodes_label(12000), "$N = 12{,}000$")

    def test_runs_are_told_by_mesh_and_step_size(self):
        rows = [{"nodes": 1342, "tau": 0.1}, {"nodes": 1342, "tau": 0.05}, {"nodes": 0, "level": 2, "tau": 0.1, "of": "a"}]
        self.assertEqual(style.in_words(rows), r"$N = 1{,}342$ with $\tau$ = 0.1, 0.05; level 2 with $\tau$ = 0.1")
        self.assertIn(r"; a, level 2 with $\tau$ = 0.1", style.in_words(rows, lambda row: row.get("of", "")))
        many = [{"nodes": 10 + i, "tau": tau} for i in range(8) for tau in (0.1, 0.05)]
        self.assertTrue(style.in_words(many).endswith(r"$N = 15$ with $\tau$ = 0.1, 0.05 and 4 more"))

    def test_a_limit_has_its_name_where_there_is_room(self):
        for ylim, side in (((0, 10), "bottom"), ((-10, 3), "top")):
            axes = Figure().add_axes([0, 0, 1, 1])
            axes.set_ylim(ylim)
            style.limit_line(axes, 2, "$L$")
            self.assertEqual((axes.texts[0].get_text(), axes.texts[0].get_va()), ("$L$", side))
            self.assertEqual(axes.lines[0].get_ydata()[0], 2)

    def test_a_notice_is_as_high_as_its_lines(self):
        heights = [style.notice(["why " * n]).get_size_inches()[1] for n in (1, 100)]
        self.assertLess(*heights)


if __name__ == "__main__":
    unittest.main()
