# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of the report: fitted orders, runs, and where they come from."""
import html
import re

from report_html import number, table, tag, text
from table import label_of, label_text

NORMS = {"lifted_L2": "lifted L<sup>2</sup>", "lifted_H1": "lifted H<sup>1</sup>", "nodal_L2": "nodal L<sup>2</sup>",
         "nodal_H1": "nodal H<sup>1</sup>"}
SHOWN = ("lifted_H1", "nodal_H1", "lifted_L2", "nodal_L2")  # the first that there is
PRINTED_RUNS, PRINTED_ORDERS = 90, 40  # longer tables are for the screen: paper has the CSV


def order_words(fit):
    """An order with its interval, or with what is to be said instead."""
    remark = fit.get("remark", "")
    if remark == "no dependence":
        return remark
    if not fit["ci95"]:
        return f"{fit['order']:.2f} ({text(remark)})"
    return f"{fit['order']:.2f} ± {(fit['ci95'][1] - fit['ci95'][0]) / 2:.2f}"


def fits_table(entry):
    """Orders in h and tau with their intervals: a row for each variant and norm, a column for each quantity."""
    orders, quantities = {}, []
    for fit in entry.get("fits", []):
        quantity, norm = fit["quantity"], fit["norm"]
        if norm not in NORMS or fit["order"] == 0:
            continue  # other norms are in the table itself; 0 stands for errors at round-off
        if quantity not in quantities:
            quantities.append(quantity)
        words = f"{text(fit['variable'])}: {order_words(fit)}"
        orders.setdefault((label_text(fit.get("labels", {})), norm), {}).setdefault(quantity, []).append(words)
    if not orders:
        return ""
    order_of_norm = list(NORMS)
    rows = [[_plain(labels), NORMS[norm],
             *("<br>".join(found.get(quantity, [])) for quantity in quantities)]
            for (labels, norm), found in sorted(orders.items(), key=lambda item: (item[0][0], order_of_norm.index(item[0][1])))]
    heads = ["orders", "norm", *(text(quantity.replace("_", " ")) for quantity in quantities)]
    class_ = "numbers screen" if len(rows) > PRINTED_ORDERS else "numbers"
    return tag("div", table(heads, rows, class_), class_="scroll")


def runs_table(entry, stem):
    """All runs: mesh, step size, and the H1 errors of each quantity or, where there are none, their values."""
    rows = entry["rows"]
    columns = _columns(rows)
    labels = dict.fromkeys(name for row in rows for name in row.get("labels", {}))
    body = []
    for row in rows:
        cells = [*(_plain(label_of(row, name, "")) for name in labels), number(row.get("nodes")), number(row.get("h")),
                 number(row.get("tau")), number(row.get("seconds"))]
        cells += [read(row) for _, read in columns]
        body.append(cells + [_status(row["status"])])
    heads = [*(text(label) for label in labels), "N", "h", "τ", "s", *(head for head, _ in columns), "status"]
    failed = sum(row["status"] != "ok" for row in rows)
    summary = f"{len(rows)} runs" + (f", {failed} of which stopped early" if failed else "")
    where = tag("p", f"{summary}; all norms in {tag('code', stem + '.csv')} and {tag('code', stem + '.tex')}.", class_="note")
    runs = tag("div", table(heads, body, "numbers"), class_="scroll")
    screen = " screen" if len(rows) > PRINTED_RUNS else ""
    return where + tag("details", tag("summary", "all runs", class_="screen") + runs, class_="runs" + screen)


def _plain(label):
    return html.escape(str(label).replace("_", " "))


def _status(status):
    """ok, or what happened and when, in short."""
    when = re.match(r"(singular|failed).*? t = ([\d.e+-]+)", status)
    return f"{when[1]} at {when[2]}" if when else html.escape(status[:40])


def _error(norms, shown):
    """The first of the norms that the row has; a mark says when it is not that of the column's head."""
    norm = next((norm for norm in shown if norm in norms), None)
    if norm is None:
        return ""
    return number(norms[norm]) + ("" if norm == shown[0] else f" <small>({NORMS[norm].partition(' ')[0]})</small>")


def _columns(rows):
    """(heading, function of a row) for what is shown of the rows."""
    norms = {}
    for row in rows:
        for quantity, found in row.get("errors", {}).items():
            norms.setdefault(quantity, set()).update(found)
    columns = []
    for quantity, found in norms.items():
        shown = [norm for norm in SHOWN if norm in found] or sorted(found)[:1]
        columns.append((f"{text(quantity.replace('_', ' '))}, {NORMS.get(shown[0], _plain(shown[0]))}",
                        lambda row, q=quantity, n=shown: _error(row.get("errors", {}).get(q, {}), n)))
    if columns:
        return columns
    names = dict.fromkeys(name for row in rows for name in row.get("values", {}))
    return [(text(name.replace("_", " ")), lambda row, n=name: number(row.get("values", {}).get(n))) for name in list(names)[:9]]


def provenance_table(tables):
    """One row for each table, and what all of them share."""
    rows, shared = [], {}
    for stem, entry in tables.items():
        origin, runs = entry.get("provenance", {}), entry["rows"]
        commit = number(origin.get("git", ""))[:12] + (" (with changes)" if origin.get("dirty") else "")
        rows.append([tag("code", stem), commit, number(origin.get("date", "")), str(len(runs)),
                     f"{sum(row.get('seconds', 0) for row in runs):.0f}",
                     f"{max((row.get('peak_memory_mb', 0) for row in runs), default=0):.0f}",
                     tag("code", number(origin.get("command", "")))])
        for key in ("version", "compiler", "flags", "cpu", "threads"):
            shared.setdefault(key, dict.fromkeys([])).update({str(origin.get(key, "")): None})
    common = "".join(tag("li", f"{key}: {tag('code', text(', '.join(values)))}") for key, values in shared.items())
    return (tag("ul", common) + table(["table", "commit", "date", "runs", "seconds", "MB", "command"], rows, "provenance")
            + tag("p", "Seconds are those of all runs together, megabytes those of the largest. Every table is there as JSON, CSV "
                  "and LaTeX under the name of its experiment, every figure as PDF and PNG.", class_="note"))
