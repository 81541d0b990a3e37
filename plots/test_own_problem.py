# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of the pictures of a run of evolve."""
import contextlib
import io
import os
import tempfile
import unittest
import unittest.mock

import meshio
import numpy as np

import own_problem
import style
from table import TableError
from testing import sphere, texts_of

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

    def run_of_two(self):
        """A collection of two spheres with u = x and v = 3 x."""
        path, ball = self.collection(PVD), sphere(0)
        for i in range(2):
            meshio.write(f"{os.path.dirname(path)}/a_{i}.vtu", meshio.Mesh(
                ball.points, [("triangle6", ball.triangles)], point_data={"u": ball.points[:, 0], "v": 3 * ball.points}))
        return path

    def said(self, *arguments):
        """Standard output of the script."""
        said = io.StringIO()
        with unittest.mock.patch("sys.argv", ["own_problem.py", *arguments]), contextlib.redirect_stdout(said):
            own_problem.main()
        return said.getvalue()

    def test_files_of_a_collection(self):
        path = self.collection(PVD)
        self.assertEqual(own_problem.files_of(path), [(t, os.path.join(os.path.dirname(path), name)) for t, name in ((0, "a_0.vtu"), (0.5, "a_1.vtu"))])

    def test_what_is_no_collection_is_an_error(self):
        for wrong in ("", "no XML", PVD.replace('"0.5"', '"late"'), PVD.replace("timestep", "step"), "<VTKFile/>"):
            with self.assertRaises(TableError):
                own_problem.files_of(self.collection(wrong))

    def test_snapshots_are_chosen_by_time(self):
        files = [(t, str(t)) for t in (0, 0.001, 0.002, 0.003, 0.3, 0.7, 1)]
        self.assertEqual([t for t, _ in own_problem.nearest(files, own_problem.equal_times(files))], [0, 0.3, 0.7, 1])
        self.assertEqual([t for t, _ in own_problem.nearest(files, [0.8, 0.1, 0.002, 0.6])], [0.002, 0.003, 0.7])
        early = files[:2] + files[-1:]
        self.assertEqual([t for t, _ in own_problem.nearest(early, own_problem.equal_times(early))], [0, 0.001, 1])
        self.assertEqual(own_problem.times_of("0,0.1,5e-1"), [0, 0.1, 0.5])
        with self.assertRaisesRegex(TableError, "--times 0;1: expected numbers"):
            own_problem.times_of("0;1")

    def test_vectors_are_drawn_by_their_lengths(self):
        files = own_problem.files_of(self.run_of_two())
        for field, label, limits in (("u", "u", (-1, 1)), ("v", "|v|", (3, 3))):
            figure = own_problem.figure_of(files, field)
            self.assertEqual(figure.axes[-1].get_ylabel(), label)
            np.testing.assert_allclose(figure.axes[-1].get_ylim(), limits, atol=0.31)
            self.assertEqual(texts_of(figure), "$t = 0$ $t = 0.5$")
        with self.assertRaisesRegex(TableError, "no field w; there are u, v"):
            own_problem.figure_of(files, "w")

    def test_the_colour_bar_is_beside_few_pictures(self):
        figure = own_problem.figure_of(own_problem.files_of(self.run_of_two()), "u")
        first, last, bar = (axes.get_position() for axes in figure.axes)
        self.assertLess((bar.x0 - last.x1) * style.WIDTH, 0.2)
        self.assertLess(first.x0 * style.WIDTH, 0.05)
        self.assertLess(bar.x1, 0.75)  # and what is right of it is not saved

    def test_the_script_creates_folders_and_lists_fields(self):
        path = self.run_of_two()
        self.assertEqual(self.said(path), "u\nv (vectors, drawn by their lengths)\n")
        output = os.path.join(os.path.dirname(path), "new", "folder", "v.png")
        self.assertEqual(self.said(path, "v", output, "--times", "0.4"), "")
        self.assertTrue(os.path.getsize(output))
        with contextlib.redirect_stderr(io.StringIO()) as told:
            self.said(path, "v", output, "--times", "0.4,0.5,2")
        self.assertRegex(told.getvalue(), "pictures: 1 instead of 3; the times of .* are 0, 0.5\n$")
        for wrong, words in (((path, "u"), "expected OUTPUT.png"), ((path, "w", output), "no field w"),
                             ((path, "u", f"{output}.strange"), "strange")):
            with self.assertRaises(SystemExit) as end:
                self.said(*wrong)
            self.assertIn(words, str(end.exception.code))


if __name__ == "__main__":
    unittest.main()
