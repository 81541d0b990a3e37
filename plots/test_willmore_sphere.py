# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of willmore.py and willmore_sphere.py."""
import math
import os
import tempfile
import unittest

import numpy as np

import willmore_sphere
from table import SCHEMA, TableError, label_of
from testing import data_lines, figure_named, lines_of, run_script, slopes_of, texts_of
from willmore import SPHERE, TORUS, limit_of


def labels_of(run, projection, flow="willmore", theta="no"):
    return {"run": run, "flow": flow, "projection": projection, "theta": theta, "radius": 1.0}


def convergence_row(level, k, growth, projection, **labels):
    """x, nu, H of order 3 in h; the energy tends to 8 pi. Without projection everything has grown by exp(8)."""
    h, tau = 0.5 * 2**(-level / 2), 0.2 * 2.0**-k
    error = growth * (3e-3 * h**3 + 1e-7 * tau)
    errors = {q: {norm: factor * c * error for norm, factor in (("nodal_H1", 1), ("lifted_H1", 1.3))}
              for q, c in (("x", 1), ("nu", 2), ("H", 7))}
    name = "_".join(["convergence", projection, *labels.values()])
    return {"cell": f"{name}_h{level}_tau{k}", "level": level, "h": h, "nodes": round(482 * 2**level), "tau": tau,
            "steps": 5 * 2**k, "status": "ok", "errors": errors,
            "labels": labels_of("convergence", projection, **labels),
            "values": {"willmore_energy": SPHERE[0] * (1 + 0.3 * error), "kappa_energy": SPHERE[0] * (1 - 0.1 * h**4)}}


def normals_row(projection, growth, end=1.0):
    t = np.arange(0, end + 0.0125, 0.025)
    drift = growth * 1e-5 * np.expm1(8 * t)
    columns = {"t": t, "min_nu": 1 - drift, "max_nu": 1 + 1.2 * drift, "min_radius": 1 - 0.6 * drift,
               "max_radius": 1 + 0.5 * drift, "willmore_energy": SPHERE[0] * (1 + drift**2 + 0.02 * growth * drift)}
    return {"cell": f"normals_{projection}", "labels": labels_of("normals", projection), "level": 2, "h": 0.25,
            "nodes": 1914, "tau": 0.025, "steps": 40, "status": "ok", "errors": {}, "values": {},
            "series": {name: values.tolist() for name, values in columns.items()}}


def sphere_table(levels=5, exponents=6):
    rows = [convergence_row(level, k, growth, projection)
            for projection, growth in (("none", math.exp(5)), ("projected", 1))
            for level in range(levels) for k in range(exponents)]
    rows += [convergence_row(0, 0, 1e9, "none", flow="surface_diffusion"),  # of no figure
             convergence_row(0, 0, 1e9, "projected", theta="yes")]
    rows += [normals_row("none", 5), normals_row("projected", 0.01)]
    return {"schema": SCHEMA, "experiment": "willmore_sphere", "paper": "kll21", "parameters": {}, "rows": rows}


