# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of willmore_competitors.py."""
import math
import os
import tempfile
import unittest

import numpy as np

import willmore_competitors
from table import SCHEMA, TableError, label_of
from testing import lines_of, run_script, texts_of
from willmore import limit_of


def competitor_row(scheme, surface, degree, **changes):
    t = np.linspace(0, 1, 41)
    size = {"willmore": 1e-4, "dziuk_willmore": 3e-3, "bgn_willmore": 1e-3}[scheme] * (1 if degree == 2 else 6)
    limit = limit_of(surface)[0]
    columns = {"t": t, "willmore_energy": limit + 5 * size * np.exp(t),
               "kappa_energy": limit + (3 * np.exp(-4 * t) if surface == "ellipsoid" else 0) + 2 * size * np.exp(t)}
    if surface != "ellipsoid":
        columns["x_nodal_H1"] = size * np.expm1(2 * t)
    nodes = 1914 if degree == 2 else 1926
    return {"cell": f"{surface}_{scheme}_p{degree}",
            "labels": {"surface": surface, "flow": scheme, "degree": degree}, "level": 1, "h": 0.2, "nodes": nodes,
            "tau": 0.025, "steps": 40, "status": "ok", "errors": {},
            "series": {name: values.tolist() for name, values in columns.items()}, **changes}


def competitors_table():
    rows = [competitor_row(scheme, surface, degree) for surface in willmore_competitors.SURFACES
            for scheme in willmore_competitors.SCHEMES for degree in (1, 2)
            if (scheme, degree) != ("willmore", 1)]
    return {"schema": SCHEMA, "experiment": "willmore_competitors", "paper": "kll21", "parameters": {}, "rows": rows}


def draw(rows):
    (name, figure), = willmore_competitors.draw({"rows": rows}, "")
    assert name == "gallery/willmore_competitors", name
    return figure


class Competitors(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.table = competitors_table()
        cls.figure = draw(cls.table["rows"])

    def test_errors_above_energies_below(self):
        rows = {}
        for axes in self.figure.axes:
            rows.setdefault(round(axes.get_position().y0, 6), []).append(axes)
        upper, lower = (rows[y] for y in sorted(rows, reverse=True))
        self.assertEqual((len(upper), len(lower)), (2, 3))
        self.assertEqual(upper[0].get_ylabel(), "error of $x$ in $H^1$, nodal")
        self.assertEqual(lower[0].get_ylabel(), r"$|W(\kappa_h) - W^*|$")
        for axes in upper + lower:
            self.assertEqual((len(lines_of(axes)), axes.get_yscale(), axes.get_xlabel()), (5, "log", "$t$"))
        self.assertIn(r"Clifford torus, $W^* = 4\pi^2$", texts_of(self.figure))
        error = competitor_row("willmore", "sphere", 2)["series"]["x_nodal_H1"]
        np.testing.assert_array_equal(lines_of(upper[0])[0].get_ydata(), [math.nan, *error[1:]])
        energy = np.array(competitor_row("bgn_willmore", "ellipsoid", 1)["series"]["kappa_energy"])
        np.testing.assert_allclose(lines_of(lower[2])[-1].get_ydata(), energy - 8 * math.pi)

    def test_schemes_have_colours_and_degrees_have_dashes(self):
        legend = self.figure.legends[0]
        looks = {text.get_text(): (line.get_color(), line.get_linestyle())
                 for text, line in zip(legend.get_texts(), legend.get_lines())}
        self.assertEqual(set(looks), {"KLL, quadratic", "Dziuk, quadratic", "Dziuk, linear", "BGN, quadratic",
                                      "BGN, linear"})
        for axes in self.figure.axes:
            self.assertEqual({(line.get_color(), line.get_linestyle()) for line in lines_of(axes)}, set(looks.values()))
        self.assertEqual({label.endswith("linear"): dash for label, (_, dash) in looks.items()},
                         {True: "--", False: "-"})

    def test_notes_say_mesh_and_step_size(self):
        notes = texts_of(self.figure)
        self.assertIn(r"Sphere: $N = 1{,}914$, $\tau = 0.025$ (quadratic);", notes)
        coarser = [{**row, "nodes": 500} if row["cell"] == "sphere_bgn_willmore_p1" else row for row in self.table["rows"]]
        self.assertIn("(Dziuk, linear); $N = 500$", texts_of(draw(coarser)))
        self.assertIn("(BGN, linear).", texts_of(draw(coarser)))
        alike = [row for row in self.table["rows"] if label_of(row, "degree") == 2]
        self.assertIn(r"Ellipsoid: $N = 1{,}914$, $\tau = 0.025$.", texts_of(draw(alike)))

    def test_a_scheme_without_kappa_shows_its_own_energy(self):
        row = competitor_row("dziuk_willmore", "ellipsoid", 2)
        del row["series"]["kappa_energy"]
        figure = draw([row])
        axes, = figure.axes
        np.testing.assert_allclose(lines_of(axes)[0].get_ydata(),
                                   np.array(row["series"]["willmore_energy"]) - 8 * math.pi)
        self.assertIn(r"own $H_h$ in place of $\kappa_h$: Dziuk, quadratic.", texts_of(figure))

    def test_failed_and_stopped_runs_are_noted(self):
        rows = competitors_table()["rows"]
        rows[0].update(status="failed: step 2: why", series={}, h=0, nodes=0)
        rows[1].update(status="singular at t = 0.5 (step 20): why")
        figure = draw(rows)
        self.assertIn(r"1 of 15 runs failed: sphere, KLL, quadratic, level 1 with $\tau$ = 0.025.", texts_of(figure))
        self.assertIn(r"Stopped early, as singular: sphere, Dziuk, linear, $N = 1{,}926$ with $\tau$ = 0.025.", texts_of(figure))
        self.assertEqual(len(lines_of(figure.axes[0])), 4)

    def test_small_tables_give_what_they_have(self):
        only_errors = competitor_row("willmore", "sphere", 2, series={"t": [0, 0.5, 1], "x_nodal_H1": [0, 1e-3, None]})
        self.assertEqual([axes.get_ylabel() for axes in draw([only_errors]).axes], ["error of $x$ in $H^1$, nodal"])
        for row in (competitor_row("willmore", "cube", 2),
                    competitor_row("willmore", "sphere", 2, series={"t": [0]}),
                    competitor_row("willmore", "sphere", 2, status="failed: why")):
            with self.assertRaisesRegex(TableError, "no series x_nodal_H1"):
                draw([row])

    def test_the_script_writes_files(self):
        with tempfile.TemporaryDirectory() as folder:
            result = run_script("willmore_competitors", self.table, folder)
            self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
            self.assertEqual(sorted(os.listdir(folder + "/figures/gallery")),
                             ["willmore_competitors.pdf", "willmore_competitors.png"])


if __name__ == "__main__":
    unittest.main()
