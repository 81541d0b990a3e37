# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of the convergence figures: `python3 plots/test_plots.py`."""
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

import numpy as np

import style
from convergence import convergence_figure, curves
from mcf_sphere import QUANTITIES, draw
from script import run
from table import SCHEMA, TableError, read_table

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


if __name__ == "__main__":
    unittest.main()