class WillmoreSphere(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.table = sphere_table()
        cls.figures = dict(willmore_sphere.draw(cls.table, "nodal_H1"))

    def test_four_panels_side_by_side_with_a_line_for_each_step_size(self):
        self.assertEqual(sorted(self.figures), ["kll21/fig7_1", "kll21/fig7_2", "kll21/fig7_3"])
        for name in ("kll21/fig7_1", "kll21/fig7_3"):
            figure = self.figures[name]
            self.assertEqual([axes.get_title() for axes in figure.axes],
                             ["surface $x$", r"normal $\nu$", "mean curvature $H$", r"$|W - 8\pi|$, $t = 1$"])
            self.assertEqual(len({axes.get_position().y0 for axes in figure.axes}), 1)
            self.assertEqual([len(data_lines(axes)) for axes in figure.axes], [6] * 4)
            self.assertEqual(len(figure.legends[0].get_texts()), 6)
            self.assertEqual({axes.get_xlabel() for axes in figure.axes}, {"mesh width $h$"})
            self.assertEqual(figure.axes[0].get_ylabel(), "error in $L^\\infty(H^1)$, nodal")

    def test_errors_have_the_slope_of_the_theory_and_the_energy_is_its_distance_from_the_limit(self):
        for name in ("kll21/fig7_1", "kll21/fig7_3"):
            figure = self.figures[name]
            self.assertEqual(slopes_of(figure), [["$O(h^{2})$"]] * 3 + [[]])
            energy = figure.axes[3]
            self.assertEqual((energy.get_xscale(), energy.get_yscale()), ("log", "log"))
            for line, errors in zip(data_lines(energy), data_lines(figure.axes[0])):  # in the table, W/8 pi = 1 + 0.3 error
                np.testing.assert_allclose(line.get_ydata(), 8 * math.pi * 0.3 * errors.get_ydata(), rtol=1e-8)
            np.testing.assert_allclose(energy.get_xlim(), figure.axes[0].get_xlim())

    def test_rows_go_to_the_figure_of_their_projection(self):
        for name, projection in (("kll21/fig7_1", "none"), ("kll21/fig7_3", "projected")):
            expected = max(row["errors"]["x"]["nodal_H1"] for row in self.table["rows"]
                           if row["labels"] == labels_of("convergence", projection))
            shown = max(line.get_ydata().max() for line in data_lines(self.figures[name].axes[0]))
            self.assertEqual(shown, expected)

    def test_the_norm_is_the_one_asked_for(self):
        axes = dict(willmore_sphere.draw(sphere_table(2, 2), "lifted_H1"))["kll21/fig7_3"].axes[0]
        self.assertIn("lifted", axes.get_ylabel())

    def test_runs_that_failed_or_went_astray_are_missing_and_named(self):
        table = sphere_table()
        table["rows"][0].update(status="failed: step 3: element 7 is degenerate", errors={}, values={}, h=0, nodes=0)
        table["rows"][1].update(status="singular at t = 0.5 (step 5): H", errors={}, values={})
        table["rows"][2]["values"]["willmore_energy"] = 1e6
        table["rows"][3]["values"] = {"willmore_energy": None}
        del table["rows"][4]["values"]
        figure = figure_named("kll21/fig7_1", willmore_sphere.draw(table, "nodal_H1"))
        self.assertIn(r"2 of 30 runs failed: level 0 with $\tau$ = 0.2; $N = 482$ with $\tau$ = 0.1.", texts_of(figure))
        self.assertIn("2 of the energy", texts_of(figure))
        self.assertEqual([len(line.get_xdata()) for line in data_lines(figure.axes[3])], [4, 4, 5, 4, 4, 5])
        self.assertEqual([len(line.get_xdata()) for line in data_lines(figure.axes[0])], [4, 4, 5, 5, 5, 5])
        for row in table["rows"]:
            if label_of(row, "projection") == "none":
                row.update(status="failed: step 3: why", errors={}, values={})
        figures = dict(willmore_sphere.draw(table, "nodal_H1"))
        self.assertEqual(len(figures), 3)
        self.assertIn("None of 30 runs finished. The first: failed: step 3: why.",
                      texts_of(figures["kll21/fig7_1"]))

    def test_small_tables_give_what_they_have(self):
        table = sphere_table(1, 1)
        self.assertEqual(len(dict(willmore_sphere.draw(table, "nodal_H1"))), 3)
        table["rows"] = table["rows"][-1:]
        self.assertEqual(list(dict(willmore_sphere.draw(table, "nodal_H1"))), ["kll21/fig7_2"])
        table["rows"][0]["labels"]["run"] = "other"
        with self.assertRaisesRegex(TableError, "no rows with run"):
            list(willmore_sphere.draw(table, "nodal_H1"))

    def test_projections_are_told_apart_by_tone_and_extremes_by_marker(self):
        figure = self.figures["kll21/fig7_2"]
        self.assertEqual([text.get_text() for text in figure.legends[0].get_texts()],
                         ["without projections", "with projections", "minimum", "maximum"])
        normal, radius, energy = figure.axes
        for axes in (normal, radius):
            looks = sorted((line.get_color(), line.get_marker()) for line in lines_of(axes))
            self.assertEqual(looks, [("0.6", "*"), ("0.6", "o"), ("black", "*"), ("black", "o")])
        self.assertEqual(len(lines_of(energy)), 2)
        np.testing.assert_allclose(normal.get_xlim(), (-0.06, 1.06))
        marks = [line.get_markevery()[0] for line in lines_of(normal)]
        self.assertEqual(len(set(marks)), 4)  # marks of lines that coincide lie apart
        self.assertIn("$N = 1{,}914$, $\\tau = 0.025$", texts_of(figure))
        lowest = min((line for line in lines_of(radius) if line.get_color() == "black"),
                     key=lambda line: line.get_ydata().min())
        np.testing.assert_array_equal(lowest.get_ydata(), self.table["rows"][-2]["series"]["min_radius"])

    def test_a_run_that_stops_early_is_shown_up_to_there(self):
        table = sphere_table(1, 1)
        table["rows"][-2] = {**normals_row("none", 300, end=0.6), "status": "singular at t = 0.625 (step 25): H is 80"}
        del table["rows"][-2]["series"]["max_radius"]
        figure = dict(willmore_sphere.draw(table, "nodal_H1"))["kll21/fig7_2"]
        self.assertIn("Without projections: singular at t = 0.625 (step 25): H is 80", texts_of(figure))
        self.assertEqual([len(lines_of(axes)) for axes in figure.axes], [4, 3, 2])
        table["rows"][-2]["status"] = "failed: why"
        figure = dict(willmore_sphere.draw(table, "nodal_H1"))["kll21/fig7_2"]
        self.assertIn(r"1 of 2 runs failed: without projections, $N = 1{,}914$ with $\tau$ = 0.025.", texts_of(figure))
        self.assertEqual(len(figure.legends[0].get_texts()), 3)
        table["rows"][-1]["status"] = "failed: why"
        figure = dict(willmore_sphere.draw(table, "nodal_H1"))["kll21/fig7_2"]
        self.assertIn("None of 2 runs finished. The first: failed: why.", texts_of(figure))

    def test_the_script_writes_files(self):
        with tempfile.TemporaryDirectory() as folder:
            result = run_script("willmore_sphere", sphere_table(2, 2), folder, "--norm", "lifted_H1")
            self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
            self.assertEqual(sorted(os.listdir(folder + "/figures/kll21")),
                             [f"fig7_{n}.{kind}" for n in (1, 2, 3) for kind in ("pdf", "png")])

    def test_limits_are_those_of_the_topology(self):
        self.assertEqual([limit_of(name) for name in ("red_blood_cell", "small_ellipsoid", "small_torus_4")],
                         [SPHERE, SPHERE, TORUS])


if __name__ == "__main__":
    unittest.main()
