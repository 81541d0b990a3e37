# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of helfrich_vesicles.py."""
import os
import tempfile
import unittest

import numpy as np

import helfrich_vesicles
from surfaces import Surface
from table import SCHEMA, TableError
from testing import run_script, sphere, texts_of, write_surface


def vesicle_row(branch, volume, curvature="0", level=0, **changes):
    shapes = helfrich_vesicles._reference("independent", "helfrich.json")["shapes"]
    name = "prolate" if branch == "prolate" else "oblate"
    exact, = (s["E_over_8pi"] for s in shapes if (s["branch"], s["v"], s["H0"]) == (name, float(volume), float(curvature)))
    error = 1e-3 / 4**level
    row = {"cell": f"{branch}_{volume}_{curvature}_h{level}_tau0", "level": level, "h": 0.3 / 2**(level / 2),
           "labels": {"branch": branch, "volume": volume, "curvature": curvature}, "nodes": 1602 * 2**level,
           "tau": 0.002, "steps": 200, "status": "ok", "series": {"t": [0, 0.2]},
           "errors": {"energy": {"surface": error, "flow": error}},
           "values": {"energy": exact + error, "reference_energy": exact},
           "snapshots": [{"t": 0, "file": "surfaces_0000.vtu"}, {"t": 0.2, "file": "surfaces_0001.vtu"}]}
    return {**row, **changes}


def vesicle_table():
    rows = [vesicle_row("prolate", volume, level=level) for volume in ("0.95", "0.8", "0.6") for level in (0, 1)]
    rows += [vesicle_row("oblate", "0.6"), vesicle_row("prolate", "0.8", "1.5"),
             vesicle_row("red_blood_cell", "0.6", snapshots=[])]
    perturbed = vesicle_row("perturbed_oblate", "0.8", "1.5", errors={}, values={"growth_rate": 14.6})
    return {"schema": SCHEMA, "experiment": "helfrich_vesicles", "paper": "esfem", "parameters": {},
            "rows": [*rows, perturbed]}


class Vesicles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = cls.temporary.name
        ball = sphere(1)
        for row in vesicle_table()["rows"]:
            for entry in row["snapshots"]:
                axes = [0.6, 0.6, 1.8] if row["labels"]["branch"] == "prolate" else [1.3, 1.3, 0.4]
                write_surface(f"{cls.folder}/cells/helfrich_vesicles/{row['cell']}/{entry['file']}",
                              Surface(ball.points * axes, ball.triangles, {}))

    def test_energies_lie_on_the_branches_and_errors_beside_others(self):
        figure = dict(helfrich_vesicles.draw(vesicle_table(), self.folder))["gallery/helfrich_energies"]
        left, right = figure.axes
        self.assertEqual(len([line for line in left.lines if line.get_gid() == "branch prolate"]), 2)
        crossing, = (line for line in left.lines if line.get_gid() == "crossing")
        np.testing.assert_allclose(crossing.get_ydata(), 1.8234715, rtol=1e-7)
        others, = (line for line in right.lines if line.get_gid() == "others")
        self.assertEqual(list(others.get_ydata()), [0.01, 0.004])
        marks = [line for line in left.lines if len(line.get_xdata()) == 1 and not line.get_gid()]
        self.assertEqual(len(marks), 8)  # all with H_0 = 0, none for the perturbed one
        slope, = (line for line in right.lines if line.get_gid() == "slope")
        (x0, x1), (y0, y1) = slope.get_data()
        np.testing.assert_allclose(np.log(y1 / y0) / np.log(x1 / x0), -2)
        self.assertIn("cselab/corpuscles", "".join(texts_of(figure)))

    def test_branches_go_through_the_shapes_and_meet_at_the_crossing(self):
        reference = helfrich_vesicles._reference("independent", "helfrich.json")
        crossing = reference["crossing"]
        for branch in ("prolate", "oblate"):
            shapes = [s for s in reference["shapes"] if s["branch"] == branch and s["H0"] == 0]
            v, energy = helfrich_vesicles.branch_curve(shapes)
            for shape in shapes:
                np.testing.assert_allclose(np.interp(shape["v"], v, energy), shape["E_over_8pi"], rtol=1e-9)
            # The slopes are those of the multipliers: a cubic is as good as this between two shapes.
            np.testing.assert_allclose(np.interp(crossing["v"], v, energy), crossing["E_over_8pi"], rtol=1e-3)

    def test_shapes_stand_in_rows_of_branches_and_columns_of_volumes(self):
        figure = dict(helfrich_vesicles.draw(vesicle_table(), self.folder))["gallery/helfrich_vesicles"]
        self.assertEqual(len([axes for axes in figure.axes if axes.collections]), 4)
        for text in ("$v = 0.95$", "$v = 0.6$", "prolate", "oblate"):
            self.assertIn(text, texts_of(figure))

    def test_small_tables_give_what_they_have(self):
        row = vesicle_row("prolate", "0.8", snapshots=[])
        self.assertEqual([name for name, _ in helfrich_vesicles.draw({"rows": [row]}, self.folder)],
                         ["gallery/helfrich_energies"])
        with self.assertRaisesRegex(TableError, "no energies"):
            list(helfrich_vesicles.draw({"rows": [{**row, "values": {}}]}, self.folder))

    def test_the_script_writes_files(self):
        result = run_script("helfrich_vesicles", vesicle_table(), self.folder)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        self.assertEqual(sorted(os.listdir(self.folder + "/figures/gallery")),
                         [f"helfrich_{name}.{kind}" for name in ("energies", "vesicles") for kind in ("pdf", "png")])


if __name__ == "__main__":
    unittest.main()
