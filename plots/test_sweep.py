# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of sweep.py."""
import contextlib
import io
import json
import os
import tempfile
import unittest
import unittest.mock

import sweep
from sweep import phase_diagram
from table import SCHEMA, TableError


def sweep_table(gammas=(10, 30, 100), flows=("dziuk", "bgn"), seeds=(1,)):
    rows = []
    for gamma in gammas:
        for flow in flows:
            for seed in seeds:
                labels = {"parameters.gamma": gamma, "flow": flow}
                if len(seeds) > 1:
                    labels["parameters.seed"] = seed
                rows.append({"cell": f"{gamma}{flow}{seed}", "level": 0, "h": 0.3, "nodes": 162, "tau": 0.01, "steps": 4,
                             "status": "ok", "seconds": 0.1, "labels": labels, "errors": {"u": {"nodal_L2": 1e-3 * gamma}},
                             "values": {"max_u1": gamma + 0.5 * len(flow), "area": 12.5}})
    return {"schema": SCHEMA, "experiment": "evolve", "paper": "", "parameters": {}, "rows": rows}


def squares(axes):
    return {(round(patch.get_x() + 0.5), round(patch.get_y() + 0.5)): patch.get_facecolor() for patch in axes.patches}


class Sweep(unittest.TestCase):
    def test_each_row_has_its_square_and_number(self):
        figure = phase_diagram(sweep_table(), "parameters.gamma", "flow", "max_u1")
        axes = figure.axes[0]
        self.assertEqual(len(squares(axes)), 6)
        self.assertEqual([text.get_text() for text in axes.get_xticklabels()], ["10", "30", "100"])
        self.assertEqual([text.get_text() for text in axes.get_yticklabels()], ["dziuk", "bgn"])
        written = {tuple(map(round, text.get_position())): text.get_text() for text in axes.texts}
        self.assertEqual(written[2, 1], "102")
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel(), axes.get_title()), ("gamma", "flow", "max_u1"))

    def test_numbers_have_three_digits_and_labels_are_short(self):
        for value, text in ((1.8, "1.80"), (102.4, "102"), (-0.05, "-0.0500"), (1234, "1.23e+03"), (0, "0.00"), (3e-7, "3.00e-07")):
            self.assertEqual(sweep.three_digits(value), text)
        axes = phase_diagram(sweep_table(), "gamma", "flow", "area").axes[0]
        self.assertEqual({text.get_text() for text in axes.texts}, {"12.5"})
        for name, label in (("parameters.gamma", "gamma"), ("flow", "flow"), ("kinetics.diffusion.1", "diffusion.1")):
            self.assertEqual(sweep.label_of(name), label)

    def test_colours_follow_the_numbers(self):
        axes = phase_diagram(sweep_table(), "gamma", "flow", "u_nodal_L2").axes[0]
        found = squares(axes)
        self.assertEqual(found[0, 0], found[0, 1])
        self.assertNotEqual(found[0, 0], found[2, 0])
        equal = phase_diagram(sweep_table(), "gamma", "flow", "area").axes[0]
        self.assertEqual(len(set(squares(equal).values())), 1)

    def test_words_have_a_legend_and_failed_runs_are_crossed_out(self):
        table = sweep_table()
        table["rows"][0].update(status="failed: u is not finite at t = 0.3", errors={}, values={})
        table["rows"][1]["status"] = "singular at t = 0.2 (step 4): why"
        axes = phase_diagram(table, "gamma", "flow", "status").axes[0]
        self.assertEqual([text.get_text() for text in axes.get_legend().get_texts()], ["failed", "singular", "ok"])
        self.assertEqual(len([line for line in axes.lines if line.get_gid() == "failed"]), 4)
        axes = phase_diagram(table, "gamma", "flow", "max_u1").axes[0]
        self.assertEqual(len(axes.texts), 5)  # the value until the singularity is good

    def test_more_keys_need_a_choice(self):
        table = sweep_table(seeds=(1, 2))
        with self.assertRaisesRegex(TableError, "--where"):
            phase_diagram(table, "gamma", "flow", "max_u1")
        figure = phase_diagram(table, "gamma", "flow", "max_u1", ["seed=2"])
        self.assertIn("seed=2", figure.axes[0].get_title())
        with self.assertRaisesRegex(TableError, "no row"):
            phase_diagram(table, "gamma", "flow", "max_u1", ["seed=3"])

    def test_unknown_names_are_answered_by_the_known_ones(self):
        for names in (("gama", "flow", "max_u1"), ("gamma", "flow", "max_u9")):
            with self.assertRaisesRegex(TableError, "max_u1, .*parameters.gamma"):
                phase_diagram(sweep_table(), *names)

    def test_the_script_writes_beside_the_table(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "table.json")
            with open(path, "w", encoding="utf-8") as file:
                json.dump(sweep_table(), file)
            options = ["sweep.py", path, "--x", "gamma", "--y", "flow", "--colour", "max_u1"]
            with unittest.mock.patch("sys.argv", options):
                sweep.main()
            self.assertEqual(sorted(os.listdir(folder)), ["sweep.pdf", "sweep.png", "table.json"])
            complaint = io.StringIO()
            with unittest.mock.patch("sys.argv", options[:-1] + ["max_w"]), contextlib.redirect_stderr(complaint), \
                    self.assertRaises(SystemExit) as end:
                sweep.main()
            self.assertIn("max_w: no row has it", str(end.exception.code))


if __name__ == "__main__":
    unittest.main()
