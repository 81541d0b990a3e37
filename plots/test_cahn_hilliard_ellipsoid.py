# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of cahn_hilliard_ellipsoid.py."""
import os
import tempfile
import unittest

import numpy as np

import cahn_hilliard_ellipsoid
from table import SCHEMA, TableError, label_of
from testing import data_lines, figure_named, run_script, slopes_of, texts_of

SHARES = {"u": 0.75, "w": 0.25}
KINDS = (("nodal", 1, 2), ("lifted", 2, 1))  # kind of norm, factor, order in H1


def ellipsoid_table(levels=5, exponents=range(1, 8)):
    """A table like that of cahn_hilliard_ellipsoid: u and w add up to tau^q and h^2, or h in the lifted H1 norm."""
    rows = []
    for level in range(levels):
        for i in exponents:
            h, tau = 0.84 * 2**-level, 0.2 * 2.0**-i
            mesh = {"level": level, "h": h, "nodes": 40 * 4**level, "tau": tau, "steps": 5 * 2**i, "status": "ok"}
            for run, bdf, degree in (("ritz_theta", 1, 1), ("ritz_theta", 3, 1), ("ritz_theta", 2, 1),
                                     ("ritz_theta", 4, 2), ("interpolation", 3, 1), ("order", 3, 1)):
                if run == "interpolation" and (level > 3 or i > 5):
                    continue
                def error(p, bdf=bdf, h=h, tau=tau):
                    return tau**bdf + 0.01 * h**p

                errors = {q: {f"{kind}_{norm}": share * factor * error(p) for kind, factor, h1 in KINDS
                              for norm, p in (("L2", 2), ("H1", h1))} for q, share in SHARES.items()}
                if run == "order":
                    errors["u"] = {norm: 1.0 for norm in errors["u"]}
                rows.append({"cell": f"{run}_p{degree}_bdf{bdf}_h{level}_tau{i}",
                             "labels": {"run": run, "bdf": bdf, "degree": degree}, "errors": errors, **mesh})
    return {"schema": SCHEMA, "experiment": "cahn_hilliard_ellipsoid", "paper": "bk22", "parameters": {}, "rows": rows}


def row_of(table, cell):
    return next(row for row in table["rows"] if row["cell"] == cell)


