# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of the figures: `python3 plots/test_plots.py`."""
import copy
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import meshio
import numpy as np
from matplotlib.figure import Figure

import coupled_diffusion
import mcf_dumbbell
import style
import surfaces
import tumour_growth
from convergence import Curve, Panel, convergence_figure, curves, draw_panels
from mcf_sphere import QUANTITIES, draw
from script import run
from surfaces import Surface, read_surface, view
from table import SCHEMA, TableError, has_series, read_table, series

FOLDER = os.path.dirname(os.path.abspath(__file__))
SCRIPT = os.path.join(FOLDER, "mcf_sphere.py")


def synthetic_table(widths=(0.49, 0.35, 0.245, 0.173, 0.123), exponents=range(8)):
    """A table like that of mcf_sphere: tau^3 and h^3 in x and v, no tau in nu, h^4 in H."""
    rows = []
    for level, h in enumerate(widths):
        for k in exponents:
            tau = 0.2 * 2.0**-k
            time, space = 3e-2 * (tau / 0.2)**3, (h / 0.49)**3
            errors = {"x": time + 1.5e-3 * space, "v": 10 * time + 4e-3 * space, "nu": 6.5e-4 * space,
                      "H": 0.02 * time + 1.8e-4 * space * h / 0.49}
            rows.append({"cell": f"h{level}_tau{k}", "level": level, "h": h, "nodes": round(2562 * (0.49 / h)**2),
                         "tau": tau, "steps": 3 * 2**k, "status": "ok",
                         "errors": {q: {"nodal_H1": e, "lifted_H1": 1.1 * e} for q, e in errors.items()}})
    return {"schema": SCHEMA, "experiment": "mcf_sphere", "paper": "kll19", "parameters": {}, "rows": rows}


def data_lines(axes):
    return [line for line in axes.lines if len(line.get_xdata()) and not is_reference(line)]


def is_reference(line):
    return (line.get_gid() or "").startswith("reference")


def references(axes):
    return [line for line in axes.lines if is_reference(line)]


def slopes_of(figure):
    """What the reference lines of each panel name."""
    return [[line.get_gid().removeprefix("reference ") for line in references(axes)] for axes in figure.axes]


def exponents_to_points(axes, line):
    """A line of the panel in log10 of its data coordinates."""
    to_data = line.get_transform() + axes.transData.inverted()
    return np.log10(to_data.transform(np.array(line.get_data()).T))


