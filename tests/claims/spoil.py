#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Can the checks of claims fail? Spoils the tables of a folder and lists the claims that are met all the same.

    tests/claims/spoil.py [--build DIR] [--known FILE] [--json FILE] [FOLDER]     FOLDER has tables, default results/check

Each claim that is met has to fail, or no longer to be told, when
- it is on an order: one order or half an order in its variable is taken away from all errors; with an upper bound, when an
  order is added;
- it is on a size or a value: the number is doubled (upper bound) or halved (lower bound);
- it is on an error: each quantity has the errors of the next one, or the nodal and the lifted norms of a quantity are exchanged,
  where these differ by more than a tenth. Another claim on the same quantity and norm of the same flow may see it instead;
- the finest run of each variant is missing: check_orders counts the runs of a table.
Exempt are bounds at round-off, 1e-9 and less, and numbers that are zero: twice zero is zero, and what is at round-off jumps by
more than a factor when it is wrong. The claims in --known, "STEM ID: what it does not see  # why" a line, are known not to see it:
they are to become fewer. --json writes what each claim catches, {STEM: {ID: ["half an order less in h", ..]}}. Exit code 0 when the
others fail as they should and no line of --known has become wrong, 3 otherwise."""
import argparse
import concurrent.futures
import json
import math
import os
import pathlib
import pickle
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROUND_OFF = 1e-9
QUANTITY, NORM, RUN = "errors of another quantity", "nodal and lifted norms exchanged", "a run missing"
EXCHANGES = (QUANTITY, NORM)


def scaled_errors(table, factor):
    """All errors, and series of errors, of each row times factor(row)."""
    for row in table["rows"]:
        by = factor(row)
        for norms in row["errors"].values():
            for norm in norms:
                norms[norm] *= by
        for name, values in row["series"].items():
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
            for name, value in row["values"].items():
                if isinstance(value, (int, float)):
                    row["values"][name] = factor * value
    return spoil


def exchange_quantities(table):
    """Each quantity of a row has the errors of the next one that has the same norms."""
    for row in table["rows"]:
        groups = {}
        for quantity, norms in row["errors"].items():
            groups.setdefault(tuple(norms), []).append(quantity)
        of = {name: other for group in groups.values() for name, other in zip(group, group[1:] + group[:1])}
        row["errors"] = {name: row["errors"][of[name]] for name in row["errors"]}
        moved = {f"{name}_{norm}": row["series"].get(f"{other}_{norm}") for name, other in of.items() for norm in row["errors"][name]}
        row["series"].update({name: values for name, values in moved.items() if values and name in row["series"]})


def other_norm(norm):
    kind, _, rest = norm.partition("_")
    return {"nodal": "lifted_", "lifted": "nodal_"}.get(kind, kind + "_") + rest


def exchange_norms(table):
    for row in table["rows"]:
        row["errors"] = {quantity: {norm: norms.get(other_norm(norm), error) for norm, error in norms.items()}
                         for quantity, norms in row["errors"].items()}


def variant(row):
    return json.dumps(row.get("labels", {}), sort_keys=True)


def leave_out_a_run(table):
    finest = {}
    for row in table["rows"]:
        finest[variant(row)] = min(finest.get(variant(row), row), row, key=lambda row: (row["h"], row["tau"]))
    table["rows"] = [row for row in table["rows"] if row is not finest[variant(row)]]


SPOILED = {f"{what} {word} in {variable}": with_other_order(variable, change) for variable in ("h", "tau")
           for what, word, change in (("an order", "less", -1), ("half an order", "less", -0.5), ("an order", "more", 1))}
SPOILED |= {"numbers doubled": times(2), "numbers halved": times(0.5), QUANTITY: exchange_quantities, NORM: exchange_norms,
            RUN: leave_out_a_run}


def exchanged_errors(table, spoil):
    """What `spoil` changes by more than a tenth in some row: what `about` says of a claim on these errors."""
    after_all, = spoiled([table], spoil)
    return {about(table["experiment"], labels, quantity, norm)
            for row, after in zip(table["rows"], after_all["rows"]) for labels in fewer_labels(row)
            for quantity, norms in row["errors"].items() for norm, error in norms.items()
            if error > ROUND_OFF and abs(after["errors"][quantity][norm] - error) > 0.1 * error}


def fewer_labels(row):
    """The labels of a row with and without those that `about` sees: a claim may omit them."""
    flow, run = row.get("labels", {}).get("flow"), row.get("labels", {}).get("run")
    return [{"flow": a, "run": b} for a in {flow, None} for b in {run, None}]


def about(stem, labels, quantity, norm):
    """Claims that agree in this are about the same errors."""
    return stem, labels.get("flow"), labels.get("run"), quantity, norm


def about_claim(claim):
    return about(claim["stem"], claim["where"], claim["quantity"], claim.get("norm"))


def required(claim, exchanged):
    """What a claim has to see. exchanged: {spoiling: what exchanged_errors says of it}."""
    least, most = claim.get("at_least", -math.inf), claim.get("at_most", math.inf)
    others = [what for what, errors in exchanged.items() if about_claim(claim) in errors]
    if claim["kind"] == "order":
        # An order of -8 at least is no bound: the claim is that nothing converges.
        return [f"{what} in {claim['variable']}" for what, bounded in
                (("an order less", least > -8), ("half an order less", least > -8), ("an order more", most < math.inf))
                if bounded] + others
    number = float(claim["measured"].split()[0])
    if number < 0:
        least, most = -most, -least
    return [word for word, bounded in (("numbers doubled", ROUND_OFF < most < math.inf), ("numbers halved", least > 0))
            if bounded and number != 0] + others


def verdicts(build, tables):
    """{"STEM ID": claim} of the tables, and those of which runs are missing."""
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
    claims = {f"{entry['experiment']} {claim['id']}": claim | {"stem": entry["experiment"]}
              for entry in entries for claim in entry["claims"]}
    return claims, {entry["experiment"] for entry in entries if entry["runs"]["found"] != entry["runs"]["expected"]}


def without_what_no_claim_reads(table, claims):
    """The table without fits and the numbers that no claim is about, which are most of a file."""
    numbers = {claim["quantity"] for claim in claims}
    series = {f"{claim['quantity']}_{claim['norm']}" for claim in claims if "norm" in claim}
    table["fits"] = []
    for row in table["rows"]:
        row.pop("snapshots", None)
        row.setdefault("errors", {})
        row["values"] = {name: value for name, value in row.get("values", {}).items() if name in numbers}
        row["series"] = {name: values for name, values in row.get("series", {}).items() if name in series}
    return table


def spoiled(tables, spoil):
    bad = pickle.loads(pickle.dumps(tables))
    for table in bad:
        spoil(table)
    return bad


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", default=ROOT / "results/check", type=pathlib.Path)
    parser.add_argument("--build", default=ROOT / "build", type=pathlib.Path)
    parser.add_argument("--known", type=pathlib.Path)
    parser.add_argument("--json", type=pathlib.Path)
    arguments = parser.parse_args()
    tables = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(arguments.folder.glob("*.json"))]
    if not tables:
        sys.exit(f"{arguments.folder}: there are no tables")
    good, _ = verdicts(arguments.build, tables)
    tables = [without_what_no_claim_reads(table, [claim for claim in good.values() if claim["stem"] == table["experiment"]])
              for table in tables]
    exchanged = {table["experiment"]: {what: exchanged_errors(table, SPOILED[what]) for what in EXCHANGES} for table in tables}
    good = {name: claim for name, claim in good.items() if claim["met"]}
    seen = {name: [] for name in good}
    blind = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        after = pool.map(lambda spoil: verdicts(arguments.build, spoiled(tables, spoil)), SPOILED.values())
    for what, (bad, short) in zip(SPOILED, after):
        for name in good:
            if not bad[name]["met"]:
                seen[name].append(what)
        if what == RUN:
            blind += [f"{table['experiment']}: {RUN}" for table in tables if table["experiment"] not in short]
    by_others = {what: {about_claim(good[name]) for name, words in seen.items() if what in words} for what in EXCHANGES}
    for name, claim in good.items():
        missed = [what for what in required(claim, exchanged[claim["stem"]])
                  if what not in seen[name] and about_claim(claim) not in by_others.get(what, ())]
        if missed:
            blind.append(f"{name}: {', '.join(missed)}")
    if arguments.json:
        catches = {}
        for name, words in seen.items():
            stem, claim = name.split(" ")
            catches.setdefault(stem, {})[claim] = words
        arguments.json.write_text(json.dumps(catches, indent=1) + "\n", encoding="utf-8")
    lines = arguments.known.read_text(encoding="utf-8").splitlines() if arguments.known else []
    known = {line.split("  # ")[0] for line in lines if line and not line.startswith("#")}
    for line in sorted(set(blind) - known):
        print(f"is met all the same: {line}")
    for line in sorted(known - set(blind)):
        print(f"is no longer so, take it out of {arguments.known}: {line}")
    print(f"{len(good) - len(blind)} claims fail when they should, {len(blind)} do not, {len(known)} of these are known")
    sys.exit(3 if set(blind) != known else 0)


if __name__ == "__main__":
    main()