class CahnHilliardEllipsoid(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.table = ellipsoid_table()
        cls.figures = dict(cahn_hilliard_ellipsoid.draw(cls.table, "lifted"))

    def test_lines_are_step_sizes_against_h_and_meshes_against_tau(self):
        self.assertEqual(list(self.figures), [f"bk22/fig{n}" for n in range(2, 6)])
        for n, count in ((2, [7, 7]), (3, [5, 5]), (4, [5, 5, 7, 7]), (5, [4, 4, 5, 5])):
            figure = self.figures[f"bk22/fig{n}"]
            self.assertEqual([len(data_lines(axes)) for axes in figure.axes], count)
            count = count[-1]
            self.assertEqual([len(legend.get_texts()) for legend in figure.legends], [count])
        self.assertEqual(self.figures["bk22/fig4"].legends[0].get_texts()[0].get_text(), r"$\tau = 0.1$")
        self.assertEqual(self.figures["bk22/fig5"].legends[0].get_texts()[0].get_text(), "$N = 40$")

    def test_slopes_are_those_of_norm_variable_and_method(self):
        self.assertEqual(slopes_of(self.figures["bk22/fig2"]), [["$O(h^{2})$"], ["$O(h)$"]])
        self.assertEqual(slopes_of(self.figures["bk22/fig3"]), [[r"$O(\tau)$"]] * 2)
        self.assertEqual(slopes_of(self.figures["bk22/fig4"]), [["$O(h^{2})$"], ["$O(h)$"]] * 2)
        self.assertEqual(slopes_of(self.figures["bk22/fig5"]), [[r"$O(\tau^{3})$"]] * 4)

    def test_the_nodal_h1_norm_is_one_order_better_in_space(self):
        table = ellipsoid_table(4, (5, 6, 7))
        table["rows"] = [row for row in table["rows"] if label_of(row, "bdf") == 3]
        figures = dict(cahn_hilliard_ellipsoid.draw(table, "nodal"))
        self.assertEqual(slopes_of(figures["bk22/fig4"])[2:], [["$O(h^{2})$"], ["$O(h^{2})$", "$O(h)$"]])
        self.assertEqual(slopes_of(figures["bk22/fig5"])[2:], [[r"$O(\tau^{3})$"]] * 2)

    def test_the_error_is_the_sum_of_u_and_w_in_the_norm_of_the_panel(self):
        table = {**self.table, "rows": [row for row in self.table["rows"] if label_of(row, "bdf") == 3]}
        for kind, factor, h1 in KINDS:
            figure = figure_named("bk22/fig5", cahn_hilliard_ellipsoid.draw(table, kind))
            self.assertEqual([axes.get_title() for axes in figure.axes],
                             [f"$L^\\infty({norm})$, {which}, BDF3"
                              for which in ("lifted, interpolated start", rf"{kind}, Ritz maps, $\vartheta$")
                              for norm in ("L^2", "H^1")])
            np.testing.assert_allclose(data_lines(figure.axes[1])[0].get_ydata()[-1], 2 * (0.1**3 + 0.01 * 0.84))
            for axes, p in zip(figure.axes[2:], (2, h1)):
                np.testing.assert_allclose(data_lines(axes)[0].get_ydata()[-1], factor * (0.1**3 + 0.01 * 0.84**p))

    def test_the_figures_say_how_the_runs_were_started(self):
        for figure in self.figures.values():
            self.assertIn("Ritz maps", texts_of(figure))

    def test_a_line_looks_the_same_for_both_starts(self):
        for n in (4, 5):
            axes = self.figures[f"bk22/fig{n}"].axes
            looks = [[(line.get_color(), line.get_marker()) for line in data_lines(panel)] for panel in (axes[0], axes[2])]
            self.assertEqual(looks[0], looks[1][:len(looks[0])])

    def test_a_missing_quantity_is_no_smaller_error(self):
        table = ellipsoid_table(2, (1, 2))
        del row_of(table, "ritz_theta_p1_bdf3_h0_tau1")["errors"]["w"]
        table["rows"] = [row for row in table["rows"] if label_of(row, "bdf") == 3]
        figure = figure_named("bk22/fig5", cahn_hilliard_ellipsoid.draw(table, "lifted"))
        self.assertEqual(len(data_lines(figure.axes[2])[0].get_xdata()), 1)
        self.assertIn("1 of $L^\\infty(L^2)$", texts_of(figure))

    def test_failed_runs_are_counted_where_they_belong(self):
        table = ellipsoid_table()
        for cell in ("ritz_theta_p1_bdf3_h1_tau2", "interpolation_p1_bdf3_h1_tau2"):
            row_of(table, cell).update(status="failed: why", errors={}, h=0, nodes=0)
        figures = dict(cahn_hilliard_ellipsoid.draw(table, "lifted"))
        for text in (r"1 of 35 runs failed: Ritz maps, $\vartheta$, level 1 with $\tau$ = 0.05.",
                     r"1 of 20 runs failed: interpolated start, level 1 with $\tau$ = 0.05."):
            self.assertIn(text, texts_of(figures["bk22/fig4"]))
        self.assertNotIn("failed", texts_of(figures["bk22/fig2"]))

    def test_small_tables_give_what_they_have(self):
        def drawn(keep):
            table = ellipsoid_table(1, (1,))
            table["rows"] = [row for row in table["rows"] if keep(row)]
            return dict(cahn_hilliard_ellipsoid.draw(table, "lifted"))

        self.assertEqual(len(drawn(lambda row: True)), 4)
        self.assertEqual(list(drawn(lambda row: label_of(row, "bdf") == 3)), ["bk22/fig4", "bk22/fig5"])
        for without in (lambda row: label_of(row, "run") != "ritz_theta", lambda row: label_of(row, "bdf") == 2):
            with self.assertRaisesRegex(TableError, 'no rows with run "ritz_theta"'):
                drawn(without)

    def test_quadratic_runs_alone_have_the_slopes_of_their_degree(self):
        table = ellipsoid_table(3, (1, 2, 3))
        table["rows"] = [dict(row, labels={**row["labels"], "bdf": 3}) for row in table["rows"]
                         if label_of(row, "degree") == 2]
        figure = figure_named("bk22/fig4", cahn_hilliard_ellipsoid.draw(table, "lifted"))
        self.assertEqual(slopes_of(figure), [["$O(h^{3})$"], ["$O(h^{2})$"]])

    def test_a_figure_without_anything_to_show_is_an_error(self):
        table = ellipsoid_table(2, (1, 2))
        for row in table["rows"]:
            if label_of(row, "bdf") == 3:
                row.update(status="failed: why", errors={})
        with self.assertRaisesRegex(TableError, "no errors of u and w in the norm lifted_L2 with BDF3"):
            list(cahn_hilliard_ellipsoid.draw(table, "lifted"))

    def test_the_script_takes_the_kind_of_the_norms(self):
        with tempfile.TemporaryDirectory() as folder:
            result = run_script("cahn_hilliard_ellipsoid", ellipsoid_table(2, (1, 2)), folder, "--norm", "lifted")
            self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
            self.assertEqual(sorted(os.listdir(folder + "/figures/bk22")),
                             [f"fig{n}.{kind}" for n in range(2, 6) for kind in ("pdf", "png")])


if __name__ == "__main__":
    unittest.main()