class Figures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.figures = dict(draw(synthetic_table(), "nodal_H1"))

    def test_lines_and_legend_are_those_of_the_table(self):
        for widths, exponents in (((0.49, 0.35, 0.245), range(8)), ((0.49,), range(4)), ((0.49, 0.35), (3,)),
                                  (np.geomspace(1, 0.1, 10), range(10))):
            table = synthetic_table(widths, exponents)
            for variable, count in (("tau", len(widths)), ("h", len(exponents))):
                figure = convergence_figure(table["rows"], QUANTITIES, "nodal_H1", variable, order=2)
                self.assertEqual(len(figure.axes), 4)
                self.assertEqual(len(figure.legends[0].get_texts()), count)
                for axes in figure.axes:
                    self.assertEqual(len(data_lines(axes)), count)

    def test_reference_lines_have_the_slope_they_name(self):
        for figure in self.figures.values():
            for axes in figure.axes:
                self.assertGreaterEqual(len(references(axes)), 1)
                for line in references(axes):
                    (x0, y0), (x1, y1) = exponents_to_points(axes, line)
                    named = float(line.get_gid().split("^{")[1].split("}")[0])
                    self.assertAlmostEqual((y1 - y0) / (x1 - x0), named, places=6)

    def test_reference_lines_stay_below_the_data_and_inside(self):
        for figure in self.figures.values():
            for axes in figure.axes:
                for line in references(axes):
                    corners = line.get_transform().transform(np.array(line.get_data()).T)
                    self.assertTrue(all(axes.bbox.contains(*corner) for corner in corners))
                    points = exponents_to_points(axes, line)
                    x = np.linspace(*points[:, 0], 50)
                    for curve in data_lines(axes):
                        data = np.log10(curve.get_xydata())
                        below = np.interp(x, *points.T) < np.interp(x, *data.T)
                        self.assertTrue(np.all(below[(x >= data[0, 0]) & (x <= data[-1, 0])]))

    def test_a_faster_order_is_drawn_only_where_the_data_follow_it(self):
        named = [[line.get_gid() for line in references(axes)] for axes in self.figures["kll19/fig13_2"].axes]
        expected = [["reference $O(h^{%d})$" % p for p in (faster, 2)] for faster in (3, 3, 3, 4)]
        self.assertEqual(named, expected)
        slow = synthetic_table()
        for row in slow["rows"]:
            row["errors"] = {quantity: {"nodal_H1": row["h"]**2} for quantity in QUANTITIES}
        for axes in dict(draw(slow, "nodal_H1"))["kll19/fig13_2"].axes:
            self.assertEqual([line.get_gid() for line in references(axes)], ["reference $O(h^{2})$"])

    def test_panels_span_equally_many_decades(self):
        for figure in self.figures.values():
            spans = [np.ptp(np.log10(axes.get_ylim())) for axes in figure.axes]
            np.testing.assert_allclose(spans, spans[0])

    def test_theory_follows_degree_and_bdf_order_of_the_table(self):
        table = synthetic_table()
        table["parameters"] = {"degree": 3, "bdf": 4}
        figures = dict(draw(table, "nodal_H1"))
        self.assertIn("O(\\tau^{4})", references(figures["kll19/fig13_1"].axes[0])[0].get_gid())
        self.assertIn("O(h^{3})", references(figures["kll19/fig13_2"].axes[0])[-1].get_gid())

    def test_the_norm_is_the_one_asked_for(self):
        rows = synthetic_table((0.49, 0.35), (2,))["rows"]
        axes = convergence_figure(rows, ("x",), "lifted_H1", "h", order=2).axes[0]
        self.assertEqual(max(data_lines(axes)[0].get_ydata()), rows[0]["errors"]["x"]["lifted_H1"])
        self.assertIn("lifted", axes.get_ylabel())

    def test_failed_runs_are_left_out_and_counted(self):
        table = synthetic_table()
        for row in table["rows"][:2]:
            row.update(status="failed: degenerate element 12 at step 3", errors={}, h=0, nodes=0)
        figure = convergence_figure(table["rows"], QUANTITIES, "nodal_H1", "tau", order=3)
        self.assertEqual([text.get_text() for text in figure.texts], ["2 of 40 runs failed: h0_tau0, h0_tau1."])
        self.assertEqual(len(data_lines(figure.axes[0])[0].get_xdata()), 6)

    def test_errors_without_a_logarithm_are_left_out_and_counted(self):
        table = synthetic_table()
        for row, value in zip(table["rows"], (0, 1e-15, None, math.nan, math.inf)):
            row["errors"]["x"]["nodal_H1"] = value
        shown, skipped = curves(table["rows"], "x", "nodal_H1", "tau")
        self.assertEqual((len(shown[0].points), skipped), (3, 5))
        for row in table["rows"]:
            row["errors"]["H"]["nodal_H1"] = 0
        figure = convergence_figure(table["rows"], QUANTITIES, "nodal_H1", "tau", order=3)
        self.assertIn("5 of x, 40 of H", figure.texts[0].get_text())
        self.assertIn("all errors below", figure.axes[3].texts[0].get_text())

    def test_line_styles_differ_and_grow_lighter(self):
        styles = style.line_styles(10)
        self.assertEqual(len({s["marker"] for s in styles}), 10)
        lightness = [np.dot(s["color"][:3], (0.299, 0.587, 0.114)) for s in styles]
        self.assertTrue(np.all(np.diff(lightness) > 0))
        self.assertLess(lightness[-1], 0.75)

    def test_step_sizes_and_mesh_widths_close_together_have_readable_labels(self):
        for low, high in ((0.265, 0.39), (0.34, 0.4999), (0.09, 0.13)):
            axis = Figure().add_axes([0, 0, 1, 1]).xaxis
            style.log_ticks(axis, low, high, 120)
            ticks = axis.get_majorticklocs()
            self.assertTrue(len(ticks) >= 2 and low <= ticks[0] and ticks[-1] <= high)
            self.assertGreater(120 * np.diff(np.log(ticks)).min() / math.log(high / low), 15)

    def test_a_curve_with_an_order_of_its_own_has_its_slope_below_it_in_its_colour(self):
        tau = np.geomspace(0.005, 0.1, 5)
        orders = (1, 2, 3)
        lines = [Curve(f"q{p}", np.column_stack([tau, tau**p]), p) for p in orders]
        figure = draw_panels([Panel("one", lines, "tau"), Panel("other", lines[:1], "tau")], "error")
        axes = figure.axes[0]
        self.assertEqual(slopes_of(figure)[0], [r"$O(\tau^{%d})$" % p for p in orders])
        for p, line, curve in zip(orders, references(axes), data_lines(axes)):
            self.assertEqual(line.get_color(), curve.get_color())
            x, y = exponents_to_points(axes, line).T
            self.assertTrue(np.all(p * x > y))  # log tau^p, below the curve
            if p < 3:
                self.assertTrue(np.all((p + 1) * x < y))  # and above the next one
        self.assertEqual(len(figure.legends), 2)

    def test_axes_and_slopes_belong_to_the_variable_of_each_panel(self):
        points = np.array([[0.1, 1e-3], [0.2, 8e-3]])
        panels = [Panel("time", [Curve("a", points)], "tau", 3), Panel("space", [Curve("b", 3 * points)], "h")]
        time, space = draw_panels(panels, "error", ["a note"]).axes
        self.assertIn("tau", time.get_xlabel())
        self.assertIn("mesh width", space.get_xlabel())
        self.assertEqual([len(references(axes)) for axes in (time, space)], [1, 0])
        np.testing.assert_allclose(np.array(space.get_xlim()), 3 * np.array(time.get_xlim()))
        panels[1].curves = [Curve("b", np.empty((0, 2)))]
        self.assertIn("all errors below", draw_panels(panels, "error").axes[1].texts[0].get_text())
        with self.assertRaisesRegex(TableError, "all errors"):
            draw_panels(panels[1:], "error")


