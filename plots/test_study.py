# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of study.py."""
import os
import tempfile
import unittest

from study import draw
from table import SCHEMA, TableError
from testing import data_lines, references, run_script, slopes_of, texts_of


def study_table(levels=4, steps=1, kind="closest", degree=2, superconvergent=0):
    """Errors h^3 in L2 and h^2 in H1 of x and u, or higher powers by `superconvergent`; with `closest` the finest run has none."""
    rows, in_time = [], 1e-3 if steps > 1 else 0
    for level in range(levels):
        for step in range(steps):
            h, tau = 0.5**level, 0.01 * 0.5**step
            errors = {q: {f"{kind}_L2": h**(degree + 1 + superconvergent) + in_time * (tau / 0.01)**2, f"{kind}_H1": h**degree,
                          f"{kind}_H1_semi": h**degree} for q in ("u", "x")}
            rows.append({"cell": f"h{level}_tau{step}", "level": level, "h": h, "nodes": 40 * 4**level, "tau": tau,
                         "steps": 10 * 2**step, "status": "ok", "errors": errors, "labels": {}})
    if kind == "closest":
        rows[-1]["errors"] = {}
    return {"schema": SCHEMA, "experiment": "study", "paper": "", "rows": rows,
            "parameters": {"configuration": {"degree": degree, "bdf": 2}}}


class Study(unittest.TestCase):
    def test_one_figure_for_each_variable_that_varies(self):
        self.assertEqual([name for name, _ in draw(study_table(), "L2")], ["study_h"])
        self.assertEqual([name for name, _ in draw(study_table(levels=1, steps=4), "L2")], ["study_tau"])
        self.assertEqual([name for name, _ in draw(study_table(steps=3), "L2")], ["study_h", "study_tau"])
        with self.assertRaisesRegex(TableError, "several levels or steps"):
            list(draw(study_table(levels=1, kind="nodal"), "L2"))

    def test_the_finest_run_is_no_failure(self):
        (_, figure), = draw(study_table(), "H1")
        self.assertEqual(texts_of(figure), "")
        self.assertEqual([len(line.get_xdata()) for axes in figure.axes for line in data_lines(axes)], [3, 3])
        self.assertIn("closest point", figure.axes[0].get_ylabel())
        self.assertEqual([axes.get_title() for axes in figure.axes], ["surface $x$", "solution $u$"])

    def test_the_dashed_line_is_the_order_of_the_norm(self):
        for kind, norm, order in (("closest", "L2", 3), ("nodal", "L2", 3), ("lifted", "H1", 2), ("nodal", "H1_semi", 2)):
            (_, figure), = draw(study_table(kind=kind), norm)
            self.assertEqual(slopes_of(figure), [[f"$O(h^{{{order}}})$"]] * 2)
            dashed, = references(figure.axes[0])
            self.assertTrue(dashed.is_dashed())
        (_, figure), = draw(study_table(levels=5, kind="nodal", superconvergent=1), "L2")
        self.assertEqual(sorted(slopes_of(figure)[0]), ["$O(h^{3})$", "$O(h^{4})$"])

    def test_slopes_are_those_of_the_configuration(self):
        (_, figure), = draw(study_table(levels=5, degree=3, kind="lifted"), "H1")
        self.assertIn("$O(h^{3})$", slopes_of(figure)[0])
        (_, figure), = draw(study_table(levels=1, steps=4, kind="nodal"), "L2")
        self.assertIn(r"$O(\tau^{2})$", slopes_of(figure)[0])

    def test_failed_runs_are_named(self):
        table = study_table(levels=5, kind="nodal")
        table["rows"][1].update(status="failed: no", errors={})
        (_, figure), = draw(table, "L2")
        self.assertIn("1 of 5 runs failed", texts_of(figure))

    def test_the_script_writes_beside_the_table_or_elsewhere(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(run_script("study", study_table(), folder).returncode, 0)
            self.assertEqual(sorted(os.listdir(os.path.join(folder, "figures"))), ["study_h.pdf", "study_h.png"])
            said = run_script("study", study_table(kind="nodal"), folder, "--norm", "L3")
            self.assertEqual(said.returncode, 1)
            self.assertIn("H1_semi", said.stderr)
            wrong = {**study_table(), "experiment": "mcf_sphere"}
            self.assertIn('expected "study"', run_script("study", wrong, folder).stderr)


if __name__ == "__main__":
    unittest.main()
