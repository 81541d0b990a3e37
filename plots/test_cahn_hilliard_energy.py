# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of cahn_hilliard_energy.py."""
import math
import os
import tempfile
import unittest

import numpy as np

import cahn_hilliard_energy
from table import SCHEMA, TableError
from testing import lines_of, run_script, texts_of


def energy_row(nodes, end=1.0, bdf=2, **changes):
    t = np.linspace(0, end, 501)
    energy = 10 + 20 * np.exp(-10 * t) + np.sin(10 * math.pi * t) + 30 / nodes
    row = {"cell": f"bdf{bdf}_{nodes}", "labels": {"bdf": bdf}, "level": 1, "h": 1 / math.sqrt(nodes), "nodes": nodes,
           "tau": 1e-4, "steps": round(end / 1e-4), "status": "ok", "errors": {},
           "series": {"t": t.tolist(), "energy": energy.tolist()}}
    return {**row, **changes}


def energy_table(rows):
    return {"schema": SCHEMA, "experiment": "cahn_hilliard_energy", "paper": "bk22", "parameters": {"epsilon": 0.1},
            "rows": rows}


class Energy(unittest.TestCase):
    def test_a_line_for_each_mesh_from_coarse_to_fine(self):
        rows = [energy_row(nodes) for nodes in (2500, 54, 120, 10146)] + [energy_row(270, 0.2), energy_row(54, bdf=1)]
        figures = dict(cahn_hilliard_energy.draw(energy_table(rows), ""))
        self.assertEqual(list(figures), ["bk22/fig6", "bk22/fig7"])
        for name, end, labels in (("bk22/fig6", 0.2, ["54", "120", "270", "2{,}500", "10{,}146"]),
                                  ("bk22/fig7", 1, ["54", "120", "2{,}500", "10{,}146"])):
            axes, = figures[name].axes
            self.assertEqual(len(axes.child_axes), 1 if end == 1 else 0)
            self.assertEqual(axes.get_xlim(), (0, end))
            self.assertEqual([text.get_text() for text in axes.get_legend().get_texts()],
                             [f"$N = {label}$" for label in labels])
            for line in lines_of(axes):
                self.assertLessEqual(line.get_xdata().max(), end * (1 + 1e-9))
            self.assertGreater(min(line.get_xdata().max() for line in lines_of(axes)), 0.19)
            self.assertEqual(len({line.get_marker() for line in axes.lines}), len(labels))
            for inset in axes.child_axes:
                self.assertEqual((inset.get_xlim(), len(lines_of(inset))), ((0.4, 1), 3))
                late = [line.get_ydata() for line in lines_of(inset)][-1]
                self.assertTrue(inset.get_ylim()[0] < late.min() < late.max() < inset.get_ylim()[1])
            self.assertEqual(texts_of(figures[name]), r"BDF2, $\tau = 10^{-4}$, $\varepsilon = 0.1$")

    def test_failed_runs_are_noted_and_of_runs_alike_that_with_the_smallest_step_counts(self):
        rows = [energy_row(54, tau=2e-4), energy_row(54, cell="fine", tau=5e-5),
                energy_row(120, status="failed: why", series={})]
        figure = dict(cahn_hilliard_energy.draw(energy_table(rows), ""))["bk22/fig6"]
        self.assertEqual(len(lines_of(figure.axes[0])), 1)
        self.assertIn(r"$\tau = 5\cdot 10^{-5}$", texts_of(figure))
        self.assertIn(r"1 of 3 runs failed: $N = 120$ with $\tau$ = 0.0001.", texts_of(figure))

    def test_small_tables_give_what_they_have(self):
        rows = [energy_row(54, 0.05)]
        self.assertEqual(list(dict(cahn_hilliard_energy.draw(energy_table(rows), ""))), ["bk22/fig6"])
        for rows in ([energy_row(54, bdf=1)], [energy_row(54, series={})]):
            with self.assertRaisesRegex(TableError, "no energies with BDF2"):
                list(cahn_hilliard_energy.draw(energy_table(rows), ""))

    def test_the_script_writes_files(self):
        with tempfile.TemporaryDirectory() as folder:
            result = run_script("cahn_hilliard_energy", energy_table([energy_row(54)]), folder)
            self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
            self.assertEqual(sorted(os.listdir(folder + "/figures/bk22")),
                             ["fig6.pdf", "fig6.png", "fig7.pdf", "fig7.png"])


if __name__ == "__main__":
    unittest.main()
