# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of table.py."""
import math
import unittest

import numpy as np

from table import TableError, read_table, series
from testing import FOLDER


class Table(unittest.TestCase):
    def test_read_table_raises_its_own_error(self):
        with self.assertRaises(TableError):
            read_table(FOLDER)

    def test_series_are_checked(self):
        row = {"cell": "h1", "series": {"t": [0, 1, 2], "h": [1, None, 3], "area": [1, 2], "tip": "abc"}}
        np.testing.assert_array_equal(series(row, "h"), ([0, 1, 2], [1, math.nan, 3]))
        self.assertIsNone(series(row, "volume"))
        for name in ("area", "tip"):
            with self.assertRaisesRegex(TableError, f"h1: the series {name}"):
                series(row, name)


if __name__ == "__main__":
    unittest.main()
