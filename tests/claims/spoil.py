#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Can the checks of claims fail? Spoils the tables of a folder and lists the claims that are met all the same.

    tests/claims/spoil.py [--build DIR] [--known FILE] [FOLDER]     FOLDER has tables, default results/check

A claim on an order has to fail, or no longer to be told, when one order or half an order in its variable is taken away from all errors, one with an upper bound when
an order is added; one on a size or a value with an upper bound when the number is doubled, one with a lower bound when it is
halved. Exempt are bounds at round-off, 1e-9 and less, and numbers that are zero: twice zero is zero, and what is at round-off
jumps by more than a factor when it is wrong. The claims in FILE, "STEM ID: what it does not see" a line, are known not to
see it: they are to become fewer. Exit code 0 when the others fail as they should and no line of the file has become wrong, 3
otherwise."""
import argparse
import copy
import json
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def scaled_errors(table, factor):
    """All errors, and series of errors, of each row times factor(row)."""
    for row in table["rows"]:
        by = factor(row)
        for norms in row.get("errors", {}).values():
            for norm in norms:
                norms[norm] *= by
        for name, values in row.get("series", {}).items():
            if "nodal" in name or "lifted" in name:
                row["series"][name] = [by * value if isinstance(value, (int, float)) else value for value in values]


def with_other_order(variable, change):
    def spoil(table):
        largest = max(row[variable] for row in table["rows"])
        scaled_errors(table, lambda row: (row[variable] / largest) ** change)
    return spoil


def times(factor):
    def spoil(table):
        scaled_errors(table, lambda row: factor)
        for row in table["rows"]:
            for name, value in row.get("values", {}).items():
                if isinstance(value, (int, float)):
                    row["values"][name] = factor * value
    return spoil


SPOILED = {f"an order in {variable} {word}": with_other_order(variable, change)
           for variable in ("h", "tau") for word, change in (("less", -1), ("more", 1))}
SPOILED |= {f"half an order in {variable} less": with_other_order(variable, -0.5) for variable in ("h", "tau")}
SPOILED |= {"twice as large": times(2), "half as large": times(0.5)}
ROUND_OFF = 1e-9


def required(claim):
    """What a claim has to see."""
    least, most = claim.get("at_least", -math.inf), claim.get("at_most", math.inf)
    if claim["kind"] == "order":
        # An order of -8 at least is no bound: the claim is that nothing converges.
        return [f"{what} in {claim['variable']} {word}" for what, word, bounded in
                (("an order", "less", least > -8), ("half an order", "less", least > -8), ("an order", "more", most < math.inf)) if bounded]
    number = float(claim["measured"].split()[0])
    if number < 0:
        least, most = -most, -least
    return [word for word, bounded in (("twice as large", ROUND_OFF < most < math.inf), ("half as large", least > 0))
            if bounded and number != 0]


def verdicts(build, tables):
    """{"STEM ID": claim} of the tables."""
    with tempfile.TemporaryDirectory() as name:
        paths, output = [], pathlib.Path(name, "verdicts.json")
        for table in tables:
            paths.append(pathlib.Path(name, f"{table['experiment']}.json"))
            paths[-1].write_text(json.dumps(table), encoding="utf-8")
        done = subprocess.run([build / "bin/check_orders", *paths, "--output", output], capture_output=True, text=True, check=False,
                              cwd=ROOT)
        if done.returncode not in (0, 3):
            sys.exit(done.stderr)
        entries = json.loads(output.read_text(encoding="utf-8"))["tables"]
    return {f"{entry['experiment']} {claim['id']}": claim for entry in entries for claim in entry["claims"]}


def spoiled(tables, spoil):
    bad = copy.deepcopy(tables)
    for table in bad:
        spoil(table)
    return bad


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", default=ROOT / "results/check", type=pathlib.Path)
    parser.add_argument("--build", default=ROOT / "build", type=pathlib.Path)
    parser.add_argument("--known", type=pathlib.Path)
    arguments = parser.parse_args()
    tables = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(arguments.folder.glob("*.json"))]
    if not tables:
        sys.exit(f"{arguments.folder}: there are no tables")
    good = verdicts(arguments.build, tables)
    bad = {what: verdicts(arguments.build, spoiled(tables, spoil)) for what, spoil in SPOILED.items()}
    blind = []
    for name, claim in good.items():
        missed = [what for what in required(claim) if bad[what][name]["met"]] if claim["met"] else []
        if missed:
            blind.append(f"{name}: {', '.join(missed)}")
    lines = arguments.known.read_text(encoding="utf-8").splitlines() if arguments.known else []
    known = [line for line in lines if line and not line.startswith("#")]
    for line in sorted(set(blind) - set(known)):
        print(f"is met all the same: {line}")
    for line in sorted(set(known) - set(blind)):
        print(f"is no longer so, take it out of {arguments.known}: {line}")
    print(f"{len(good) - len(blind)} claims fail when they should, {len(blind)} do not, {len(known)} of these are known")
    sys.exit(3 if set(blind) != set(known) else 0)


if __name__ == "__main__":
    main()
