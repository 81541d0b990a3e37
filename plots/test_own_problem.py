# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of the pictures of a run of evolve."""
import os
import tempfile
import unittest

import own_problem
from table import TableError

PVD = ('<VTKFile type="Collection"><Collection><DataSet timestep="0" file="a_0.vtu"/><DataSet timestep="0.5" file="a_1.vtu"/>'
       "</Collection></VTKFile>")


class OwnProblem(unittest.TestCase):
    def collection(self, words):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = os.path.join(folder.name, "a.pvd")
        with open(path, "w", encoding="utf-8") as file:
            file.write(words)
        return path

    def test_files_of_a_collection(self):
        path = self.collection(PVD)
        self.assertEqual(own_problem.files_of(path), [(t, os.path.join(os.path.dirname(path), name)) for t, name in ((0, "a_0.vtu"), (0.5, "a_1.vtu"))])

    def test_what_is_no_collection_is_an_error(self):
        for wrong in ("", "no XML", PVD.replace('"0.5"', '"late"'), PVD.replace("timestep", "step")):
            with self.assertRaises(TableError):
                own_problem.files_of(self.collection(wrong))


if __name__ == "__main__":
    unittest.main()
