# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of convert_mesh.py."""
import contextlib
import io
import os
import sys
import tempfile
import unittest
from unittest import mock

import meshio
import numpy as np

import convert_mesh

# A curved tetrahedron: corners and the nodes of its edges.
CORNERS = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) / 3
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def lagrange_tetrahedron(degree):
    """(points, cells) of the surface of a tetrahedron, each face with nodes of its own."""
    lattice = {1: [], 2: [(1, 1, 0), (0, 1, 1), (1, 0, 1)],
               3: [(2, 1, 0), (1, 2, 0), (0, 2, 1), (0, 1, 2), (1, 0, 2), (2, 0, 1), (1, 1, 1)],
               4: [(3, 1, 0), (2, 2, 0), (1, 3, 0), (0, 3, 1), (0, 2, 2), (0, 1, 3), (1, 0, 3), (2, 0, 2), (3, 0, 1),
                   (2, 1, 1), (1, 2, 1), (1, 1, 2)]}[degree]
    weights = np.vstack([np.eye(3), np.reshape(lattice, (-1, 3)) / degree])
    points = np.vstack([weights @ CORNERS[face] for face in FACES])
    return points, np.arange(len(points)).reshape(4, -1)


class ConvertMesh(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = holder.name
        self.output = os.path.join(self.folder, "out.msh")

    def run_script(self, *arguments):
        """(exit code, what it says)."""
        said = io.StringIO()
        with mock.patch.object(sys, "argv", ["convert_mesh.py", *arguments]), contextlib.redirect_stderr(said), \
                contextlib.redirect_stdout(io.StringIO()):
            try:
                convert_mesh.main()
            except SystemExit as end:
                return 1, f"{said.getvalue()}{end.code}\n"
        return 0, said.getvalue()

    def convert(self, mesh, name):
        """What the script says of a mesh written under a name, which it must convert."""
        path = os.path.join(self.folder, name)
        mesh.write(path)
        code, said = self.run_script(path, self.output)
        self.assertEqual(code, 0, said)
        return said

    def assert_refused(self, path, *parts, output=None):
        code, said = self.run_script(os.path.join(self.folder, path), output or self.output)
        self.assertEqual(code, 1)
        for part in parts:
            self.assertIn(part, said)
        self.assertFalse(os.path.exists(self.output))

    def test_triangles_and_point_data_to_the_last_bit(self):
        points, cells = lagrange_tetrahedron(2)
        data = {"u": points[:, 0] / 7, "nu": points / 3, "n": np.arange(len(points), dtype=np.int32)}
        for name in ("in.vtu", "in.vtk"):
            with self.subTest(name):
                said = self.convert(meshio.Mesh(points, [("triangle6", cells)], point_data=data), name)
                self.assertEqual(said, "")
                found = meshio.read(self.output)
                np.testing.assert_array_equal(found.points, points)
                np.testing.assert_array_equal(found.cells_dict["triangle6"], cells)
                for key, values in data.items():
                    np.testing.assert_array_equal(found.point_data[key], values)

    def test_lagrange_triangles(self):
        for degree, kind in ((3, "triangle10"), (4, "triangle15")):
            points, cells = lagrange_tetrahedron(degree)
            self.convert(meshio.Mesh(points, [("VTK_LAGRANGE_TRIANGLE", cells)]), "in.vtu")
            np.testing.assert_array_equal(meshio.read(self.output).cells_dict[kind], cells)

    def test_several_blocks_of_cells(self):
        points, cells = lagrange_tetrahedron(1)
        volume = meshio.Mesh(CORNERS, [("tetra", [[0, 1, 2, 3]]), ("triangle", FACES)])
        for mesh, name in ((meshio.Mesh(points, [("triangle", cells[:1]), ("triangle", cells[1:])]), "in.inp"),
                           (volume, "in.vtu")):
            with self.subTest(name):
                self.assertEqual(self.convert(mesh, name), "")
                found = meshio.read(self.output)
                np.testing.assert_array_equal(found.points, mesh.points)
                for kind, expected in mesh.cells_dict.items():
                    np.testing.assert_array_equal(found.cells_dict[kind], expected)
                self.assertEqual(set(found.cells_dict), set(mesh.cells_dict))

    def test_other_cells_and_data_are_skipped_with_a_remark(self):
        points, cells = lagrange_tetrahedron(1)
        mesh = meshio.Mesh(points, [("line", cells[:, :2]), ("triangle", cells), ("line", cells[:, 1:])],
                           point_data={"F": np.zeros((len(points), 9))})
        said = self.convert(mesh, "in.vtu")
        self.assertIn("8 cells of type line skipped", said)
        self.assertIn("point data F skipped", said)
        found = meshio.read(self.output)
        self.assertEqual([block.type for block in found.cells], ["triangle"])
        self.assertNotIn("F", found.point_data)

    def test_what_cannot_be_converted(self):
        self.assert_refused("missing.vtk", "missing.vtk: no such file")
        with open(os.path.join(self.folder, "rubbish.vtk"), "w", encoding="utf-8") as file:
            file.write("rubbish\n")
        self.assert_refused("rubbish.vtk", "meshio cannot read it", "ParaView saves as PLY")
        points, cells = lagrange_tetrahedron(1)
        meshio.Mesh(points, [("line", cells[:, :2])]).write(os.path.join(self.folder, "lines.vtu"))
        self.assert_refused("lines.vtu", "4 cells of type line skipped", "no cell that evolve reads")
        self.assert_refused("lines.vtu", "ending .msh expected", output=os.path.join(self.folder, "out.vtu"))
        self.assertEqual(sorted(os.listdir(self.folder)), ["lines.vtu", "rubbish.vtk"])


if __name__ == "__main__":
    unittest.main()
