# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of snapshots.py."""
import tempfile
import unittest

import numpy as np
from matplotlib.figure import Figure

import style
from snapshots import Snapshots, Strip, evenly, shared_times, surface_grid
from surfaces import Surface, view
from testing import sphere, texts_of, write_surface

WIDE, TALL = (-2, 2, -1, 1), (-0.1, 0.1, -0.3, 0.3)


class Arrangement(unittest.TestCase):
    def test_few_of_many_with_both_ends(self):
        self.assertEqual(evenly(range(5), 6), [0, 1, 2, 3, 4])
        self.assertEqual(evenly(range(11), 6), [0, 2, 4, 6, 8, 10])
        self.assertEqual((len(evenly(range(100), 6)), evenly(range(100), 6)[-1]), (6, 99))

    def test_times_of_runs_with_other_steps_are_taken_together(self):
        fine, coarse = (Snapshots({"cell": "a", "tau": tau, "snapshots": [{"t": t, "file": "f"} for t in times]}, "", "")
                        for tau, times in ((0.01, (0, 0.5, 1)), (0.03, (0, 0.51, 0.99, 2))))
        found = [(t, [file and file[0] for file in files]) for t, files in shared_times([fine, coarse])]
        self.assertEqual(found, [(0, [0, 0]), (0.5, [0.5, 0.51]), (0.99, [1, 0.99]), (2, [None, 2])])

    def test_columns_have_one_scale_or_their_own(self):
        boxes = [[WIDE, TALL], [WIDE, None]]
        for own_scales in (False, True):
            figure, grid = surface_grid(boxes, ["$t = 0$", "$t = 1$"], ["a", "b"], "heading", own_scales=own_scales)
            scales = [[axes.get_position().width * style.WIDTH / np.ptp(axes.get_xlim()) for axes in row]
                      for row in grid]
            np.testing.assert_allclose(scales[0], scales[1])
            self.assertEqual(scales[0][1] > 2 * scales[0][0], own_scales)
            self.assertEqual([line.get_marker() for line in figure.artists or figure.lines], ["|"] * (1 + own_scales))
            self.assertTrue(texts_of(figure).startswith("heading a"))
            for axes, box in zip(grid[0], (WIDE, TALL)):
                self.assertLessEqual(axes.get_xlim()[0], box[0])
                self.assertLessEqual(axes.get_ylim()[0], box[2])

    def test_the_foot_stays_free_and_the_page_is_kept(self):
        figure, grid = surface_grid([[(-1, 1, -1, 1)]] * 8, ["t"] * 8, ["a"], "", foot=1.5)
        height = figure.get_size_inches()[1]
        self.assertGreater(grid[-1][0].get_position().y0 * height, 1.5)
        self.assertLess(height, 9.5)

    def test_a_strip_has_one_scale_and_ends_inside_its_width(self):
        with tempfile.TemporaryDirectory() as folder:
            ball = sphere(1)
            for i, size in enumerate((1, 2, 0.5)):
                write_surface(f"{folder}/{i}.vtu", Surface(size * ball.points, ball.triangles, {}))
            strip = Strip([(0.25 * i, f"{folder}/{i}.vtu") for i in range(3)], view(0), 5.0)
        figure = Figure(figsize=(style.WIDTH, 3))
        strip.draw(figure, 0.1, 0.2, linewidth=0)
        boxes = [axes.get_position() for axes in figure.axes]
        np.testing.assert_allclose([box.width / boxes[0].width for box in boxes], [1, 2, 0.5])
        self.assertTrue(0.1 <= boxes[0].x0 * style.WIDTH and boxes[-1].x1 * style.WIDTH <= 5.1 + 1e-9)
        self.assertLessEqual(max(box.y1 for box in boxes) * 3, 0.2 + strip.height + 1e-9)
        self.assertEqual(texts_of(figure), "$t = 0$ $t = 0.25$ $t = 0.5$")


if __name__ == "__main__":
    unittest.main()
