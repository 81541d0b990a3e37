# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of surfaces.py."""
import math
import pathlib
import tempfile
import unittest

import meshio
import numpy as np
from matplotlib.figure import Figure

import surfaces
from surfaces import Surface, read_surface, view
from table import TableError
from testing import sphere


def polygons_drawn(surface, **options):
    """What draw_surface paints, in its order: polygons as (k, 2) arrays, without the repeated first point."""
    axes = Figure().add_axes([0, 0, 1, 1])
    surfaces.draw_surface(axes, surface, view(0), **options)
    return [path.vertices[:-1] for path in axes.collections[0].get_paths()]


class Surfaces(unittest.TestCase):
    def test_the_view_is_a_rotation(self):
        for angles in ((0,), (18,), (-130, 25), (90, -90)):
            np.testing.assert_allclose(view(*angles) @ view(*angles).T, np.eye(3), atol=1e-15)
            self.assertAlmostEqual(np.linalg.det(view(*angles)), 1)
        np.testing.assert_allclose(view(0)[0], [0, 0, 1], atol=1e-15)  # x3 to the right
        self.assertLess(view(18)[2] @ [0, 0, 1], -0.1)  # x3 also goes away: its lower end is shown

    def test_upright_views_have_x3_upwards_and_the_longer_axis_across(self):
        ball = sphere(1)
        for axes, longest in (([2, 1, 1], 0), ([1, 2, 1], 1)):
            rotation = surfaces.upright_view(Surface(ball.points * axes, ball.triangles, {}), 30)
            np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-15)
            self.assertGreater(rotation[1] @ [0, 0, 1], 0.8)
            self.assertGreater(rotation[2] @ [0, 0, 1], 0.4)  # seen from above
            self.assertGreater(abs(rotation[0, longest]), 0.9)

    def test_the_lattice_fills_the_reference_triangle(self):
        for n in (1, 2, 5):
            points, triangles, pieces = surfaces.lattice(n)
            sides = points[triangles][:, 1:] - points[triangles][:, :1]
            np.testing.assert_allclose(np.linalg.det(sides), np.full(n * n, 1 / n**2))
            corners = np.array([[0, 0], [1, 0], [0, 1]])
            for triangle, first, second, side, number in pieces:
                start, end = corners[side], corners[(side + 1) % 3]
                np.testing.assert_allclose(points[first], start + (end - start) * number / n, atol=1e-15)
                np.testing.assert_allclose(points[second], start + (end - start) * (number + 1) / n, atol=1e-15)
                self.assertTrue({first, second} < set(triangles[triangle]))
            self.assertEqual(len({(side, number) for *_, side, number in pieces}), 3 * n)

    def test_facets_lie_on_the_quadratic_map(self):
        """The other route: the polynomials of degree 2 through the nodes, in monomials."""
        def monomials(xi):
            return np.column_stack([np.ones(len(xi)), xi, xi**2, xi[:, 0] * xi[:, 1]])

        reference = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])
        nodes = np.random.default_rng(1).normal(size=(6, 3))
        points, triangles, _ = surfaces.lattice(4)
        expected = (monomials(points) @ np.linalg.solve(monomials(reference), nodes))[triangles]
        for order, agrees in (((0, 1, 2, 3, 4, 5), True), ((0, 1, 2, 4, 3, 5), False)):
            split = surfaces.facets(Surface(nodes, np.array([order]), {}), np.eye(3), 4)
            self.assertEqual(np.allclose(split.corners, expected), agrees)

    def test_gradients_of_the_shape_functions(self):
        xi, step = np.random.default_rng(2).random((5, 2)), 1e-6
        for count in (3, 6):
            gradients = surfaces.shape_gradients(xi, count)
            for d in range(2):
                move = step * np.eye(2)[d]
                difference = (surfaces.shape_functions(xi + move, count) - surfaces.shape_functions(xi - move, count))
                np.testing.assert_allclose(gradients[:, d], difference / (2 * step), atol=1e-8)

    def test_half_of_a_sphere_is_seen_and_covers_its_disc(self):
        ball = sphere(3)
        for angles in ((0,), (18,), (55, 31)):
            split = surfaces.facets(ball, view(*angles), 4)
            front = surfaces.faces_viewer(split.corners)
            self.assertAlmostEqual(front.mean(), 0.5, delta=0.01)
            sides = split.corners[front][:, 1:, :2] - split.corners[front][:, :1, :2]
            self.assertAlmostEqual(np.linalg.det(sides).sum() / 2, math.pi, delta=0.01)
            middles = split.corners.mean(axis=1)
            self.assertGreater(np.sum(split.normals * middles, axis=1).min(), 0.99)

    def test_every_piece_of_an_edge_belongs_to_two_elements(self):
        split = surfaces.facets(sphere(1), view(18), 3)
        keys, first, count = np.unique(split.edge_key, axis=0, return_index=True, return_counts=True)
        self.assertEqual(set(count), {2})
        self.assertEqual(len(keys), 3 * 48)  # three pieces of each of the 3/2 E edges
        for key, i in zip(keys, first):
            twins = split.edges[np.all(split.edge_key == key, axis=1)]
            np.testing.assert_allclose(twins[0], twins[1][::-1], atol=1e-14)

    def test_what_is_near_is_painted_last(self):
        far, near = sphere(2), sphere(2, centre=(0, 4, 0))  # view(0) looks along -x2
        both = Surface(np.concatenate([near.points, far.points]),
                       np.concatenate([near.triangles, far.triangles + len(near.points)]), {})
        alone = polygons_drawn(near)
        together = polygons_drawn(both)
        self.assertEqual(len(together), 2 * len(alone))
        np.testing.assert_array_equal(together[len(alone):], alone)

    def test_edges_are_drawn_once_and_only_where_asked_for(self):
        ball = sphere(2)
        faces, with_edges = (polygons_drawn(ball, linewidth=width) for width in (0, 0.2))
        self.assertEqual(len(faces), surfaces.faces_viewer(surfaces.facets(ball, view(0), 3).corners).sum())
        edges = {tuple(map(tuple, np.unique(polygon.round(12), axis=0))) for polygon in with_edges if len(polygon) == 3
                 and np.array_equal(polygon[1], polygon[2])}
        self.assertEqual(len(edges), len(with_edges) - len(faces))
        window = polygons_drawn(ball, linewidth=0, window=(0.2, 0.4, -0.1, 0.1))
        self.assertTrue(0 < len(window) < 0.1 * len(faces))

    def test_few_colours_and_opaque_seams(self):
        tones = surfaces.shade(surfaces.facets(sphere(2), view(0), 3).normals)
        self.assertTrue(surfaces.EDGE_TONE < tones.min() and tones.max() <= 1)
        image = np.ones((40, 50, 4)) * np.linspace(0, 1, 50)[None, :, None]
        coloured, *offset = surfaces._colour_tones(image, 100)
        self.assertEqual(offset, [0, 0])
        self.assertLessEqual(len(np.unique(coloured[..., :3].reshape(-1, 3), axis=0)), surfaces.TONES)
        self.assertTrue(np.all(np.diff(coloured[0, :, :3] @ (0.299, 0.587, 0.114)) >= 0))
        self.assertEqual(coloured[0, 45, 3], 1)

    def test_smallest_angles_are_those_between_the_corners(self):
        points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0.1, 0.0]])
        angles = surfaces.smallest_angles(Surface(points, np.array([[0, 1, 2], [0, 3, 1]]), {}))
        np.testing.assert_allclose(angles, [45, math.degrees(math.atan(0.1) - math.atan(0.05))])

    def test_marked_elements_are_orange_and_have_no_edges_of_their_own(self):
        ball = sphere(1)
        for marked, is_grey in ((np.zeros(len(ball.triangles), bool), True), (np.ones(len(ball.triangles), bool), False)):
            axes = Figure().add_subplot()
            surfaces.draw_surface(axes, ball, view(0), marked=marked)
            colours = axes.collections[0].get_facecolor()
            self.assertEqual((np.ptp(colours[:, :3], axis=1) == 0).all(), is_grey)
            self.assertEqual((np.ptp(colours[:, :3], axis=1) > 0.3).all(), not is_grey)
        image = np.array([[[0.5, 0.5, 0.5, 1], [0.8, 0.4, 0.0, 1]]])
        coloured = surfaces._colour_tones(image.copy(), 100)[0]
        self.assertGreater(np.ptp(coloured[0, 0, :3]), 0.1)
        np.testing.assert_array_equal(coloured[0, 1], image[0, 1])

    def test_snapshots_are_read(self):
        ball = sphere(1)
        with tempfile.TemporaryDirectory() as folder:
            path = folder + "/ball.vtu"
            for kind, triangles in (("triangle6", ball.triangles), ("triangle", ball.triangles[:, :3])):
                meshio.write(path, meshio.Mesh(ball.points, [(kind, triangles)], {"H": ball.points[:, 2]}))
                found = read_surface(path)
                np.testing.assert_array_equal(found.points, ball.points)
                np.testing.assert_array_equal(found.triangles, triangles)
                np.testing.assert_array_equal(found.data["H"], ball.points[:, 2])
            content = pathlib.Path(path).read_bytes()
            meshio.write(path, meshio.Mesh(ball.points, [("vertex", [[0]])]))
            others = pathlib.Path(path).read_bytes()
            for words, text in {"expected triangles": others, "no whole VTU file": content[:len(content) // 2]}.items():
                pathlib.Path(path).write_bytes(text)
                with self.assertRaisesRegex(TableError, f"ball.vtu.*{words}"):
                    read_surface(path)
            with self.assertRaisesRegex(TableError, "missing.vtu"):
                read_surface(folder + "/missing.vtu")

    def test_values_of_facets_are_those_of_the_quadratic_field(self):
        corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
        nodes = np.vstack([corners, (corners + np.roll(corners, -1, axis=0)) / 2])
        surface = Surface(nodes, np.arange(6)[None, :], {})
        field = lambda x: 1 + x[..., 0]**2 - 3 * x[..., 0] * x[..., 1]
        middles = surfaces.facets(surface, np.eye(3), 3).corners.mean(axis=1)
        np.testing.assert_allclose(surfaces.facet_values(surface, field(nodes), 3), field(middles), atol=1e-14)


if __name__ == "__main__":
    unittest.main()
