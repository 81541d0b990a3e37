# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of surface_diffusion.py."""
import math
import os
import tempfile
import unittest

import numpy as np

import surface_diffusion
from surfaces import Surface
from table import SCHEMA, TableError
from testing import data_lines, limits_of, run_script, sphere, texts_of, write_surface

TIMES = (0, 0.02, 0.1, 0.5, 2)


def diffusion_row(level, k, **changes):
    tau = 0.05 * 2.0**-k
    t = np.arange(0, 2 + tau / 2, tau)
    volume = 4.8 * (1 + 1e-2 * tau**2 * (1 - np.exp(-3 * t)))
    area = (36 * math.pi * 4.8**2)**(1 / 3) * (1 + 0.1 * np.exp(-3 * t))
    return {"cell": f"h{level}_tau{k}", "labels": {"setting": "paper"}, "level": level, "h": 0.4 / 2**level,
            "nodes": 1026 * 4**level, "tau": tau, "steps": len(t) - 1, "status": "ok", "errors": {},
            "series": {"t": t.tolist(), "area": area.tolist(), "volume": volume.tolist(),
                       "elongation": np.exp(-3 * t).tolist()},
            "snapshots": [{"t": t, "file": f"surfaces_{i:04d}.vtu"} for i, t in enumerate(TIMES)]} | changes


def diffusion_table():
    rows = [diffusion_row(level, k) for level in range(2) for k in range(3)]
    rows += [diffusion_row(level, 1, cell=f"relaxed_h{level}", labels={"setting": "relaxed"}, snapshots=[])
             for level in range(2)]
    return {"schema": SCHEMA, "experiment": "surface_diffusion", "paper": "kll21", "parameters": {}, "rows": rows}


def write_snapshots(folder, cell, fine=1):
    ball = sphere(fine)
    for i, t in enumerate(TIMES):
        away = math.exp(-3 * t)
        surface = Surface(ball.points * [1 + away, 1, 1 - 0.4 * away], ball.triangles, {})
        write_surface(f"{folder}/cells/surface_diffusion/{cell}/surfaces_{i:04d}.vtu", surface)


class SurfaceDiffusion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = cls.temporary.name
        write_snapshots(cls.folder, "h1_tau2")  # the finest run; the others have no files

    def draw(self, rows):
        (name, figure), = surface_diffusion.draw({"rows": rows}, self.folder)
        self.assertEqual(name, "gallery/surface_diffusion")
        return figure

    def panels(self, figure):
        return [axes for axes in figure.axes if axes.get_xlabel() == "$t$"]

    def test_surfaces_of_the_finest_run_above_area_volume_and_elongation(self):
        figure = self.draw(diffusion_table()["rows"])
        area, volume, elongation = self.panels(figure)
        pictures = [axes for axes in figure.axes if axes.collections]
        self.assertEqual(len(pictures), 5)
        self.assertGreater(min(axes.get_position().y0 for axes in pictures), area.get_position().y1)
        for t in TIMES:
            self.assertIn(f"$t = {t:.3g}$", texts_of(figure))
        self.assertEqual([len(data_lines(axes)) for axes in (area, volume, elongation)], [4, 4, 4])
        legend = [text.get_text() for text in figure.legends[0].get_texts()]
        self.assertEqual(set(legend), {r"fixed steps, $\tau = 0.05$", r"fixed steps, $\tau = 0.025$",
                                       r"fixed steps, $\tau = 0.0125$", r"adaptive steps, relaxation, $\tau = 0.025$"})
        self.assertIn("$N = 4{,}104$. Fixed steps", texts_of(figure))
        self.assertEqual((area.get_yscale(), volume.get_yscale()), ("linear", "log"))
        self.assertIn("volume, $|V(t) / V(0) - 1|$", texts_of(figure))
        self.assertIn("area; dashed: sphere", texts_of(figure))

    def test_the_limit_of_the_area_is_that_of_the_sphere_of_equal_volume(self):
        ball = 4 / 3 * math.pi * 1.5**3
        row = diffusion_row(0, 0, snapshots=[], series={"t": [0, 1], "area": [30, 29], "volume": [ball, ball * 1.001]})
        area, volume, _ = self.panels(self.draw([row]))
        self.assertAlmostEqual(limits_of(area)[0], 4 * math.pi * 1.5**2)
        shown = data_lines(volume)[0].get_ydata()
        self.assertTrue(math.isnan(shown[0]))
        self.assertAlmostEqual(shown[1], 1e-3)

    def test_missing_series_snapshots_and_runs(self):
        rows = diffusion_table()["rows"]
        del rows[3]["series"]["volume"]
        rows[1].update(status="failed: why", series={}, snapshots=[], h=0, nodes=0)
        rows[5].update(status="singular at t = 1 (step 9): why")
        figure = self.draw(rows)
        self.assertEqual([len(data_lines(axes)) for axes in self.panels(figure)], [4, 3, 4])
        self.assertIn(r"1 of 8 runs failed: fixed steps, level 0 with $\tau$ = 0.025.", texts_of(figure))
        self.assertIn(r"Stopped early, as singular: fixed steps, $N = 4{,}104$ with $\tau$ = 0.0125.", texts_of(figure))
        figure = self.draw([diffusion_row(0, 0, snapshots=[])])
        self.assertFalse([axes for axes in figure.axes if axes.collections])
        with self.assertRaisesRegex(TableError, "h0_tau0/surfaces_0000.vtu: no such snapshot"):
            self.draw([diffusion_row(0, 0)])
        with self.assertRaisesRegex(TableError, "no series area or volume"):
            self.draw([diffusion_row(0, 0, series={"t": [0]})])

    def test_the_script_writes_files(self):
        result = run_script("surface_diffusion", diffusion_table(), self.folder)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        self.assertEqual(sorted(os.listdir(self.folder + "/figures/gallery")),
                         ["surface_diffusion.pdf", "surface_diffusion.png"])


if __name__ == "__main__":
    unittest.main()
