# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of willmore_clifford_torus.py."""
import math
import os
import tempfile
import unittest

import willmore_clifford_torus
from table import SCHEMA, TableError
from testing import data_lines, run_script, slopes_of, texts_of
from willmore import TORUS


def torus_row(level, k, size, **labels):
    """Errors of order 2.5 in h and 1 in tau."""
    h, tau = 0.6 * 2**(-level / 2), 0.2 * 2.0**-k
    error = size * (h**2.5 + 0.05 * tau)
    errors = {q: {"nodal_H1": c * error, "lifted_H1": 1.1 * c * error} for q, c in (("x", 0.1), ("nu", 0.3), ("H", 1))}
    return {"cell": "_".join(map(str, labels.values())) + f"_h{level}_tau{k}", "level": level, "h": h,
            "nodes": 1000 * 2**level, "tau": tau, "steps": 5 * 2**k, "status": "ok", "errors": errors, "labels": labels,
            "values": {"willmore_energy": TORUS[0] * (1 - 0.05 * h**3)}}


def torus_table(levels=4, exponents=6):
    rows = [torus_row(level, k, size, run="convergence", triangulation=mesh, F="extrapolated", bdf=1, theta="no")
            for mesh, size in (("isothermal", 1), ("graded", 7)) for level in range(levels) for k in range(exponents)]
    rows.append(torus_row(0, 0, 50, run="convergence", triangulation="isothermal", F="implicit", bdf=1, theta="no"))
    rows.append(torus_row(0, 0, 60, run="convergence", triangulation="isothermal", F="extrapolated", bdf=1, theta="yes"))
    rows.append(torus_row(0, 0, 70, run="convergence", triangulation="isothermal", F="extrapolated", bdf=2, theta="no"))
    for F in ("extrapolated", "implicit"):
        for bdf in (1, 2):
            for k in range(exponents):
                row = torus_row(1, k, 1, run="stability", triangulation="graded", F=F, bdf=bdf)
                if (F == "implicit") != (bdf == 2) and k < 3:
                    row.update(status=f"failed: step {k}, t = {0.31 * (k + 1):g}: element 17 is degenerate", errors={},
                               values={}, h=0, nodes=0)
                rows.append(row)
    return {"schema": SCHEMA, "experiment": "willmore_clifford_torus", "paper": "kll21", "parameters": {"degree": 2},
            "rows": rows}


def cells_of(figure):
    """{cell: text} of the little tables."""
    return {text.get_gid(): text.get_text() for axes in figure.axes for text in axes.texts}


