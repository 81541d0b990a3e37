# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of tangential_motion.py."""
import os
import tempfile
import unittest

import numpy as np

import tangential_motion
from table import SCHEMA, TableError
from testing import lines_of, run_script, texts_of


def motion_row(surface, flow, tangential, **changes):
    t = np.linspace(0, 1, 21)
    fall = 40 if tangential == "none" and flow != "bgn" else 10
    return {"cell": f"{surface}_{flow}_{tangential}",
            "labels": {"surface": surface, "flow": flow, "tangential": tangential}, "level": 1, "h": 0.2, "nodes": 1914,
            "tau": 0.05, "steps": 20, "status": "ok", "errors": {},
            "series": {"t": t.tolist(), "worst_angle": (45 - fall * t).tolist(),
                       "worst_radius_ratio": (0.9 - fall * t / 50).tolist(), "willmore_energy": (41 - t).tolist()}, **changes}


def motion_table():
    rows = [motion_row(surface, *scheme) for surface in tangential_motion.SURFACES if surface != "torus"
            for scheme in tangential_motion.SCHEMES]
    rows += [motion_row("torus", *scheme) for scheme in tangential_motion.ON_TORUS]
    return {"schema": SCHEMA, "experiment": "tangential_motion", "paper": "esfem", "parameters": {}, "rows": rows}


def draw(rows, name="gallery/tangential_motion"):
    return dict(tangential_motion.draw({"rows": rows}, ""))[name]


class TangentialMotion(unittest.TestCase):
    def test_angles_above_radius_ratios_below(self):
        figure = draw(motion_table()["rows"])
        self.assertEqual(len(figure.axes), 6)
        self.assertEqual([figure.axes[i].get_ylabel() for i in (0, 3)], list(tangential_motion.QUANTITIES.values()))
        for axes in figure.axes:
            self.assertEqual((len(lines_of(axes)), axes.get_ylim()[0], axes.get_xlabel()), (4, 0, "$t$"))
        last = [line.get_ydata()[-1] for line in lines_of(figure.axes[0])]
        self.assertEqual(last, [5, 35, 5, 35])
        self.assertEqual([text.get_text() for text in figure.legends[0].get_texts()],
                         ["(5.1)", "(5.1), minimal deformation rate", "Dziuk", "BGN"])
        self.assertIn(r"Red blood cell: $N = 1{,}914$, $\tau = 0.05$.", texts_of(figure))

    def test_willmore_flow_of_the_torus_has_angle_radius_ratio_and_energy(self):
        figure = draw(motion_table()["rows"], "gallery/tangential_motion_willmore")
        self.assertEqual([text.get_text() for text in figure.legends[0].get_texts()],
                         ["(3.4)–(3.5)", "minimal deformation rate", "relaxation", "both"])
        self.assertIn(r"Torus: $N = 1{,}914$, $\tau \leq 0.05$.", texts_of(figure))
        for axes in figure.axes:
            self.assertEqual(len([line for line in lines_of(axes) if len(line.get_xdata()) == 21]), 4)
        limits = [[line for line in axes.lines if (line.get_gid() or "").startswith("limit")] for axes in figure.axes]
        self.assertEqual([len(of_axes) for of_axes in limits], [0, 0, 1])
        self.assertAlmostEqual(limits[2][0].get_ydata()[0], 4 * np.pi**2)
        looks = {(line.get_color(), line.get_linestyle()) for line in lines_of(figure.axes[0])}
        self.assertEqual(len(looks), 4)  # two colours, and dashes in greyscale

    def test_a_table_without_the_torus_has_one_figure(self):
        rows = [row for row in motion_table()["rows"] if row["labels"]["surface"] != "torus"]
        self.assertEqual(list(dict(tangential_motion.draw({"rows": rows}, ""))), ["gallery/tangential_motion"])

    def test_failed_and_stopped_runs_are_noted(self):
        rows = motion_table()["rows"]
        rows[0].update(status="singular at t = 0.5 (step 10): why")
        rows[3].update(status="failed: step 2: why", series={}, h=0, nodes=0)
        figure = draw(rows)
        self.assertIn("Stopped early, as singular: dumbbell, (5.1)", texts_of(figure))
        self.assertIn("1 of 12 runs failed: dumbbell, BGN", texts_of(figure))
        self.assertEqual(len(lines_of(figure.axes[0])), 3)

    def test_small_tables_give_what_they_have(self):
        self.assertEqual(len(draw([motion_row("ellipsoid", "dziuk", "none")]).axes), 2)
        for row in (motion_row("cube", "dziuk", "none"), motion_row("ellipsoid", "dziuk", "none", series={"t": [0]})):
            with self.assertRaisesRegex(TableError, "no series worst_angle"):
                draw([row])

    def test_the_script_writes_files(self):
        with tempfile.TemporaryDirectory() as folder:
            result = run_script("tangential_motion", motion_table(), folder)
            self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
            self.assertEqual(sorted(os.listdir(folder + "/figures/gallery")),
                             [f"tangential_motion{name}.{kind}" for name in ("", "_willmore") for kind in ("pdf", "png")])


if __name__ == "__main__":
    unittest.main()
