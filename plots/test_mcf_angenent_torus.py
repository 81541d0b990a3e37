# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of mcf_angenent_torus.py."""
import copy
import os
import tempfile
import unittest

import mcf_angenent_torus
from table import SCHEMA, TableError, label_of
from testing import data_lines, figure_named, run_script, slopes_of, texts_of


def torus_row(run, flow, degree, bdf, level, k, triangulation="grid"):
    h, tau = 1.03 * 2**(-level / 2), 0.02 * 2.0**-k
    space = 0 if run == "order" else (1 if flow == "mean_curvature" else 5) * 0.1 * h**degree
    errors = {q: {f"{kind}_{norm}": factor * (10 * tau**bdf + space * h**more) for kind in ("nodal", "lifted")
                  for norm, more in (("L2", 1), ("H1", 0))} for q, factor in (("x", 1), ("v", 5), ("nu", 2), ("H", 3))}
    if run == "order":
        errors = {q: {norm: e for norm, e in of.items() if norm.startswith("nodal")} for q, of in errors.items()}
    return {"cell": f"{run}_{flow}_{triangulation}_p{degree}_bdf{bdf}_h{level}_tau{k}",
            "labels": {"run": run, "flow": flow, "triangulation": triangulation, "degree": degree, "bdf": bdf},
            "level": level, "h": h, "nodes": round(288 * degree**2 * 2**level), "tau": tau, "steps": 10 * 2**k,
            "status": "ok", "errors": errors}


def torus_table():
    rows = [torus_row("convergence", "mean_curvature", degree, 3, level, k) for degree in (2, 3) for level in range(3)
            for k in (2, 3)]
    rows += [torus_row("convergence", "mean_curvature", 2, 3, level, 3, "unstructured") for level in range(2)]
    rows += [torus_row("convergence", "dziuk", 2, bdf, level, 3) for bdf in (1, 2, 3)
             for level in range(4 - (bdf == 3))]
    rows += [torus_row("order", flow, 2, bdf, 0, k) for flow in ("mean_curvature", "dziuk") for bdf in range(1, 6)
             for k in (2, 3, 4)]
    return {"schema": SCHEMA, "experiment": "mcf_angenent_torus", "paper": "esfem", "parameters": {}, "rows": rows}


class AngenentTorus(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.table = torus_table()
        cls.figures = dict(mcf_angenent_torus.draw(cls.table, "lifted_H1"))

    def test_schemes_are_drawn_with_their_smallest_step_sizes(self):
        self.assertEqual(list(self.figures), ["gallery/mcf_angenent_torus", "gallery/mcf_angenent_torus_time"])
        figure = self.figures["gallery/mcf_angenent_torus"]
        labels = [text.get_text() for text in figure.legends[0].get_texts()]
        self.assertEqual(set(labels), {"(5.1) $P_2$", "(5.1) $P_3$", "(5.1) $P_2$ unstructured", "Dziuk $P_2$"})
        for axes in figure.axes:
            self.assertEqual(sorted(len(line.get_xdata()) for line in data_lines(axes)), [2, 3, 3, 4])
        # Dziuk's scheme with BDF2: of those with the most meshes the highest order.
        self.assertIn(r"Dziuk $P_2$: BDF2, $\tau = 0.0025$", texts_of(figure))

    def test_theory_belongs_to_our_scheme_on_grids(self):
        self.assertEqual(slopes_of(self.figures["gallery/mcf_angenent_torus"]), [["$O(h^{2})$", "$O(h^{3})$"]] * 4)
        in_L2 = figure_named("gallery/mcf_angenent_torus", mcf_angenent_torus.draw(self.table, "lifted_L2"))
        self.assertEqual(slopes_of(in_L2), [["$O(h^{3})$", "$O(h^{4})$"]] * 4)

    def test_each_bdf_method_has_its_order(self):
        figure = self.figures["gallery/mcf_angenent_torus_time"]
        self.assertEqual([text.get_text() for text in figure.legends[0].get_texts()], [f"BDF{q}" for q in range(1, 6)])
        for slopes in slopes_of(figure):
            self.assertEqual(sorted(slopes), [r"$O(\tau)$", *(rf"$O(\tau^{{{q}}})$" for q in range(2, 6))])
        self.assertIn("at $t = 0.2$", figure.axes[0].get_ylabel())

    def test_failed_runs_are_counted(self):
        table = copy.deepcopy(self.table)
        table["rows"][0] = {**table["rows"][0], "status": "failed: singular", "errors": {}}
        figure = figure_named("gallery/mcf_angenent_torus", mcf_angenent_torus.draw(table, "lifted_H1"))
        self.assertIn("1 of ", texts_of(figure))

    def test_what_the_table_does_not_have_is_left_out(self):
        for kind, name in (("convergence", "gallery/mcf_angenent_torus"), ("order", "gallery/mcf_angenent_torus_time")):
            rows = [row for row in self.table["rows"] if label_of(row, "run") == kind]
            self.assertEqual(list(dict(mcf_angenent_torus.draw({"rows": rows}, "nodal_H1"))), [name])
        with self.assertRaises(TableError):
            list(mcf_angenent_torus.draw({"rows": [{**self.table["rows"][0], "labels": {"run": "other"}}]}, "nodal_H1"))

    def test_the_script_writes_the_figures(self):
        with tempfile.TemporaryDirectory() as folder:
            done = run_script("mcf_angenent_torus", self.table, folder)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertTrue(os.path.exists(f"{folder}/figures/gallery/mcf_angenent_torus.png"))
            empty = run_script("mcf_angenent_torus", {**self.table, "rows": []}, folder)
            self.assertEqual((empty.returncode, len(empty.stderr.splitlines())), (1, 1))


if __name__ == "__main__":
    unittest.main()