class CliffordTorus(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.table = torus_table()
        cls.figures = dict(willmore_clifford_torus.draw(cls.table, "nodal_H1"))

    def test_figure_7_4_has_the_isothermal_grids_and_extrapolated_F(self):
        self.assertEqual(list(self.figures), ["kll21/fig7_4", "gallery/clifford_torus_graded", "gallery/clifford_torus_stability"])
        figure = self.figures["kll21/fig7_4"]
        self.assertEqual([len(data_lines(axes)) for axes in figure.axes], [6] * 4)
        shown = max(line.get_ydata().max() for line in data_lines(figure.axes[0]))
        self.assertEqual(shown, self.table["rows"][0]["errors"]["x"]["nodal_H1"])
        self.assertEqual(slopes_of(figure), [["$O(h^{2})$"]] * 3 + [[]])
        self.assertEqual(figure.axes[3].get_title(), r"$|W - 4\pi^2|$, $t = 1$")
        finest = data_lines(figure.axes[3])[0].get_ydata()[0]
        self.assertAlmostEqual(finest, 4 * math.pi**2 * 0.05 * (0.6 * 2**-1.5)**3)

    def test_stability_says_the_error_or_when_it_failed(self):
        figure = self.figures["gallery/clifford_torus_stability"]
        axes, = figure.axes
        cells = cells_of(figure)
        self.assertEqual(len(cells), 24)
        row = next(row for row in self.table["rows"] if row["cell"] == "stability_graded_implicit_2_h1_tau0")
        self.assertAlmostEqual(row["errors"]["x"]["nodal_H1"], 1.3e-2, delta=0.5e-3)
        self.assertEqual(cells[row["cell"]], r"$1.3\cdot 10^{-2}$")
        self.assertEqual(cells["stability_graded_implicit_1_h1_tau1"], "$t = 0.62$")
        self.assertEqual([label.get_text() for label in axes.get_yticklabels()],
                         ["BDF1, $F$ extrapolated", "BDF2, $F$ extrapolated", "BDF1, $F$ implicit",
                          "BDF2, $F$ implicit"])
        self.assertEqual([label.get_text() for label in axes.get_xticklabels()],
                         ["0.2", "0.1", "0.05", "0.025", "0.0125", "0.00625"])
        self.assertEqual(axes.get_xlabel(), r"step size $\tau$")
        self.assertIn("$N = 2{,}000$, graded mesh", texts_of(figure))
        self.assertIn("$L^\\infty(H^1)$", texts_of(figure))
        failed = [patch for patch in axes.patches if patch.get_linewidth() and patch.get_edgecolor()[3] > 0]
        self.assertEqual(len(failed), 6)

    def test_every_mesh_has_its_own_table(self):
        table = torus_table(2, 3)
        table["rows"] += [torus_row(2, k, 1, run="stability", F="implicit", bdf=1) for k in range(3)]
        table["rows"] += [{**torus_row(3, 0, 1, run="stability", F="implicit", bdf=1), "status": "failed: why"}]
        figure = dict(willmore_clifford_torus.draw(table, "nodal_H1"))["gallery/clifford_torus_stability"]
        self.assertEqual([len(axes.texts) for axes in figure.axes], [12, 3, 1])
        self.assertIn("$N = 4{,}000$ mesh 3", texts_of(figure))
        self.assertEqual(figure.axes[2].texts[0].get_text(), "failed")

    def test_small_and_failed_tables(self):
        for levels, exponents in ((1, 1), (2, 1)):
            self.assertEqual(len(dict(willmore_clifford_torus.draw(torus_table(levels, exponents), "lifted_H1"))), 3)
        table = torus_table(1, 2)
        for row in table["rows"]:
            row.update(status="failed: why", errors={}, values={})
        figures = dict(willmore_clifford_torus.draw(table, "nodal_H1"))
        self.assertIn("None of 2 runs finished.", texts_of(figures["kll21/fig7_4"]))
        self.assertEqual(set(cells_of(figures["gallery/clifford_torus_stability"]).values()), {"failed"})
        row = torus_row(0, 0, 1, run="stability", F="implicit", bdf=1)
        for errors in ({}, {"x": {"nodal_H1": None}}):
            figure, = dict(willmore_clifford_torus.draw({"rows": [{**row, "errors": errors}]}, "nodal_H1")).values()
            self.assertEqual(list(cells_of(figure).values()), ["done"])
        with self.assertRaisesRegex(TableError, "no rows with run"):
            list(willmore_clifford_torus.draw({"rows": [{**row, "labels": {"run": "other"}}]}, "nodal_H1"))

    def test_the_script_writes_files(self):
        with tempfile.TemporaryDirectory() as folder:
            result = run_script("willmore_clifford_torus", torus_table(2, 2), folder)
            self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
            written = sorted(os.path.relpath(os.path.join(root, name), folder + "/figures")
                             for root, _, names in os.walk(folder + "/figures") for name in names)
            self.assertEqual(written, [f"{name}.{kind}" for name in ("gallery/clifford_torus_graded",
                                                              "gallery/clifford_torus_stability", "kll21/fig7_4")
                                       for kind in ("pdf", "png")])


if __name__ == "__main__":
    unittest.main()
