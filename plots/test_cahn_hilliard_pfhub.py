# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of cahn_hilliard_pfhub.py."""
import os
import tempfile
import unittest

import meshio
import numpy as np

import cahn_hilliard_pfhub
from snapshots import Snapshots
from table import TableError
from testing import data_lines, limits_of, run_script, sphere, texts_of

TIMES = np.concatenate([[0], np.geomspace(1e-2, 2e5, 30)])


def make_row(cell, nodes, labels, end=2e5, **more):
    t = [float(value) for value in TIMES[TIMES <= end]]
    return {"cell": cell, "h": 6.7, "nodes": nodes, "tau": 0.01, "steps": 30, "status": "ok", "errors": {},
            "labels": {"stepping": "adaptive", "degree": 1, "bdf": 2, **labels},
            "series": {"t": t, "energy": [1000 / (1 + value)**0.3 for value in t]}, **more}


def failed(cell):
    return {"cell": cell, "status": "failed: diverged", "errors": {}}


def table_of(rows):
    return {"schema": "esfem-table/1", "experiment": cahn_hilliard_pfhub.STEM, "paper": "pfhub", "parameters": {},
            "rows": rows}


ROWS = [make_row("a", 5891, {"tolerance": 0.001}), make_row("b", 11846, {"tolerance": 0.002, "degree": 2}),
        make_row("c", 5891, {"stepping": "moose", "bdf": 1, "tolerance": 1e-9}, end=31)]


class Energies(unittest.TestCase):
    def test_every_run_is_a_line_and_the_published_energies_are_markers(self):
        (name, figure), = cahn_hilliard_pfhub.draw(table_of([*ROWS, failed("d")]), "")
        self.assertEqual(name, "pfhub/fig1d")
        axes, = figure.axes
        labels = [text.get_text() for text in axes.get_legend().get_texts()]
        self.assertEqual(labels, ["$P_1$, $N = 5{,}891$, backward Euler, MOOSE's steps",
                                  "$P_1$, $N = 5{,}891$, BDF2, tol. $10^{-3}$",
                                  r"$P_2$, $N = 11{,}846$, BDF2, tol. $2\cdot 10^{-3}$", "MOOSE (PFHub)"])
        lines = data_lines(axes)
        self.assertEqual([len(line.get_xdata()) for line in lines[:3]], [sum((TIMES > 0) & (TIMES < 31)), 30, 30])
        self.assertEqual(list(lines[3].get_ydata()), [994.3, 763.0, 642.9, 412.4, 275.2, 179.5, 85.571])
        self.assertEqual(len({(line.get_color(), line.get_linestyle()) for line in lines[:3]}), 3)
        self.assertIn("1 of 4 runs failed: level 0 with", texts_of(figure))

    def test_a_great_circle_has_the_energy_of_its_tanh_profile(self):
        _, figure = next(cahn_hilliard_pfhub.draw(table_of(ROWS), ""))
        s = np.linspace(-40, 40, 20001)
        c = 0.5 + 0.2 * np.tanh(s / np.sqrt(5))
        density = 5 * (c - 0.3)**2 * (0.7 - c)**2 + np.gradient(c, s)**2
        energy = np.sum(density) * (s[1] - s[0]) * 2 * np.pi * 100
        self.assertAlmostEqual(limits_of(figure.axes[0])[0], energy, places=3)

    def test_no_energy_is_an_error(self):
        with self.assertRaisesRegex(TableError, "no run has the series energy"):
            list(cahn_hilliard_pfhub.draw(table_of([dict(ROWS[0], series={"t": [0.0]})]), ""))


class Pictures(unittest.TestCase):
    def write(self, folder, row, times):
        """Snapshots of a run as the experiment writes them."""
        row["snapshots"] = [{"t": t, "file": f"{i}.vtu"} for i, t in enumerate(times)]
        cell = os.path.join(folder, "cells", cahn_hilliard_pfhub.STEM, row["cell"])
        os.makedirs(cell)
        surface = sphere(1)
        for i in range(len(times)):
            meshio.Mesh(surface.points, [("triangle6", surface.triangles)],
                        point_data={"c": 0.5 + 0.2 * surface.points[:, 2]}).write(os.path.join(cell, f"{i}.vtu"))

    def test_the_published_resolution_and_the_finest_run_are_pictured(self):
        rows = [dict(row) for row in ROWS]
        with tempfile.TemporaryDirectory() as folder:
            for row in rows[:2]:
                self.write(folder, row, (0, 14.2, 5006, 2e5))
            self.assertEqual([row["cell"] for row in cahn_hilliard_pfhub._pictured(rows, folder)], ["a", "b"])
            (_, figure), = cahn_hilliard_pfhub.draw(table_of(rows), folder)
            self.assertEqual(len(figure.axes), 2 * 4 + 2)  # surfaces, colour bar, energies
            self.assertIn("$t = 14.2$ $t = 5{,}006$ $t = 200{,}000$", texts_of(figure))
            os.remove(Snapshots(rows[1], folder, cahn_hilliard_pfhub.STEM).files[2][1])
            with self.assertRaisesRegex(TableError, "2.vtu: no such snapshot"):
                list(cahn_hilliard_pfhub.draw(table_of(rows), folder))

    def test_the_command_line_writes_both_files(self):
        with tempfile.TemporaryDirectory() as folder:
            result = run_script(cahn_hilliard_pfhub.STEM, table_of(ROWS), folder)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertEqual(sorted(os.listdir(os.path.join(folder, "figures/pfhub"))), ["fig1d.pdf", "fig1d.png"])


if __name__ == "__main__":
    unittest.main()
