# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of all_orders.py."""
import tempfile
import unittest

import all_orders
from all_orders import DEGREES, FLOWS, ORDERS, is_hidden, state_of
from table import SCHEMA, TableError, label_of
from testing import run_script


def row(flow, degree, bdf, kind, **changes):
    return {"cell": f"{flow}_p{degree}_bdf{bdf}_{kind}",
            "labels": {"flow": flow, "degree": degree, "bdf": bdf, "run": kind}, "h": 0.3, "nodes": 100, "tau": 0.1,
            "steps": 10, "status": "ok", "errors": {"x": {"nodal_H1": 1e-3}}, "values": {"unstable": 0}, **changes}


def fit(of, quantity, norm, variable, order):
    return {"quantity": quantity, "norm": norm, "variable": variable, "order": order, "ci95": [order, order],
            "rows_used": 3, "labels": of["labels"]}


def synthetic_table():
    """All as expected, but: Dziuk's scheme with BDF4 and 5 unstable, BDF1 in L2 hidden."""
    rows, fits = [], []
    for flow, (_, quantities) in FLOWS.items():
        for k in DEGREES:
            for q in ORDERS:
                unstable = flow == "dziuk" and q in (4, 5)
                time = row(flow, k, q, "time", values={"unstable": int(unstable)})
                space = row(flow, k, q, "space", values={"unstable": int(unstable)})
                rows += [time, space]
                for quantity in () if unstable else quantities:
                    fits.append(fit(time, quantity, "nodal_H1", "tau", q - 0.02))
                    fits.append(fit(space, quantity, "lifted_H1", "h", k + 0.04))
                    if q == 1:
                        space["values"][f"{quantity}_lifted_L2_hidden"] = 1e-4
                    else:
                        fits.append(fit(space, quantity, "lifted_L2", "h", k + 1.03))
    return {"schema": SCHEMA, "experiment": "all_orders", "paper": "esfem", "parameters": {}, "rows": rows, "fits": fits}


def draw(table):
    (name, figure), = all_orders.draw(table, None)
    assert name == "gallery/all_orders", name
    return figure


def cell_texts(figure, grid):
    """The texts of one grid by (row, column), from top to bottom."""
    axes, = (axes for axes in figure.axes if axes.get_gid() == grid)
    cells = {}
    for text in sorted(axes.texts, key=lambda text: text.get_position()[1]):
        x, y = text.get_position()
        cells.setdefault((int(y), int(x)), []).append(text.get_text())
    return cells


class AllOrders(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.table = synthetic_table()
        cls.figure = draw(cls.table)

    def test_three_grids_a_flow(self):
        self.assertEqual(len(self.figure.axes), 3 * len(FLOWS))

    def test_a_cell_says_the_order_of_each_quantity(self):
        cells = cell_texts(self.figure, "mean_curvature time nodal_H1")
        self.assertEqual(len(cells), 20)
        self.assertEqual(cells[1, 2], ["3.0"] * 4)  # P2, BDF3
        self.assertEqual(cell_texts(self.figure, "willmore space lifted_L2")[3, 4], ["5.0"] * 3)

    def test_unstable_and_hidden(self):
        self.assertEqual(cell_texts(self.figure, "dziuk time nodal_H1")[0, 3], ["unstable"])
        self.assertEqual(cell_texts(self.figure, "dziuk space lifted_H1")[2, 4], ["unstable"])
        self.assertEqual(cell_texts(self.figure, "dziuk space lifted_L2")[2, 0], ["hidden"])
        self.assertEqual(cell_texts(self.figure, "mean_curvature space lifted_L2")[0, 0], ["hidden"])
        legend, = self.figure.legends
        self.assertIn("all hidden by the error in time", [text.get_text() for text in legend.get_texts()])

    def test_the_legend_says_what_is_extrapolated_and_what_the_words_of_a_cell_mean(self):
        texts = " ".join(text.get_text() for text in self.figure.texts)
        for word in ("extrapolated", "hidden:", "–:"):
            self.assertIn(word, texts)

    def test_one_hidden_quantity_beside_an_order(self):
        table = synthetic_table()
        table["fits"] = [f for f in table["fits"] if not (f["quantity"] == "w" and label_of(f, "run") == "space")]
        for each in table["rows"]:
            if label_of(each, "flow") == "cahn_hilliard":
                each["values"]["w_lifted_H1_hidden"] = 1
        self.assertEqual(cell_texts(draw(table), "cahn_hilliard space lifted_H1")[0, 2], ["1.0", "hidden"])

    def test_colour_says_what_is_too_low(self):
        table = synthetic_table()
        for each in table["fits"]:
            if (label_of(each, "flow"), label_of(each, "run")) == ("willmore", "time"):
                each["order"] -= 1
            if (label_of(each, "flow"), label_of(each, "run")) == ("cahn_hilliard", "time"):
                each["order"] += 3
        low, right, high = (next(axes for axes in draw(table).axes if axes.get_gid() == f"{flow} time nodal_H1").patches[7]
                      for flow in ("willmore", "mean_curvature", "cahn_hilliard"))
        self.assertLess(sum(low.get_facecolor()[:3]), sum(right.get_facecolor()[:3]) - 0.5)
        self.assertGreater(high.get_facecolor()[2], high.get_facecolor()[0])  # blue

    def test_part_of_the_grid(self):
        table = synthetic_table()
        table["rows"] = [r for r in table["rows"]
                         if r["labels"] == {**r["labels"], "flow": "willmore", "degree": 2, "bdf": 2}]
        figure = draw(table)
        self.assertEqual(len(figure.axes), 3)
        self.assertEqual(list(cell_texts(figure, "willmore space lifted_H1")), [(1, 1)])

    def test_states(self):
        self.assertEqual(state_of([]), "missing")
        self.assertEqual(state_of([row("dziuk", 1, 1, "time", status="failed: why")]), "failed")
        self.assertEqual(state_of([row("dziuk", 1, 1, "time", values={"unstable": 1})]), "unstable")
        self.assertEqual(state_of([row("dziuk", 1, 1, "time")]), "ok")
        self.assertFalse(is_hidden([row("dziuk", 1, 1, "space")], "x", "lifted_H1"))

    def test_command_line(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(run_script("all_orders", self.table, folder).returncode, 0)
            bad = dict(self.table, rows=[row("none", 1, 1, "time")])
            answer = run_script("all_orders", bad, folder)
            self.assertEqual(answer.returncode, 1)
            self.assertEqual(answer.stderr.count("\n"), 1)

    def test_nothing_to_draw(self):
        with self.assertRaises(TableError):
            draw({"rows": [row("none", 1, 1, "time")], "fits": []})


if __name__ == "__main__":
    unittest.main()
