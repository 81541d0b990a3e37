# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of mcf_dumbbell.py."""
import json
import os
import tempfile
import unittest

import meshio
import numpy as np

import mcf_dumbbell
from snapshots import Snapshots
from table import SCHEMA, TableError, label_of
from testing import lines_of, run_script, sphere


METHODS = {"dziuk": ("dziuk", "plain", 2), "kll": ("mean_curvature", "plain", 2), "bgn": ("bgn", "plain", 2),
           "bgn_p1": ("bgn", "plain", 1), "euler": ("euler", "plain", 2),
           **{f"kll_{variant}": ("mean_curvature", variant, 2)
              for variant in ("normalised", "interpolated", "alpha1", "alpha10", "alpha100")}}


def dumbbell_row(method, start="cascade", tau=0.003, level=1, end=0.078, **changes):
    t = np.arange(0, end + tau / 2, tau)
    columns = {"t": t, "max_H": 6 / (1.1 - t / end), "worst_angle": 36 - 300 * t, "neck_radius": 0.2 * (1.05 - t / end)}
    if method.startswith("kll"):
        columns.update(min_nu=1 - t, max_nu=1 + 20 * t)
    flow, variant, degree = METHODS[method]
    cell = f"{flow}_{variant}_p{degree}_{start.replace(':', '')}_h{level}_{tau:g}"
    row = {"cell": cell, "labels": {"flow": flow, "variant": variant, "degree": degree, "start": start}, "level": level,
           "h": 0.18 / 2**level, "nodes": 3002 if level == 0 else 10522, "tau": tau, "steps": len(t) - 1, "errors": {},
           "status": f"singular at t = {end:g} (step {len(t)}): why", "values": {"pinch_time": end},
           "series": {name: values.tolist() for name, values in columns.items()},
           "snapshots": [{"t": t[n], "file": f"surfaces_{n:04d}.vtu"} for n in range(0, len(t), 2)],
           "singular_surface": {"t": end + tau, "file": "singular.vtu", "extrapolated": flow == "dziuk"}}
    return {**row, **changes}


def dumbbell_table():
    methods = ("dziuk", "kll", "kll_normalised", "kll_alpha1", "kll_alpha10", "kll_alpha100")
    rows = [dumbbell_row(method, end=0.072 + 0.003 * i) for i, method in enumerate(methods)]
    rows += [dumbbell_row(method, level=0) for method in methods[:3]]
    rows += [dumbbell_row(method, "substeps:16", tau) for method in methods[:3] for tau in (0.003, 0.0015)]
    rows.append(dumbbell_row("kll", "substeps:16", 0.00075))
    rows += [dumbbell_row("bgn", "cascade", tau, level) for tau in (0.003, 0.0015) for level in (0, 1)]
    rows.append(dumbbell_row("bgn_p1", "cascade", status="failed: why", series={}, snapshots=[], h=0))
    return {"schema": SCHEMA, "experiment": "mcf_dumbbell", "paper": "kll19", "parameters": {}, "rows": rows}


