# SPDX-License-Identifier: GPL-3.0-or-later
"""The report's two tables over all experiments, claims and fitted orders, as CSV and LaTeX (booktabs, longtable)."""
import csv
import io

from report_data import verdict
from table import label_text

CLAIM_COLUMNS = ("experiment", "claim", "paper", "place", "basis", "quote", "statement", "verdict", "quantity", "norm", "variable",
                 "labels", "expected", "measured", "rows")
ORDER_COLUMNS = ("experiment", "labels", "quantity", "norm", "variable", "order", "from", "to", "remark", "rows")
PRINTED_CLAIM_COLUMNS = ("place", "statement", "verdict", "expected", "measured")
LATEX = {"\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_", "{": r"\{", "}": r"\}",
         "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "<": "$<$", ">": "$>$", "|": "$|$", "§": r"\S",
         "≥": r"$\ge$", "≤": r"$\le$", "²": "$^2$", "³": "$^3$", "⁴": "$^4$", "·": r"$\cdot$", "π": r"$\pi$", "∫": r"$\int$",
         "–": "--", "’": "'", "λ": r"$\lambda$", "τ": r"$\tau$", "ν": r"$\nu$", "ε": r"$\varepsilon$", "±": r"$\pm$", "→": r"$\to$"}


def claims(results):
    """A row for each check."""
    rows = []
    for statement in results.statements:
        source = statement.source
        for claim in statement.claims:
            rows.append((statement.stem, claim["id"], source["paper"], source["place"], source["basis"], source.get("quote", ""), claim["statement"],
                         verdict(claim), claim["quantity"], claim.get("norm", ""), claim.get("variable", ""),
                         label_text(claim["where"]), claim["expected"], claim["measured"], claim["rows_used"]))
    return rows


def orders(results):
    """A row for each fit, with its 95% interval."""
    return [(stem, label_text(fit.get("labels", {})), fit["quantity"], fit["norm"], fit["variable"], f"{fit['order']:.3f}",
             *([f"{bound:.3f}" for bound in fit["ci95"]] if fit["ci95"] else ["", ""]),
             fit.get("remark", ""), fit.get("rows_used", ""))
            for stem, table in results.tables.items() for fit in table.get("fits", [])]


def as_csv(columns, rows):
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows([columns, *rows])
    return stream.getvalue()


def as_latex(columns, rows, caption):
    """A longtable of the rows, one caption and head for all its pages."""
    def line(cells):
        return " & ".join("".join(LATEX.get(letter, letter) for letter in str(cell)) for cell in cells) + r" \\"
    wide = {"statement": "p{.36\\linewidth}", "place": "p{.15\\linewidth}", "labels": "p{.2\\linewidth}"}
    format_ = "".join(wide.get(column, "l") for column in columns)
    return "\n".join([r"% needs \usepackage{booktabs,longtable}", rf"\begin{{longtable}}{{{format_}}}",
                      rf"\caption{{{caption}}}\\", r"\toprule", line(columns), r"\midrule", r"\endhead", *map(line, rows),
                      r"\bottomrule", r"\end{longtable}", ""])


def exports(results):
    """{file name: text}"""
    all_claims, all_orders = claims(results), orders(results)
    printed = [[row[CLAIM_COLUMNS.index(column)] for column in PRINTED_CLAIM_COLUMNS] for row in all_claims]
    return {"claims.csv": as_csv(CLAIM_COLUMNS, all_claims),
            "claims.tex": as_latex(PRINTED_CLAIM_COLUMNS, printed, "Claims and verdicts."),
            "orders.csv": as_csv(ORDER_COLUMNS, all_orders),
            "orders.tex": as_latex(ORDER_COLUMNS, all_orders, "Fitted orders with 95\\% intervals.")}
