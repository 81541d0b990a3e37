# SPDX-License-Identifier: GPL-3.0-or-later
import math
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import meshio
import numpy as np
from matplotlib.image import imread

import paraview  # plots/paraview.py, not ParaView's package
import testing

SCRIPT = os.path.join(testing.FOLDER, "paraview.py")


def pvpython():
    """The command that runs the script with ParaView, or None and what is missing."""
    if not shutil.which("pvpython"):
        return None, "ParaView (pvpython) is not installed"
    if os.environ.get("DISPLAY"):
        return ["pvpython"], ""
    if not shutil.which("xvfb-run"):
        return None, "there is neither a display nor xvfb-run"
    return ["xvfb-run", "-a", "-s", "-noreset", "pvpython"], ""


def run(command, *arguments):
    return subprocess.run([*command, SCRIPT, *arguments], capture_output=True, text=True, check=False)


class WithoutParaView(unittest.TestCase):
    def complaint(self, *arguments):
        done = run([sys.executable, "-I", "-S"], *arguments)  # a Python without packages
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr.count("\n"), 1)
        return done.stderr

    def test_one_line_says_what_is_needed(self):
        self.assertRegex(self.complaint("run.pvd"), "expected pvpython .*python3-paraview")
        self.assertRegex(self.complaint("run.pvd", "--output", "a.pdf"), "found a.pdf, expected .* ends in .png")
        self.assertRegex(self.complaint("run.pvd", "--output", "/nowhere/a.png"), "expected a folder /nowhere")
        self.assertRegex(self.complaint("run.pvd", "--feld", "H"), "--feld H .*--help lists")

    def test_nearest_time(self):
        times = [0.0, 0.1, 0.3]
        self.assertEqual([paraview.nearest(times, wanted) for wanted in ("last", "0", "0.12", "9")], [0.3, 0, 0.1, 0.3])
        self.assertIsNone(paraview.nearest([], "last"))
        with self.assertRaisesRegex(paraview.InputError, "found 'end', expected a number or last"):
            paraview.nearest(times, "end")

    def test_the_longest_extent_is_across(self):
        self.assertEqual(paraview.directions((-1, 1, -3, 3, -2, 2)), [1, 2, 0])
        self.assertEqual(paraview.directions((-1, 1, -1, 1.0000001, -1, 1)), [0, 1, 2], "a sphere, up to its mesh")


class WithParaView(unittest.TestCase):
    def test_picture_of_a_sphere(self):
        command, missing = pvpython()
        if missing:
            print(f"test_paraview: {missing}: no picture is drawn", file=sys.stderr)
            self.skipTest(missing)
        ball = testing.sphere(1)
        with tempfile.TemporaryDirectory() as folder:
            file, picture = folder + "/ball.vtu", folder + "/ball.png"
            meshio.write(file, meshio.Mesh(ball.points, [("triangle6", ball.triangles)],
                                           {"H": ball.points[:, 2], "nu": np.array(ball.points)}))
            done = run(command, file)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stdout.splitlines()[-1], picture)
            image = imread(picture)
            self.assertEqual(image.shape[1::-1], paraview.SIZE)
            covered = np.any(image[80:-180, :, :3] < 1, axis=2)  # between the caption and the colour bar
            disc = covered.sum() / covered.any(axis=0).sum()**2
            self.assertAlmostEqual(disc, math.pi / 4, delta=0.01, msg="flat elements would make a polygon, about 0.7")
            done = run(command, file, "--field", "u")
            self.assertEqual(done.returncode, 1)
            self.assertIn("found 'u', expected one of H, nu", done.stderr)


if __name__ == "__main__":
    unittest.main()
