# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of mcf_sphere.py."""
import unittest

from mcf_sphere import QUANTITIES, draw, drawn_rows
from table import TableError
from testing import references, sphere_figures, synthetic_table


def labels(run="convergence", flow="mean_curvature", bdf=3, start="exact"):
    return {"run": run, "flow": flow, "bdf": bdf, "start": start}


class Sphere(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.figures = sphere_figures()

    def test_a_faster_order_is_drawn_only_where_the_data_follow_it(self):
        named = [[line.get_gid() for line in references(axes)] for axes in self.figures["kll19/fig13_2"].axes]
        expected = [["reference $O(h^{%d})$" % p for p in (faster, 2)] for faster in (3, 3, 3, 4)]
        self.assertEqual(named, expected)
        slow = synthetic_table()
        for row in slow["rows"]:
            row["errors"] = {quantity: {"nodal_H1": row["h"]**2} for quantity in QUANTITIES}
        for axes in dict(draw(slow, "nodal_H1"))["kll19/fig13_2"].axes:
            self.assertEqual([line.get_gid() for line in references(axes)], ["reference $O(h^{2})$"])

    def test_theory_follows_degree_and_bdf_order_of_the_table(self):
        table = synthetic_table()
        table["parameters"] = {"degree": 3}
        for row in table["rows"]:
            row["labels"] = labels(bdf=4)
        figures = dict(draw(table, "nodal_H1"))
        self.assertIn("O(\\tau^{4})", references(figures["kll19/fig13_1"].axes[0])[0].get_gid())
        self.assertIn("O(h^{3})", references(figures["kll19/fig13_2"].axes[0])[-1].get_gid())


    def test_drawn_are_the_runs_of_one_variant(self):
        exact, cascade = [{"labels": labels()}] * 3, [{"labels": labels(start="cascade")}] * 2
        dziuk = [{"labels": labels(flow="dziuk")}] * 4
        cost = [{"labels": labels(run="cost")}] * 5
        self.assertEqual(drawn_rows([*cost, *dziuk, *cascade, *exact]), exact)
        self.assertEqual(drawn_rows([*cost, *dziuk, *cascade]), cascade)
        self.assertEqual(drawn_rows([*cost, *dziuk]), dziuk)
        self.assertEqual(drawn_rows(cost), [])
        with self.assertRaises(TableError):
            dict(draw({"rows": cost}, "nodal_H1"))


if __name__ == "__main__":
    unittest.main()
