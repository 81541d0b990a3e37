#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Did a change of the program change the numbers? Compares all tables of two folders, cell by cell.

    cp -r results/paper /tmp/before    # then change something, and make figures again
    plots/compare_results.py /tmp/before results/paper

For each table: the largest relative deviation of an error and where, of a series, the rows whose status differs and
the fitted orders that differ in the two digits that are printed. Errors below --floor in both tables are round-off.
Exits 3 when anything is beyond the tolerance, or a row is missing.
"""
import argparse
import json
import math
import pathlib
import sys


def deviation(before, after, floor):
    """Relative to the larger one; 0 where both are round-off or neither is a number."""
    if before is None or after is None or not (math.isfinite(before) and math.isfinite(after)):
        return 0.0 if before == after or (before != before and after != after) else math.inf
    largest = max(abs(before), abs(after))
    return abs(before - after) / largest if largest > floor else 0.0


def errors_of(row):
    return {f"{quantity} {norm}": value
            for quantity, norms in row.get("errors", {}).items() for norm, value in norms.items()}


def series_of(row):
    """Each series by name; its deviations are relative to its largest value."""
    return {name: values for name, values in row.get("series", {}).items()
            if isinstance(values, list) and all(isinstance(v, (int, float)) for v in values)}


def series_deviation(before, after):
    if len(before) != len(after):
        return math.inf
    size = max((abs(v) for v in before + after if math.isfinite(v)), default=0)
    return max((abs(b - a) / size for b, a in zip(before, after) if b != a), default=0.0) if size else 0.0


class Comparison:
    """What differs between two tables of one experiment."""

    def __init__(self, before, after, floor):
        self.error = self.series = (0.0, "")
        self.errors = 0
        self.differences = []
        rows = {row["cell"]: row for row in after["rows"]}
        for row in before["rows"]:
            cell = row["cell"]
            if cell not in rows:
                self.differences.append(f"{cell}: no such row any more")
                continue
            self.compare_rows(cell, row, rows.pop(cell), floor)
        self.differences += [f"{cell}: a new row" for cell in rows]
        self.compare_fits(before.get("fits", []), after.get("fits", []))

    def compare_rows(self, cell, before, after, floor):
        # The time and element of a singularity are numbers of their own.
        kinds = [row["status"].split(" at ")[0].split(":")[0] for row in (before, after)]
        if kinds[0] != kinds[1]:
            self.differences.append(f"{cell}: was {before['status']}, is {after['status']}")
            return
        others = errors_of(after)
        for name, value in errors_of(before).items():
            self.errors += 1
            found = (deviation(value, others.get(name, math.nan), floor), f"{cell}, {name}")
            self.error = max(self.error, found)
        others = series_of(after)
        for name, values in series_of(before).items():
            if name in others:
                self.series = max(self.series, (series_deviation(values, others[name]), f"{cell}, {name}"))

    def compare_fits(self, before, after):
        def key(fit):
            return tuple(str(fit.get(k)) for k in sorted(fit) if k not in ("order", "ci95", "rows_used"))

        orders = {key(fit): fit.get("order") for fit in after}
        for fit in before:
            order, now = fit.get("order"), orders.get(key(fit))
            if order is None or now is None:
                if order != now:
                    self.differences.append(f"fit of {fit.get('quantity')} {fit.get('norm')}: was {order}, is {now}")
            elif f"{order:.2f}" != f"{now:.2f}" and abs(order - now) > 1e-3:
                self.differences.append(f"order of {fit.get('quantity')} {fit.get('norm')} in {fit.get('variable')}: "
                                        f"was {order:.4f}, is {now:.4f}")


def compare_folders(before, after, floor):
    """{stem: Comparison} of the tables that both folders have."""
    comparisons = {}
    for file in sorted(before.glob("*.json")):
        other = after / file.name
        if other.exists():
            comparisons[file.stem] = Comparison(json.loads(file.read_text()), json.loads(other.read_text()), floor)
    return comparisons


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", type=pathlib.Path)
    parser.add_argument("after", type=pathlib.Path)
    parser.add_argument("--tolerance", type=float, default=1e-6, help="largest relative deviation of an error")
    parser.add_argument("--floor", type=float, default=1e-9, help="errors below this in both are not compared")
    options = parser.parse_args()
    comparisons = compare_folders(options.before, options.after, options.floor)
    if not comparisons:
        sys.exit(f"no table of {options.before} is in {options.after}")
    failed = False
    for stem, found in comparisons.items():
        print(f"{stem}: {found.errors} errors, largest deviation {found.error[0]:.1e} ({found.error[1]}); "
              f"series {found.series[0]:.1e} ({found.series[1]})")
        for difference in found.differences:
            print(f"  {difference}")
        failed = failed or found.error[0] > options.tolerance or bool(found.differences)
    sys.exit(3 if failed else 0)


if __name__ == "__main__":
    main()
