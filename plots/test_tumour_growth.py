# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of tumour_growth.py."""
import pathlib
import tempfile
import unittest

import meshio
import numpy as np

import tumour_growth
from table import TableError


class Tumour(unittest.TestCase):
    def test_surfaces_are_coloured_and_missing_ones_named(self):
        points = [[0, 0, 1.0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, -1.0]]
        triangles = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [5, 2, 1], [5, 3, 2], [5, 4, 3], [5, 1, 4]]
        with tempfile.TemporaryDirectory() as folder:
            cell = pathlib.Path(folder, "cells/tumour_growth/h0_tau0")
            cell.mkdir(parents=True)
            for name, size in (("a.vtu", 1), ("b.vtu", 2)):
                meshio.Mesh(size * np.array(points), [("triangle", triangles)],
                            point_data={"u1": np.linspace(0.5, 1.5, 6)}).write(cell / name)
            times = [0.0, 1.0]
            row = {"cell": "h0_tau0", "h": 1.4, "nodes": 6, "tau": 1.0, "steps": 1, "status": "ok", "errors": {},
                   "snapshots": [{"t": 0, "file": "a.vtu"}, {"t": 1, "file": "b.vtu"}],
                   "series": {"t": times, "area": times, "min_u1": times, "max_u1": times}}
            (name, figure), = tumour_growth.draw({"rows": [row]}, folder)
            self.assertEqual(name, "gallery/tumour_growth")
            widths = [axes.get_position().width for axes in figure.axes[:2]]
            extremes = figure.axes[-2]
            self.assertEqual([line.get_linestyle() for line in extremes.lines], ["--", "-"])
            self.assertEqual([text.get_text() for text in extremes.get_legend().get_texts()], ["min", "max"])
            self.assertAlmostEqual(widths[1] / widths[0], 2)  # one scale for all
            row["snapshots"][1]["file"] = "c.vtu"
            with self.assertRaisesRegex(TableError, "c.vtu: no such snapshot"):
                list(tumour_growth.draw({"rows": [row]}, folder))


if __name__ == "__main__":
    unittest.main()
