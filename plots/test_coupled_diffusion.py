# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of coupled_diffusion.py."""
import copy
import os
import tempfile
import unittest

import numpy as np

import coupled_diffusion
from table import SCHEMA, TableError, label_of
from testing import data_lines, figure_named, run_script, slopes_of


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
            rows.append({"cell": f"h{level}_tau{k}", "labels": {"run": "convergence", "bdf": 3}, **mesh,
                         "errors": errors})
            for bdf in (2, 3, 4) if level == min(2, levels - 1) else (3,):
                size = (0, 0, 2, 6, 25)[bdf] * tau**(bdf - 1)
                rows.append({"cell": f"difference_bdf{bdf}_h{level}_tau{k}",
                             "labels": {"run": "difference", "bdf": bdf}, **mesh,
                             "errors": {"u_difference": {"nodal_L2": 0.4 * size, "nodal_H1": size}},
                             "values": {"seconds_ratio": 1.3 + 0.1 * (k % 3)}})
            rows.append({"cell": f"none_h{level}_tau{k}", "labels": {"run": "none", "bdf": 3}, **mesh,
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
            row["labels"]["bdf"] = 4
        cubic["rows"] = [row for row in cubic["rows"] if label_of(row, "run") == "convergence"]
        figures = dict(coupled_diffusion.draw(cubic, "lifted"))
        self.assertEqual(slopes_of(figures["nick18/fig1"]), [[r"$O(\tau^{4})$"]] * 2)
        self.assertEqual([slopes[-1] for slopes in slopes_of(figures["nick18/fig2"])], ["$O(h^{4})$", "$O(h^{3})$"])

    def test_panels_show_the_norms_they_name(self):
        table = diffusion_table(2, 2)
        for i, kind in enumerate(("nodal", "lifted")):
            for row in table["rows"]:
                if label_of(row, "run") == "convergence":
                    row["errors"]["u"].update({f"{kind}_L2": 0.01 + i, f"{kind}_H1_semi": 0.03 + i})
        for i, kind in enumerate(("nodal", "lifted")):
            panels = figure_named("nick18/fig3", coupled_diffusion.draw(table, kind)).axes
            self.assertEqual([axes.get_title() for axes in panels], [f"$L^2$ norm, {kind}", f"$H^1$ seminorm, {kind}"])
            self.assertEqual([data_lines(axes)[0].get_ydata()[0] for axes in panels], [0.01 + i, 0.03 + i])
            self.assertEqual(panels[0].get_ylabel(), "error of the solution $u$ at $t = 1$")

    def test_the_difference_has_one_order_less_in_time_and_none_in_space(self):
        figure = self.figures["nick18/fig5"]
        self.assertEqual([len(data_lines(axes)) for axes in figure.axes], [5, 6, 3])
        time, space, methods = slopes_of(figure)
        self.assertEqual((time, space), ([r"$O(\tau^{2})$"], []))
        self.assertEqual(methods, [r"$O(\tau)$", r"$O(\tau^{2})$", r"$O(\tau^{3})$"])
        for order, line in zip((1, 2, 3), data_lines(figure.axes[2])):
            slope = np.polyfit(*np.log(line.get_xydata().T), 1)[0]
            self.assertAlmostEqual(slope, order)
        self.assertEqual(figure.axes[2].get_title(), "time, $N = 3{,}416$")  # where all three methods ran
        self.assertEqual([len(legend.get_texts()) for legend in figure.legends], [5, 6, 3])

    def test_the_price_is_the_median_of_the_runs_with_bdf3(self):
        table = diffusion_table(1, 3)
        table["rows"] = [row for row in table["rows"] if label_of(row, "run") == "difference"]
        for row in table["rows"]:
            if label_of(row, "bdf") != 3:
                row["values"]["seconds_ratio"] = 7
        self.assertIn("(7.2) takes 1.40 times as long as (2.19): the median of 3 runs with BDF3.",
                      self.notes(figure_named("nick18/fig5", coupled_diffusion.draw(table, "lifted"))))
        for row in table["rows"]:
            row["values"] = {"seconds_ratio": None}
        self.assertNotIn("times as long",
                         self.notes(figure_named("nick18/fig5", coupled_diffusion.draw(table, "lifted"))))

    def test_failed_runs_are_counted_where_they_belong(self):
        table = diffusion_table()
        for row in table["rows"]:
            if row["cell"] in ("h2_tau0", "difference_bdf4_h2_tau1"):
                row.update(status="failed: why", errors={}, h=0, nodes=0)
        figures = dict(coupled_diffusion.draw(table, "lifted"))
        for n in range(1, 5):
            self.assertIn(r"1 of 30 runs failed: level 2 with $\tau$ = 0.1.", self.notes(figures[f"nick18/fig{n}"]))
        self.assertIn(r"1 of 42 runs failed: BDF4, level 2 with $\tau$ = 0.05.", self.notes(figures["nick18/fig5"]))

    def test_small_tables_give_what_they_have(self):
        def drawn(keep, levels=2, exponents=2):
            table = diffusion_table(levels, exponents)
            table["rows"] = [row for row in table["rows"] if keep(row)]
            return dict(coupled_diffusion.draw(table, "lifted"))

        self.assertEqual(len(drawn(lambda row: True, 1, 1)), 5)
        self.assertEqual(list(drawn(lambda row: label_of(row, "run") == "difference")), ["nick18/fig5"])
        self.assertEqual(list(drawn(lambda row: label_of(row, "run") == "convergence")),
                         [f"nick18/fig{n}" for n in range(1, 5)])
        self.assertEqual(len(drawn(lambda row: label_of(row, "bdf") == 3)["nick18/fig5"].axes), 2)
        only2 = drawn(lambda row: label_of(row, "bdf") == 2)["nick18/fig5"]
        self.assertEqual(slopes_of(only2), [[r"$O(\tau)$"], []])
        with self.assertRaisesRegex(TableError, "no rows with run"):
            drawn(lambda row: label_of(row, "run") == "none")

    def test_a_figure_without_anything_to_show_is_an_error(self):
        for kind, words in (("difference", "u_difference"), ("convergence", "x in the norm lifted_L2")):
            table = diffusion_table(2, 2)
            for row in table["rows"]:
                if label_of(row, "run") == kind:
                    row.update(status="failed: why", errors={}, labels={"run": kind, "bdf": 2})
            with self.assertRaisesRegex(TableError, f"no errors of {words}"):
                list(coupled_diffusion.draw(table, "lifted"))

    def test_the_script_takes_the_kind_of_the_norms(self):
        with tempfile.TemporaryDirectory() as folder:
            table = diffusion_table(2, 2)
            result = run_script("coupled_diffusion", table, folder, "--norm", "nodal")
            self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
            self.assertEqual(sorted(os.listdir(folder + "/figures/nick18")),
                             [f"fig{n}.{kind}" for n in range(1, 6) for kind in ("pdf", "png")])
            refused = run_script("coupled_diffusion", table, folder, "--norm", "nodal_L2")
            self.assertEqual((refused.returncode, refused.stderr.count("\n")), (1, 1))
            self.assertIn("'nodal', 'lifted'", refused.stderr)


if __name__ == "__main__":
    unittest.main()
