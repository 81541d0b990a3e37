# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of time_series.py."""
import math
import unittest

import numpy as np
from matplotlib.figure import Figure

import time_series
from testing import texts_of

LINES = {name: {"color": "black"} for name in "abcde"}


class TimeSeries(unittest.TestCase):
    def test_panels_keep_what_is_above_and_below_free(self):
        figure, grid = time_series.panels([["one", "two"], ["three"]], LINES, ["a note"], above=1.5)
        self.assertEqual([len(row) for row in grid], [2, 1])
        height = figure.get_size_inches()[1]
        figure.draw_without_rendering()
        legend = figure.legends[0].get_window_extent().y1 / figure.dpi
        self.assertTrue(height - 1.6 < legend <= height - 1.5 + 1e-6)
        self.assertLess(grid[0][0].get_position().y1 * height, height - 1.5)
        self.assertEqual(texts_of(figure), "one two three a note")

    def test_legends_have_at_most_so_many_entries_in_a_row(self):
        for abreast, rows in ((4, 2), (5, 1), (2, 3)):
            figure, _ = time_series.panels([["one"]], LINES, abreast=abreast)
            figure.draw_without_rendering()
            heights = {round(text.get_window_extent().y0) for text in figure.legends[0].get_texts()}
            self.assertEqual(len(heights), rows)

    def test_what_is_drawn_may_be_changed(self):
        axes = Figure().add_axes([0, 0, 1, 1])
        row = {"cell": "a", "series": {"t": [0, 1, 2], "w": [8, 9, None]}}
        change = lambda values: time_series.positive(values - 8)
        np.testing.assert_array_equal(time_series.draw_series(axes, row, "w", {}, (0, 2), change), [1])
        np.testing.assert_array_equal(axes.lines[0].get_ydata(), [math.nan, 1, math.nan])
        self.assertEqual(len(time_series.draw_series(axes, row, "missing", {}, (0, 2), change)), 0)

    def test_logarithmic_axes_have_readable_numbers(self):
        for low, high, expected in ((0.3, 200, ["1", "10", "100"]), (1e-9, 1e-5, ["$10^{-9}$", "$10^{-5}$"]),
                                    (2.3e-6, 5e-5, ["$10^{-5}$", r"$5\cdot 10^{-6}$"]),
                                    (1.2e-6, 8e-6, [r"$1.5\cdot 10^{-6}$"]), (2e-7, 5e-5, ["$10^{-6}$", "$10^{-5}$"]),
                                    (1e-14, 1e2, ["$10^{-14}$", "$10^{-2}$"])):
            axes = Figure().add_axes([0, 0, 1, 1])
            time_series.scale(axes, np.array([low, high, math.nan]), logarithmic=True)
            labels = [axes.yaxis.get_major_formatter()(tick, 0) for tick in axes.yaxis.get_majorticklocs()]
            for label in expected:
                self.assertIn(label, labels)
            self.assertLessEqual(len(labels), 10)

    def test_notes_tell_failed_from_stopped(self):
        rows = [{"nodes": 100 * i, "tau": 0.1, "status": status} for i, status in
                enumerate(["ok", "singular at t = 1 (step 2): why"] + 8 * ["failed: why"])]
        self.assertEqual(" ".join(time_series.failure_notes(rows)), "8 of 10 runs failed: " + "; ".join(rf"$N = {n}00$ with $\tau$ = 0.1" for n in range(2, 8)) + " and 2 more.")
        self.assertEqual(time_series.stopped_notes(rows, lambda row: "a"), [r"Stopped early, as singular: a, $N = 100$ with $\tau$ = 0.1."])
        self.assertEqual(time_series.failure_notes(rows[:2]) + time_series.stopped_notes(rows[:1]), [])


if __name__ == "__main__":
    unittest.main()
