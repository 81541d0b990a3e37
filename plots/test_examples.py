# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of examples.py."""
import os
import tempfile
import unittest

import meshio

import examples
from surfaces import view
from table import TableError
from testing import sphere, texts_of

PVD = '''<?xml version="1.0"?><VTKFile type="Collection"><Collection>
<DataSet timestep="0" file="s_0000.vtu"/><DataSet timestep="0.25" file="s_0001.vtu"/></Collection></VTKFile>'''


class Examples(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.collection = os.path.join(folder.name, "s.pvd")
        with open(self.collection, "w", encoding="utf-8") as file:
            file.write(PVD)
        for number in range(2):
            surface = sphere(0)
            mesh = meshio.Mesh(surface.points, [("triangle6", surface.triangles)], {"u": surface.points[:, 0]})
            meshio.write(os.path.join(folder.name, f"s_000{number}.vtu"), mesh)

    def test_a_picture_has_every_time_and_the_field(self):
        files = examples.snapshots(self.collection)
        self.assertEqual([t for t, _ in files], [0, 0.25])
        figure = examples.picture(files, "u", "$u$", view(0))
        self.assertEqual(texts_of(figure), "$t = 0$ $t = 0.25$")
        self.assertEqual(figure.axes[-1].get_ylabel(), "$u$")
        self.assertEqual(len(examples.picture(files, None, "", view(0)).axes), 2)

    def test_what_is_missing_or_damaged_is_named(self):
        for text in (None, "<VTKFile>", '<VTKFile><DataSet timestep="x" file="f"/></VTKFile>'):
            if text is None:
                os.remove(self.collection)
            else:
                with open(self.collection, "w", encoding="utf-8") as file:
                    file.write(text)
            with self.assertRaisesRegex(TableError, "s.pvd: no collection of snapshots .*run make samples"):
                examples.snapshots(self.collection)


if __name__ == "__main__":
    unittest.main()