class Script(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.table = synthetic_table((0.49, 0.35), range(3))

    def command(self, table, *options):
        path = os.path.join(self.folder, "table.json")
        with open(path, "w", encoding="utf-8") as file:
            file.write(table if isinstance(table, str) else json.dumps(table))
        return [SCRIPT, path, os.path.join(self.folder, "figures"), *options]

    def run_script(self, table, *options):
        """As a process of its own, with its own random hashes."""
        command = [sys.executable, *self.command(table, *options)]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def complaint(self, command):
        """What the script says before it exits with 1: sys.exit(text) prints the text on standard error."""
        with unittest.mock.patch("sys.argv", command), self.assertRaises(SystemExit) as exit_:
            run("mcf_sphere", draw, "", "nodal_H1")
        return exit_.exception.code

    def files(self):
        paths = [os.path.join(root, name) for root, _, names in os.walk(self.folder + "/figures") for name in names]
        return {os.path.relpath(path, self.folder): pathlib.Path(path).read_bytes() for path in paths}

    def test_writes_both_figures_the_same_every_time(self):
        self.assertEqual(self.run_script(self.table).returncode, 0)
        first = self.files()
        self.assertEqual(sorted(first), [f"figures/kll19/fig13_{n}.{kind}" for n in (1, 2) for kind in ("pdf", "png")])
        self.assertNotIn(b"CreationDate", first["figures/kll19/fig13_1.pdf"])
        self.assertEqual(self.run_script(self.table).returncode, 0)
        self.assertEqual(self.files(), first)

    def test_bad_input_is_one_line_and_exit_1(self):
        def changed(change):
            table = copy.deepcopy(self.table)
            change(table)
            return table

        cases = {
            "not JSON": "{",
            "schema": changed(lambda t: t.update(schema="esfem-table/2")),
            "experiment": changed(lambda t: t.update(experiment="willmore_sphere")),
            "no rows": changed(lambda t: t.update(rows=[])),
            "rows[1]: tau": changed(lambda t: t["rows"][1].pop("tau")),
            "none of 6 runs": changed(lambda t: [row.update(status="failed: x") for row in t["rows"]]),
            "no errors of v": changed(lambda t: [row["errors"].pop("v") for row in t["rows"]]),
        }
        complaints = {words: self.complaint(self.command(table)) for words, table in cases.items()}
        complaints["No such file"] = self.complaint([SCRIPT, self.folder + "/missing.json", self.folder])
        complaints["H1_nodal"] = self.complaint(self.command(self.table, "--norm", "H1_nodal"))
        for words, complaint in complaints.items():
            with self.subTest(words):
                self.assertIn(words, complaint)
                self.assertNotIn("\n", complaint)
        self.assertEqual(self.files(), {})
        result = self.run_script("{")
        self.assertEqual((result.returncode, result.stdout, result.stderr.count("\n")), (1, "", 1))

    def test_read_table_raises_its_own_error(self):
        with self.assertRaises(TableError):
            read_table(self.folder)

    def test_singular_runs_count_only_where_series_are_drawn(self):
        for row in self.table["rows"]:
            row["status"] = "singular at t = 0.08 (step 27): why"
        self.assertIn("none of 6 runs", self.complaint(self.command(self.table)))
        path = self.command(self.table)[1]
        self.assertEqual(len(read_table(path, usable=has_series)["rows"]), 6)


def sphere(subdivisions, centre=(0, 0, 0)):
    """A quadratic surface with all nodes on a unit sphere, outward."""
    corners = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
    points = list(corners)
    triangles = [(i, j, k) for i in (0, 1) for j in (2, 3) for k in (4, 5)]
    triangles = [(i, j, k) if np.linalg.det(corners[[i, j, k]]) > 0 else (i, k, j) for i, j, k in triangles]
    for level in range(subdivisions + 1):
        middles = {}

        def middle(i, j, middles=middles):
            key = min(i, j), max(i, j)
            if key not in middles:
                middles[key] = len(points)
                points.append((points[i] + points[j]) / np.linalg.norm(points[i] + points[j]))
            return middles[key]

        quadratic = [(i, j, k, middle(i, j), middle(j, k), middle(k, i)) for i, j, k in triangles]
        if level < subdivisions:
            triangles = [t for i, j, k, a, b, c in quadratic for t in ((i, a, c), (a, j, b), (c, b, k), (a, b, c))]
    return Surface(np.array(points) + centre, np.array(quadratic), {})


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


def dumbbell_row(method, start="cascade", tau=0.003, level=1, end=0.078, **changes):
    t = np.arange(0, end + tau / 2, tau)
    columns = {"t": t, "max_H": 6 / (1.1 - t / end), "worst_angle": 36 - 300 * t, "neck_radius": 0.2 * (1.05 - t / end)}
    if method.startswith("kll"):
        columns.update(min_nu=1 - t, max_nu=1 + 20 * t)
    cell = f"{method}_h{level}_{start.replace(':', '')}_{tau:g}"
    row = {"cell": cell, "method": method, "start": start, "level": level, "h": 0.18 / 2**level,
           "nodes": 3002 if level == 0 else 10522, "tau": tau, "steps": len(t) - 1, "errors": {},
           "status": f"singular at t = {end:g} (step {len(t)}): why", "values": {"pinch_time": end},
           "series": {name: values.tolist() for name, values in columns.items()},
           "snapshots": [{"t": t[n], "file": f"surfaces_{n:04d}.vtu"} for n in range(0, len(t), 2)]}
    return {**row, **changes}


def dumbbell_table():
    methods = ("dziuk", "kll", "kll_normalised", "kll_alpha1", "kll_alpha10", "kll_alpha100")
    rows = [dumbbell_row(method, end=0.072 + 0.003 * i) for i, method in enumerate(methods)]
    rows += [dumbbell_row(method, level=0) for method in methods[:3]]
    rows += [dumbbell_row(method, "substeps:16", tau) for method in methods[:3] for tau in (0.003, 0.0015)]
    rows.append(dumbbell_row("kll", "substeps:16", 0.00075))
    rows += [dumbbell_row("bgn", "none", tau, level) for tau in (0.003, 0.0015) for level in (0, 1)]
    rows.append(dumbbell_row("bgn_p1", "none", status="failed: why", series={}, snapshots=[], h=0))
    return {"schema": SCHEMA, "experiment": "mcf_dumbbell", "paper": "kll19", "parameters": {}, "rows": rows}


def write_snapshots(table, folder):
    """One small surface for all times, a little smaller at later ones."""
    ball = sphere(1)
    for row in table["rows"]:
        cell = os.path.join(folder, "cells", "mcf_dumbbell", row["cell"])
        os.makedirs(cell, exist_ok=True)
        for entry in row["snapshots"]:
            points = ball.points * [0.3, 0.3, 1] * (1 - 4 * entry["t"])
            meshio.write(os.path.join(cell, entry["file"]), meshio.Mesh(points, [("triangle6", ball.triangles)]))


def lines_of(axes):
    return [line for line in axes.lines if len(line.get_xdata()) > 2]

    def test_values_of_facets_are_those_of_the_quadratic_field(self):
        corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
        nodes = np.vstack([corners, (corners + np.roll(corners, -1, axis=0)) / 2])
        surface = Surface(nodes, np.arange(6)[None, :], {})
        field = lambda x: 1 + x[..., 0]**2 - 3 * x[..., 0] * x[..., 1]
        middles = surfaces.facets(surface, np.eye(3), 3).corners.mean(axis=1)
        np.testing.assert_allclose(surfaces.facet_values(surface, field(nodes), 3), field(middles), atol=1e-14)


class Dumbbell(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = cls.temporary.name
        cls.table = dumbbell_table()
        write_snapshots(cls.table, cls.folder)
        cls.figures = dict(mcf_dumbbell.draw(cls.table, cls.folder))

    def test_settings_are_those_of_the_paper_and_the_most_accurate(self):
        rows = self.table["rows"]
        paper, good = mcf_dumbbell.paper_setting(rows), mcf_dumbbell.good_setting(rows)
        self.assertEqual((paper.start, paper.tau, paper.nodes), ("cascade", 0.003, 10522))
        self.assertEqual((good.start, good.tau, good.nodes), ("substeps:16", 0.0015, 10522))  # not all have 0.00075
        self.assertEqual(list(paper.runs), [*mcf_dumbbell.LABELS][:7])
        self.assertEqual(list(good.runs), ["dziuk", "kll", "kll_normalised", "bgn"])
        self.assertEqual((paper.runs["bgn"]["tau"], good.runs["bgn"]["tau"]), (0.003, 0.0015))
        finer = [*rows, dumbbell_row("bgn", "none", 0.000375)]
        self.assertEqual(mcf_dumbbell.good_setting(finer).runs["bgn"]["tau"], 0.000375)
        self.assertTrue(all(row["level"] == 1 for setting in (paper, good) for row in setting.runs.values()))
        self.assertIsNone(mcf_dumbbell.good_setting([row for row in rows if row["start"] == "cascade"]))
        self.assertIsNone(mcf_dumbbell.paper_setting([{**row, "status": "failed: why"} for row in rows]))

    def test_headings_say_mesh_step_and_start(self):
        good = mcf_dumbbell.good_setting(self.table["rows"])
        self.assertEqual(good.heading(good.runs), r"$N = 10{,}522$, $\tau = 0.0015$, start with 16 substeps a step")
        good.runs["bgn"] = {**good.runs["bgn"], "tau": 0.003}
        self.assertTrue(good.heading(good.runs).endswith(r"; BGN: $\tau = 0.003$"))
        self.assertNotIn("BGN", good.heading(("kll",)))
        good.runs["bgn"]["nodes"] = 2632
        self.assertTrue(good.heading(good.runs).endswith(r"; BGN: $N = 2{,}632$, $\tau = 0.003$"))

    def test_snapshots_are_those_within_half_a_step(self):
        snapshots = mcf_dumbbell.Snapshots(dumbbell_row("kll"), "results")
        self.assertEqual([t for t, _ in snapshots.files][:2], [0, 0.006])
        self.assertEqual(snapshots.at(0.03)[1], "results/cells/mcf_dumbbell/kll_h1_cascade_0.003/surfaces_0010.vtu")
        self.assertIsNone(snapshots.at(0.032))
        self.assertAlmostEqual(snapshots.last()[0], 0.078)
        for entries in ([{"t": 0}], ["a.vtu"], [{"t": None, "file": "a.vtu"}], [{"t": 0, "file": 3}]):
            with self.assertRaisesRegex(TableError, "kll_h1_cascade_0.003: snapshots"):
                mcf_dumbbell.Snapshots(dumbbell_row("kll", snapshots=entries), "results")

    def test_all_figures_are_there(self):
        self.assertEqual(list(self.figures), [f"kll19/fig13_{name}" for name in ("3", "3_good_start", "4", "5", "6")])

    def test_the_surfaces_have_one_scale_and_a_panel_for_each_time_and_method(self):
        for name, columns in (("kll19/fig13_3", 3), ("kll19/fig13_3_good_start", 4)):
            figure = self.figures[name]
            self.assertEqual(sum(bool(axes.collections) for axes in figure.axes), 5 * columns)
            scales = [axes.get_position().size * figure.get_size_inches() / [np.ptp(axes.get_xlim()),
                                                                             np.ptp(axes.get_ylim())]
                      for axes in figure.axes]
            np.testing.assert_allclose(scales, np.full_like(scales, scales[0][0]))
            self.assertLess(figure.get_size_inches()[1], 10)
            own_times = [axes.texts[0].get_text() for axes in figure.axes if axes.texts]
            self.assertEqual(own_times, ["$t = 0.072$", "$t = 0.072$", "$t = 0.078$"] if columns == 3
                             else ["$t = 0.078$"] * 4)

    def test_the_neck_says_method_time_and_radius(self):
        titles = [axes.get_title(loc="left") for axes in self.figures["kll19/fig13_4"].axes]
        self.assertEqual(len(titles), 3)
        self.assertTrue(titles[0].startswith(r"(5.1), $\nu_h$ normalised, $\tau = 0.003$, first step by backward"))
        self.assertTrue(titles[0].endswith("$t = 0.078$, neck radius 0.01"), titles[0])
        self.assertTrue(titles[2].startswith(r"BGN, $\tau = 0.0015$"))

    def test_a_method_looks_the_same_in_all_panels(self):
        curvature, normals = (self.figures[f"kll19/fig13_{n}"] for n in (5, 6))
        self.assertEqual([len(lines_of(axes)) for axes in curvature.axes], [7, 8, 4, 5, 7, 4])
        self.assertEqual([len(lines_of(axes)) for axes in normals.axes], [10, 10, 4, 4])
        for figure in (curvature, normals):
            legend = {text.get_text(): line.get_color()
                      for text, line in zip(figure.legends[0].get_texts(), figure.legends[0].get_lines())}
            for label, colour in legend.items():
                method = next((m for m, text in mcf_dumbbell.LABELS.items() if text == label), None)
                self.assertEqual(colour, mcf_dumbbell.LINES[method]["color"] if method else "black")
            colours = {line.get_color() for axes in figure.axes for line in lines_of(axes)}
            self.assertEqual(colours, set(legend.values()))
        styles = [(str(line["color"]), str(line["linestyle"])) for line in mcf_dumbbell.LINES.values()]
        for kind in zip(*styles):
            self.assertEqual(len(set(kind)), len(styles))

    def test_the_reference_goes_through_its_rows(self):
        with open(mcf_dumbbell.REFERENCE, encoding="utf-8") as file:
            reference = json.load(file)
        t, H, pinch = mcf_dumbbell.reference_curvature(0.07)
        self.assertEqual(pinch, reference["pinch"])
        for row in reference["rows"]:
            if row[0] >= 0.07:
                expected = row[reference["columns"].index("Hmax")]
                self.assertAlmostEqual(np.interp(row[0], t, H) / expected, 1, delta=2e-3)
        self.assertTrue(np.all(np.diff(H) > 0))

    def test_failed_runs_are_counted(self):
        notes = [text.get_text() for text in self.figures["kll19/fig13_5"].texts]
        self.assertIn("1 of 21 runs failed: bgn_p1_h1_none_0.003.", notes)

    def test_a_missing_snapshot_is_named(self):
        row = dumbbell_row("dziuk", snapshots=[{"t": 0, "file": "gone.vtu"}])
        with self.assertRaisesRegex(TableError, "cells/mcf_dumbbell/dziuk_h1_cascade_0.003/gone.vtu: no such"):
            list(mcf_dumbbell.draw({"rows": [row]}, self.folder))

    def test_small_tables_give_what_they_have(self):
        rows = [dumbbell_row("dziuk", level=0), dumbbell_row("bgn", "none", level=0, snapshots=[])]
        self.assertEqual(list(dict(mcf_dumbbell.draw({"rows": rows}, self.folder))), ["kll19/fig13_3", "kll19/fig13_5"])
        rows = [dumbbell_row("kll", "substeps:4", 0.006, 0, end=0.03, snapshots=[], status="ok")]
        figures = dict(mcf_dumbbell.draw({"rows": rows}, self.folder))
        self.assertEqual(list(figures), ["kll19/fig13_5", "kll19/fig13_6"])
        for figure in figures.values():
            self.assertFalse(any("singular" in text.get_text() for text in figure.texts))
            for axes in figure.axes:
                self.assertLess(*axes.get_xlim())
        rows = [dumbbell_row("kll", series={}, snapshots=[])]
        with self.assertRaisesRegex(TableError, "no series"):
            list(mcf_dumbbell.draw({"rows": rows}, self.folder))
        for rows in ([dumbbell_row("bgn", "none")], [dumbbell_row("euler")]):
            with self.assertRaisesRegex(TableError, "no runs"):
                list(mcf_dumbbell.draw({"rows": rows}, self.folder))

    def test_series_are_checked(self):
        row = dumbbell_row("kll", series={"t": [0, 1, 2], "h": [1, None, 3], "area": [1, 2], "tip": "abc"})
        np.testing.assert_array_equal(series(row, "h"), ([0, 1, 2], [1, math.nan, 3]))
        self.assertIsNone(series(row, "volume"))
        for name in ("area", "tip"):
            with self.assertRaisesRegex(TableError, f"kll_h1_cascade_0.003: the series {name}"):
                series(row, name)

    def test_the_script_writes_files_and_has_no_norm(self):
        path = os.path.join(self.folder, "table.json")
        table = {**self.table, "rows": [dumbbell_row("kll_normalised")]}
        with open(path, "w", encoding="utf-8") as file:
            json.dump(table, file)
        command = [sys.executable, os.path.join(FOLDER, "mcf_dumbbell.py"), path, os.path.join(self.folder, "figures")]
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        written = sorted(os.listdir(self.folder + "/figures/kll19"))
        self.assertEqual(written, [f"fig13_{n}.{kind}" for n in (3, 4, 5, 6) for kind in ("pdf", "png")])
        refused = subprocess.run([*command, "--norm", "nodal_L2"], capture_output=True, text=True, check=False)
        self.assertEqual((refused.returncode, refused.stderr.count("\n")), (1, 1))


def diffusion_table(levels=5, exponents=6):
    """A table like that of coupled_diffusion: the difference has order q - 1 in tau and no h."""
    rows = []
    for level in range(levels):
        for k in range(exponents):
            h, tau = 0.38 * 2**(-level / 2), 0.1 * 2.0**-k
            mesh = {"level": level, "h": h, "nodes": round(854 * (0.38 / h)**2), "tau": tau, "steps": 10 * 2**k,
                    "status": "ok"}
            errors = {q: {f"{kind}_{norm}": factor * (4 * tau**3 + 0.03 * h**p) for kind in ("nodal", "lifted")
                          for norm, p in (("L2", 3), ("H1", 2), ("H1_semi", 2))}
                      for q, factor in (("x", 1), ("v", 3), ("u", 2.5))}
            rows.append({"cell": f"h{level}_tau{k}", "run": "convergence", "bdf": "3", "errors": errors, **mesh})
            for bdf in ("2", "3", "4") if level == min(2, levels - 1) else ("3",):
                size = (0, 0, 2, 6, 25)[int(bdf)] * tau**(int(bdf) - 1)
                rows.append({"cell": f"difference_bdf{bdf}_h{level}_tau{k}", "run": "difference", "bdf": bdf, **mesh,
                             "errors": {"u_difference": {"nodal_L2": 0.4 * size, "nodal_H1": size}},
                             "values": {"seconds_ratio": 1.3 + 0.1 * (k % 3)}})
            rows.append({"cell": f"none_h{level}_tau{k}", "run": "none", "bdf": "3", **mesh,
                         "errors": {"u": {"nodal_L2": 1.0}}})
    return {"schema": SCHEMA, "experiment": "coupled_diffusion", "paper": "nick18", "parameters": {}, "rows": rows}


class CoupledDiffusion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.table = diffusion_table()
        cls.figures = dict(coupled_diffusion.draw(cls.table, "lifted"))

    def notes(self, figure):
        return " ".join(text.get_text() for text in figure.texts)

    def test_all_figures_have_the_lines_of_the_convergence_runs(self):
        self.assertEqual(list(self.figures), [f"nick18/fig{n}" for n in range(1, 6)])
        for n, count in ((1, 5), (2, 6), (3, 5), (4, 6)):
            figure = self.figures[f"nick18/fig{n}"]
            self.assertEqual([len(data_lines(axes)) for axes in figure.axes], [count, count])
            self.assertEqual(len(figure.legends), 1)

    def test_slopes_are_those_of_norm_and_variable(self):
        time, space = [[r"$O(\tau^{3})$"]] * 2, [["$O(h^{3})$"], ["$O(h^{2})$"]]
        for n, expected in ((1, time), (2, space), (3, time), (4, space)):
            self.assertEqual(slopes_of(self.figures[f"nick18/fig{n}"]), expected)
        cubic = copy.deepcopy(self.table)
        cubic["parameters"]["degree"] = 3
        for row in cubic["rows"]:
            row["bdf"] = "4"
        figures = dict(coupled_diffusion.draw(cubic, "lifted"))
        self.assertEqual(slopes_of(figures["nick18/fig1"]), [[r"$O(\tau^{4})$"]] * 2)
        self.assertEqual([slopes[-1] for slopes in slopes_of(figures["nick18/fig2"])], ["$O(h^{4})$", "$O(h^{3})$"])

    def test_panels_show_the_norms_they_name(self):
        table = diffusion_table(2, 2)
        for i, kind in enumerate(("nodal", "lifted")):
            for row in table["rows"]:
                if row["run"] == "convergence":
                    row["errors"]["u"].update({f"{kind}_L2": 0.01 + i, f"{kind}_H1_semi": 0.03 + i})
        for i, kind in enumerate(("nodal", "lifted")):
            panels = dict(coupled_diffusion.draw(table, kind))["nick18/fig3"].axes
            self.assertEqual([axes.get_title() for axes in panels], [f"$L^2$ norm, {kind}", f"$H^1$ seminorm, {kind}"])
            self.assertEqual([data_lines(axes)[0].get_ydata()[0] for axes in panels], [0.01 + i, 0.03 + i])
            self.assertEqual(panels[0].get_ylabel(), "error of the solution $u$ at $t = 1$")

    def test_the_difference_has_one_order_less_in_time_and_none_in_space(self):
        figure = self.figures["nick18/fig5"]
        self.assertEqual([len(data_lines(axes)) for axes in figure.axes], [5, 6, 3])
        time, space, methods = slopes_of(figure)
        self.assertEqual((time, space), ([r"$O(\tau^{2})$"], []))
        self.assertEqual(methods, [r"$O(\tau^{%d})$" % p for p in (1, 2, 3)])
        for order, line in zip((1, 2, 3), data_lines(figure.axes[2])):
            slope = np.polyfit(*np.log(line.get_xydata().T), 1)[0]
            self.assertAlmostEqual(slope, order)
        self.assertEqual(figure.axes[2].get_title(), "time, $N = 3{,}416$")  # where all three methods ran
        self.assertEqual([len(legend.get_texts()) for legend in figure.legends], [5, 6, 3])

    def test_the_price_is_the_median_of_the_runs_with_bdf3(self):
        table = diffusion_table(1, 3)
        for row in table["rows"]:
            if row["bdf"] != "3":
                row["values"]["seconds_ratio"] = 7
        self.assertIn("(7.2) takes 1.40 times as long as (2.19): the median of 3 runs with BDF3.",
                      self.notes(dict(coupled_diffusion.draw(table, "lifted"))["nick18/fig5"]))
        for row in table["rows"]:
            row["values"] = {"seconds_ratio": None}
        self.assertNotIn("times as long", self.notes(dict(coupled_diffusion.draw(table, "lifted"))["nick18/fig5"]))

    def test_failed_runs_are_counted_where_they_belong(self):
        table = diffusion_table()
        for row in table["rows"]:
            if row["cell"] in ("h2_tau0", "difference_bdf4_h2_tau1"):
                row.update(status="failed: why", errors={}, h=0, nodes=0)
        figures = dict(coupled_diffusion.draw(table, "lifted"))
        for n in range(1, 5):
            self.assertIn("1 of 30 runs failed: h2_tau0.", self.notes(figures[f"nick18/fig{n}"]))
        self.assertIn("1 of 42 runs failed: difference_bdf4_h2_tau1.", self.notes(figures["nick18/fig5"]))

    def test_small_tables_give_what_they_have(self):
        def drawn(keep, levels=2, exponents=2):
            table = diffusion_table(levels, exponents)
            table["rows"] = [row for row in table["rows"] if keep(row)]
            return dict(coupled_diffusion.draw(table, "lifted"))

        self.assertEqual(len(drawn(lambda row: True, 1, 1)), 5)
        self.assertEqual(list(drawn(lambda row: row["run"] == "difference")), ["nick18/fig5"])
        self.assertEqual(list(drawn(lambda row: row["run"] == "convergence")), [f"nick18/fig{n}" for n in range(1, 5)])
        self.assertEqual(len(drawn(lambda row: row["bdf"] == "3")["nick18/fig5"].axes), 2)
        only2 = drawn(lambda row: row["bdf"] == "2")["nick18/fig5"]
        self.assertEqual(slopes_of(only2), [[r"$O(\tau^{1})$"], []])
        with self.assertRaisesRegex(TableError, "no rows with run"):
            drawn(lambda row: row["run"] == "none")

    def test_a_figure_without_anything_to_show_is_an_error(self):
        for kind, words in (("difference", "u_difference"), ("convergence", "x in the norm lifted_L2")):
            table = diffusion_table(2, 2)
            for row in table["rows"]:
                if row["run"] == kind:
                    row.update(status="failed: why", errors={}, bdf="2")
            with self.assertRaisesRegex(TableError, f"no errors of {words}"):
                list(coupled_diffusion.draw(table, "lifted"))

    def test_the_script_takes_the_kind_of_the_norms(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "table.json")
            with open(path, "w", encoding="utf-8") as file:
                json.dump(diffusion_table(2, 2), file)
            command = [sys.executable, os.path.join(FOLDER, "coupled_diffusion.py"), path, folder + "/figures"]
            result = subprocess.run([*command, "--norm", "nodal"], capture_output=True, text=True, check=False)
            self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
            self.assertEqual(sorted(os.listdir(folder + "/figures/nick18")),
                             [f"fig{n}.{kind}" for n in range(1, 6) for kind in ("pdf", "png")])
            refused = subprocess.run([*command, "--norm", "nodal_L2"], capture_output=True, text=True, check=False)
            self.assertEqual((refused.returncode, refused.stderr.count("\n")), (1, 1))
            self.assertIn("'nodal', 'lifted'", refused.stderr)


class Tumour(unittest.TestCase):
    def test_surfaces_are_coloured_and_missing_ones_named(self):
        points = [[0, 0, 1.0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, -1.0]]
        triangles = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [5, 2, 1], [5, 3, 2], [5, 4, 3], [5, 1, 4]]
        with tempfile.TemporaryDirectory() as folder:
            cell = pathlib.Path(folder, "cells/tumour_growth/h0_tau0")
            cell.mkdir(parents=True)
            for name, size in (("a.vtu", 1), ("b.vtu", 2)):
                meshio.Mesh(size * np.array(points), [("triangle", triangles)],
                            point_data={"u1": np.linspace(0.5, 1.5, 6)}).write(cell / name)
            times = [0.0, 1.0]
            row = {"cell": "h0_tau0", "h": 1.4, "nodes": 6, "tau": 1.0, "steps": 1, "status": "ok", "errors": {},
                   "snapshots": [{"t": 0, "file": "a.vtu"}, {"t": 1, "file": "b.vtu"}],
                   "series": {"t": times, "area": times, "min_u1": times, "max_u1": times}}
            (name, figure), = tumour_growth.draw({"rows": [row]}, folder)
            self.assertEqual(name, "gallery/tumour_growth")
            widths = [axes.get_position().width for axes in figure.axes[:2]]
            self.assertAlmostEqual(widths[1] / widths[0], 2)  # one scale for all
            row["snapshots"][1]["file"] = "c.vtu"
            with self.assertRaisesRegex(TableError, "c.vtu: no such snapshot"):
                list(tumour_growth.draw({"rows": [row]}, folder))


if __name__ == "__main__":
    unittest.main()
