# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of script.py."""
import copy
import json
import os
import pathlib
import tempfile
import unittest
import unittest.mock

from mcf_sphere import draw
from script import run
from table import has_series, read_table
from testing import FOLDER, run_process, synthetic_table


SCRIPT = os.path.join(FOLDER, "mcf_sphere.py")


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
        return run_process("mcf_sphere", table, self.folder, *options)

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

    def test_singular_runs_count_only_where_series_are_drawn(self):
        for row in self.table["rows"]:
            row["status"] = "singular at t = 0.08 (step 27): why"
        self.assertIn("none of 6 runs", self.complaint(self.command(self.table)))
        path = self.command(self.table)[1]
        self.assertEqual(len(read_table(path, usable=has_series)["rows"]), 6)


if __name__ == "__main__":
    unittest.main()