def write_snapshots(table, folder):
    """One small surface for all times, a little smaller at later ones."""
    ball = sphere(1)
    for row in table["rows"]:
        cell = os.path.join(folder, "cells", "mcf_dumbbell", row["cell"])
        os.makedirs(cell, exist_ok=True)
        for entry in [*row["snapshots"], row["singular_surface"]]:
            points = ball.points * [0.3, 0.3, 1] * (1 - 4 * entry["t"])
            meshio.write(os.path.join(cell, entry["file"]), meshio.Mesh(points, [("triangle6", ball.triangles)]))


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
        finer = [*rows, dumbbell_row("bgn", "cascade", 0.000375)]
        self.assertEqual(mcf_dumbbell.good_setting(finer).runs["bgn"]["tau"], 0.000375)
        self.assertTrue(all(row["level"] == 1 for setting in (paper, good) for row in setting.runs.values()))
        self.assertIsNone(mcf_dumbbell.good_setting([row for row in rows if label_of(row, "start") == "cascade"]))
        self.assertIsNone(mcf_dumbbell.paper_setting([{**row, "status": "failed: why"} for row in rows]))

    def test_methods_have_names(self):
        for method in METHODS:
            self.assertEqual(mcf_dumbbell.method_of(dumbbell_row(method)), method)
        self.assertEqual(set(METHODS) - {"euler"}, set(mcf_dumbbell.LABELS))

    def test_headings_say_mesh_step_and_start(self):
        good = mcf_dumbbell.good_setting(self.table["rows"])
        self.assertEqual(good.heading(good.runs), r"$N = 10{,}522$, $\tau = 0.0015$, start with 16 substeps a step")
        good.runs["bgn"] = {**good.runs["bgn"], "tau": 0.003}
        self.assertTrue(good.heading(good.runs).endswith(r"; BGN: $\tau = 0.003$"))
        self.assertNotIn("BGN", good.heading(("kll",)))
        good.runs["bgn"]["nodes"] = 2632
        self.assertTrue(good.heading(good.runs).endswith(r"; BGN: $N = 2{,}632$, $\tau = 0.003$"))

    def test_snapshots_are_those_within_half_a_step(self):
        snapshots = Snapshots(dumbbell_row("kll"), "results", "mcf_dumbbell")
        self.assertEqual([t for t, _ in snapshots.files][:2], [0, 0.006])
        self.assertEqual(snapshots.at(0.03)[1], "results/cells/mcf_dumbbell/mean_curvature_plain_p2_cascade_h1_0.003/"
                                                "surfaces_0010.vtu")
        self.assertIsNone(snapshots.at(0.032))
        self.assertAlmostEqual(snapshots.last()[0], 0.078)
        for entries in ([{"t": 0}], ["a.vtu"], [{"t": None, "file": "a.vtu"}], [{"t": 0, "file": 3}]):
            with self.assertRaisesRegex(TableError, "mean_curvature_plain_p2_cascade_h1_0.003: snapshots"):
                Snapshots(dumbbell_row("kll", snapshots=entries), "results", "mcf_dumbbell")

    def test_all_figures_are_there(self):
        self.assertEqual(list(self.figures), [f"kll19/fig13_{name}" for name in ("3", "3_good_start", "4", "5", "6")])

    def test_the_surfaces_have_one_scale_and_a_panel_for_each_time_and_method_until_it_stops(self):
        for name, panels, stops in (
                ("kll19/fig13_3", 16, ["stops: extrapolated, $t = 0.075$", "stops: $t = 0.078$", "stops: $t = 0.081$"]),
                ("kll19/fig13_3_good_start", 28, ["stops: extrapolated, $t = 0.0795$", *3 * ["stops: $t = 0.0795$"]])):
            figure = self.figures[name]
            self.assertEqual(sum(bool(axes.collections) for axes in figure.axes), panels)
            scales = [axes.get_position().size * figure.get_size_inches() / [np.ptp(axes.get_xlim()),
                                                                             np.ptp(axes.get_ylim())]
                      for axes in figure.axes]
            np.testing.assert_allclose(scales, np.full_like(scales, scales[0][0]))
            self.assertLess(figure.get_size_inches()[1], 10)
            self.assertEqual([axes.texts[0].get_text() for axes in figure.axes if axes.texts], stops)

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
            self.assertEqual(colours | {"black"}, set(legend.values()))
        styles = [(str(line["color"]), str(line["linestyle"]), line["marker"]) for line in mcf_dumbbell.LINES.values()]
        for kind in zip(*styles):
            self.assertEqual(len(set(kind)), len(styles))

    def test_runs_that_end_early_lie_on_top_and_every_line_has_a_mark_at_its_end(self):
        for axes in self.figures["kll19/fig13_5"].axes:
            lines = [line for line in lines_of(axes) if line.get_color() != "black"]
            ends = [line.get_xdata()[-1] for line in lines]
            self.assertEqual(ends, sorted(ends, reverse=True))
            for line in lines:
                self.assertEqual(line.get_markevery()[-1], len(line.get_xdata()) - 1)

    def test_minimum_and_maximum_of_the_normal_have_two_line_styles_and_lengths_near_one_are_spread(self):
        for axes in self.figures["kll19/fig13_6"].axes:
            lines = lines_of(axes)
            self.assertEqual([line.get_linestyle() for line in lines], ["-"] * (len(lines) // 2) + ["--"] * (len(lines) // 2))
            near, far = (np.diff(axes.transData.transform([(0, a), (0, b)])[:, 1])[0] for a, b in ((1, 1.02), (1.5, 1.52)))
            self.assertGreater(near, 10 * far)
            values = np.concatenate([line.get_ydata() for line in lines])
            self.assertTrue(axes.get_ylim()[0] < values.min() and values.max() < axes.get_ylim()[1])

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
        self.assertIn(r"1 of 21 runs failed: BGN, linear elements, $N = 10{,}522$ with $\tau$ = 0.003.", notes)

    def test_a_missing_snapshot_is_named(self):
        row = dumbbell_row("dziuk", snapshots=[{"t": 0, "file": "gone.vtu"}])
        with self.assertRaisesRegex(TableError, "cells/mcf_dumbbell/dziuk_plain_p2_cascade_h1_0.003/gone.vtu: no such"):
            list(mcf_dumbbell.draw({"rows": [row]}, self.folder))

    def test_small_tables_give_what_they_have(self):
        rows = [dumbbell_row("dziuk", level=0), dumbbell_row("bgn", "cascade", level=0, snapshots=[])]
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
        for rows in ([dumbbell_row("bgn", "cascade")], [dumbbell_row("euler")]):
            with self.assertRaisesRegex(TableError, "no runs"):
                list(mcf_dumbbell.draw({"rows": rows}, self.folder))

    def test_the_script_writes_files_and_has_no_norm(self):
        table = {**self.table, "rows": [dumbbell_row("kll_normalised")]}
        result = run_script("mcf_dumbbell", table, self.folder)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        written = sorted(os.listdir(self.folder + "/figures/kll19"))
        self.assertEqual(written, [f"fig13_{n}.{kind}" for n in (3, 4, 5, 6) for kind in ("pdf", "png")])
        refused = run_script("mcf_dumbbell", table, self.folder, "--norm", "nodal_L2")
        self.assertEqual((refused.returncode, refused.stderr.count("\n")), (1, 1))


if __name__ == "__main__":
    unittest.main()
