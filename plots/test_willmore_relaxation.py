# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of willmore_relaxation.py."""
import math
import os
import tempfile
import unittest

import numpy as np

import willmore_relaxation
from surfaces import Surface
from table import SCHEMA, TableError, label_of
from testing import lines_of, run_script, sphere, texts_of, write_surface
from willmore import limit_of

TIMES = (0, 0.1, 0.5, 1, 2, 3, 4)


def torus(along, around):
    """A quadratic torus about x3, radii 1 and 1/sqrt(2), of 2 * along * around elements."""
    u, v = (np.arange(2 * n) * np.pi / n for n in (along, around))
    u, v = (angles.ravel() for angles in np.meshgrid(u, v, indexing="ij"))
    rho = 1 + np.cos(v) / math.sqrt(2)
    points = np.column_stack([rho * np.cos(u), rho * np.sin(u), np.sin(v) / math.sqrt(2)])
    node = lambda i, j: (i % (2 * along)) * 2 * around + j % (2 * around)
    triangles = []
    for i in range(0, 2 * along, 2):
        for j in range(0, 2 * around, 2):
            for corners in (((0, 0), (2, 0), (2, 2)), ((0, 0), (2, 2), (0, 2))):
                middles = [((a[0] + b[0]) // 2, (a[1] + b[1]) // 2) for a, b in zip(corners, corners[1:] + corners[:1])]
                triangles.append([node(i + di, j + dj) for di, dj in (*corners, *middles)])
    return Surface(points, np.array(triangles), {})


def relaxation_row(surface, setting, end=4.0, **changes):
    t = np.linspace(0, end, 81)
    limit, drift = limit_of(surface)[0], {"paper": 0.05, "adaptive": 1e-4, "relaxed": 1e-6}[setting]
    columns = {"t": t, "willmore_energy": limit + 12 * np.exp(-3 * t) + drift, "area": 12 - t, "volume": 4 - t,
               "kappa_energy": limit + 12 * np.exp(-3 * t) + 0.01 * drift * (1 + t)}
    row = {"cell": f"{surface}_{setting}", "labels": {"surface": surface, "setting": setting}, "level": 1, "h": 0.1,
           "nodes": 4978, "tau": 0.00078125, "steps": round(end / 0.00078125), "status": "ok", "errors": {},
           "series": {name: values.tolist() for name, values in columns.items()}}
    if setting == "paper" and surface in willmore_relaxation.PAPER:
        row["snapshots"] = [{"t": t, "file": f"surfaces_{i:04d}.vtu"} for i, t in enumerate(TIMES) if t <= end]
    return {**row, **changes}


def relaxation_table():
    rows = [relaxation_row(surface, setting) for surface in willmore_relaxation.SURFACES
            for setting in willmore_relaxation.SETTINGS]
    return {"schema": SCHEMA, "experiment": "willmore_relaxation", "paper": "kll21", "parameters": {}, "rows": rows}


def write_snapshots(folder, fine=1):
    """An ellipsoid and a flattened sphere that grow round, a torus that loses its waves."""
    ball, ring = sphere(fine), torus(6 * fine, 3 * fine)
    angle = np.arctan2(ring.points[:, 1], ring.points[:, 0])
    for name in willmore_relaxation.PAPER:
        for i, t in enumerate(TIMES):
            away = math.exp(-2 * t)
            if name == "perturbed_torus":
                wave = (1 + 0.25 * away * np.cos(6 * angle))[:, None]
                surface = Surface(ring.points * 1.5 * wave, ring.triangles, {})
            else:
                axes = [1.6, 1.6, 1.6 - 1.1 * away] if name == "red_blood_cell" else [1 + away, 1, 1 - 0.2 * away]
                dent = (1 - 0.6 * away * np.exp(-4 * (1 - ball.points[:, 2]**2))) if name == "red_blood_cell" else 1
                points = ball.points * axes
                points[:, 2] *= dent
                surface = Surface(points, ball.triangles, {})
            write_surface(f"{folder}/cells/willmore_relaxation/{name}_paper/surfaces_{i:04d}.vtu", surface)


class Relaxation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = cls.temporary.name
        write_snapshots(cls.folder)
        cls.table = relaxation_table()
        cls.figures = dict(willmore_relaxation.draw(cls.table, cls.folder))

    def test_a_row_for_each_time_a_column_for_each_surface_and_energies_below(self):
        self.assertEqual(list(self.figures), ["kll21/fig7_5", "gallery/willmore_relaxation"])
        figure = self.figures["kll21/fig7_5"]
        pictures = [axes for axes in figure.axes if axes.collections]
        panels = [axes for axes in figure.axes if axes.lines]
        self.assertEqual((len(pictures), len(panels)), (18, 3))
        times = [text.get_text() for text in figure.texts if text.get_rotation() == 90]
        self.assertEqual(times, [f"$t = {t:g}$" for t in (0, 0.1, 0.5, 2, 3, 4)])  # six, the first and the last
        for name in ("ellipsoid", "red blood cell", "perturbed torus"):
            self.assertIn(f"{name}, $N = 4{{,}}978$", texts_of(figure))
        self.assertIn(r"$\tau = 0.000781$", texts_of(figure))
        for i, axes in enumerate(panels):
            self.assertEqual(axes.get_title(), r"$W^* = 4\pi^2$" if i == 2 else r"$W^* = 8\pi$")
            self.assertEqual(axes.get_yscale(), "log")
            np.testing.assert_allclose(lines_of(axes)[0].get_ydata()[-1], 0.05 + 12 * math.exp(-12))  # the plateau
            self.assertEqual((axes.get_xlabel(), axes.get_xlim()), ("$t$", (0, 4)))
            self.assertEqual(len(lines_of(axes)), 2)
            self.assertLess(axes.get_position().y1, min(picture.get_position().y0 for picture in pictures))
        self.assertEqual([text.get_text() for text in panels[0].get_legend().get_texts()],
                         ["$W(H_h)$", r"$W(\kappa_h)$"])
        self.assertLess(figure.get_size_inches()[1], 9.5)

    def test_a_column_has_one_scale(self):
        figure = self.figures["kll21/fig7_5"]
        scales = [axes.get_position().width * figure.get_size_inches()[0] / np.ptp(axes.get_xlim())
                  for axes in figure.axes if axes.collections]
        for column in range(3):
            np.testing.assert_allclose(scales[column::3], scales[column])
        self.assertGreater(np.ptp(scales[:3]), 0)

    def test_energies_of_all_settings_are_drawn_as_distances_from_the_limit(self):
        figure = self.figures["gallery/willmore_relaxation"]
        self.assertEqual(len(figure.axes), 7)
        self.assertEqual([text.get_text() for text in figure.legends[0].get_texts()],
                         ["fixed steps (paper)", "adaptive steps", "adaptive steps, relaxation", "$W(H_h)$", r"$W(\kappa_h)$"])
        for axes in figure.axes:
            lines = lines_of(axes)
            self.assertEqual((len(lines), axes.get_yscale()), (6, "log"))
            self.assertEqual([line.get_linestyle() for line in lines], ["-", "--"] * 3)
            self.assertEqual(len({line.get_color() for line in lines}), 3)
            for line, row in zip(lines[::2], self.table["rows"]):
                expected = np.array(row["series"]["willmore_energy"]) - 8 * math.pi
                np.testing.assert_allclose(line.get_ydata(), expected, rtol=1e-6)
        self.assertEqual([axes.get_ylabel() for axes in figure.axes[::3]], ["$|W - W^*|$"] * 3)
        self.assertIn(r"small torus, four waves, $W^* = 4\pi^2$", texts_of(figure))
        self.assertIn(r"Evans–Fung cell, $W^* = 8\pi$", texts_of(figure))

    def test_failed_and_stopped_runs_leave_gaps_and_notes(self):
        table = relaxation_table()
        for i, row in enumerate(table["rows"]):
            if row["cell"] == "red_blood_cell_paper":
                table["rows"][i] = relaxation_row("red_blood_cell", "paper", 1.0, steps=5120,
                                                  status="singular at t = 1.1 (step 1400): why")
            if row["cell"] in ("ellipsoid_paper", "small_torus_relaxed"):
                row.update(status="failed: why", series={}, snapshots=[], h=0, nodes=0)
        figures = dict(willmore_relaxation.draw(table, self.folder))
        figure = figures["kll21/fig7_5"]
        self.assertEqual(len([axes for axes in figure.axes if axes.collections]), 6 + 3)
        self.assertIn(r"Stopped early, as singular: red blood cell, fixed steps (paper), $N = 4{,}978$ with", texts_of(figure))
        self.assertIn("1 of 3 runs failed: ellipsoid, fixed steps (paper), level 1 with", texts_of(figure))
        gallery = figures["gallery/willmore_relaxation"]
        self.assertIn("2 of 21 runs failed: ellipsoid, fixed steps (paper), level 1 with", texts_of(gallery))
        self.assertEqual([len(lines_of(axes)) for axes in gallery.axes], [4, 6, 6, 6, 6, 4, 6])

    def test_small_tables_give_what_they_have(self):
        row = relaxation_row("small_torus", "adaptive")
        del row["series"]["kappa_energy"]
        figure, = dict(willmore_relaxation.draw({"rows": [row]}, self.folder)).values()
        self.assertEqual([len(lines_of(axes)) for axes in figure.axes], [1])
        exact = {"t": [0, 1], "willmore_energy": [4 * math.pi**2] * 2, "kappa_energy": [None, None]}
        self.assertEqual(len(dict(willmore_relaxation.draw({"rows": [{**row, "series": exact}]}, self.folder))), 1)
        for change in ({"labels": {**row["labels"], "surface": "cube"}}, {"series": {}}, {"status": "failed: why"}):
            with self.assertRaisesRegex(TableError, "no snapshots and no energies"):
                list(willmore_relaxation.draw({"rows": [row | change]}, self.folder))
        pictures = relaxation_row("ellipsoid", "paper", series={"t": [0, 4]})
        self.assertEqual(list(dict(willmore_relaxation.draw({"rows": [pictures]}, self.folder))), ["kll21/fig7_5"])
        pictures["snapshots"][2]["file"] = "gone.vtu"
        with self.assertRaisesRegex(TableError, "ellipsoid_paper/gone.vtu: no such snapshot"):
            list(willmore_relaxation.draw({"rows": [pictures]}, self.folder))

    def test_of_runs_alike_the_finest_is_drawn(self):
        coarse = relaxation_row("ellipsoid", "paper", cell="coarse", nodes=1000)
        longer = relaxation_row("ellipsoid", "paper", cell="longer", tau=0.0015)
        figures = dict(willmore_relaxation.draw({"rows": [coarse, longer, *self.table["rows"]]}, self.folder))
        self.assertIn("ellipsoid, $N = 4{,}978$", texts_of(figures["kll21/fig7_5"]))
        self.assertIn(r"$\tau = 0.000781$", texts_of(figures["kll21/fig7_5"]))

    def test_the_script_writes_files(self):
        table = {**self.table, "rows": [row for row in self.table["rows"] if label_of(row, "surface") == "ellipsoid"]}
        result = run_script("willmore_relaxation", table, self.folder)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        written = sorted(os.path.relpath(os.path.join(root, name), self.folder + "/figures")
                         for root, _, names in os.walk(self.folder + "/figures") for name in names)
        self.assertEqual(written, [f"{name}.{kind}" for name in ("gallery/willmore_relaxation", "kll21/fig7_5")
                                   for kind in ("pdf", "png")])


if __name__ == "__main__":
    unittest.main()
