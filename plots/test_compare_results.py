# SPDX-License-Identifier: GPL-3.0-or-later
"""compare_results.py sees what differs, and nothing else."""
import copy
import unittest

from compare_results import Comparison

TABLE = {
    "rows": [
        {"cell": "a", "status": "ok", "errors": {"x": {"nodal_L2": 1e-3, "nodal_H1": 1e-15}},
         "series": {"t": [0, 1], "energy": [2.0, 1.0]}},
        {"cell": "b", "status": "singular at t = 0.1: |H| h", "errors": {}},
    ],
    "fits": [{"quantity": "x", "norm": "nodal_L2", "variable": "h", "order": 2.0512}],
}


class CompareResults(unittest.TestCase):
    def compare(self, change):
        after = copy.deepcopy(TABLE)
        change(after)
        return Comparison(TABLE, after, 1e-9)

    def test_equal_tables(self):
        found = self.compare(lambda table: None)
        self.assertEqual((found.error[0], found.series[0], found.differences), (0.0, 0.0, []))
        self.assertEqual(found.errors, 2)

    def test_errors_and_round_off(self):
        def change(table):
            table["rows"][0]["errors"]["x"] = {"nodal_L2": 1.001e-3, "nodal_H1": 3e-15}
        found = self.compare(change)
        self.assertAlmostEqual(found.error[0], 1e-3, places=5)
        self.assertEqual(found.error[1], "a, x nodal_L2")

    def test_an_error_that_is_gone_or_is_no_number(self):
        for value in (None, float("nan")):
            found = self.compare(lambda table: table["rows"][0]["errors"]["x"].update(nodal_L2=value))
            self.assertEqual(found.error[0], float("inf"))

    def test_series(self):
        found = self.compare(lambda table: table["rows"][0]["series"].update(energy=[2.0, 1.2]))
        self.assertAlmostEqual(found.series[0], 0.1)

    def test_status_rows_and_orders(self):
        self.assertIn("b: was singular", self.compare(lambda t: t["rows"][1].update(status="ok")).differences[0])
        self.assertEqual(self.compare(lambda t: t["rows"][1].update(status="singular at t = 0.2: x")).differences, [])
        self.assertEqual(self.compare(lambda t: t["rows"].pop()).differences, ["b: no such row any more"])
        self.assertIn("was 2.0512, is 2.0600", self.compare(lambda t: t["fits"][0].update(order=2.06)).differences[0])


if __name__ == "__main__":
    unittest.main()
