# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads tables of experiments (schema esfem-table/1)."""
import json
import math

import numpy as np

SCHEMA = "esfem-table/1"


class TableError(Exception):
    """A table cannot be drawn; the message says what was found where, and what was expected."""


def read_table(path, experiment=None, usable=None):
    """The table in `path` as a dictionary, checked as far as figures need it. Raises TableError.

    `experiment`: the stem that the table must come from, if it matters. `usable`: which rows are drawn, `succeeded`
    unless said otherwise.
    """
    usable = usable or succeeded
    try:
        with open(path, encoding="utf-8") as file:
            table = json.load(file)
    except OSError as error:
        raise TableError(error.strerror) from error
    except ValueError as error:
        raise TableError(f"not JSON: {error}") from error
    schema = table.get("schema") if isinstance(table, dict) else None
    if schema != SCHEMA:
        raise TableError(f'schema is {json.dumps(schema)}, expected "{SCHEMA}"')
    if experiment and table.get("experiment") != experiment:
        raise TableError(f'experiment is {json.dumps(table.get("experiment"))}, expected "{experiment}"')
    if not isinstance(table.get("parameters", {}), dict):
        raise TableError("parameters is not an object")
    rows = table.get("rows")
    if not isinstance(rows, list) or not rows:
        raise TableError("no rows")
    for i, row in enumerate(rows):
        _check_row(row, f"rows[{i}]", usable)
    if not any(usable(row) for row in rows):
        raise TableError(f"none of {len(rows)} runs succeeded; the first: {rows[0]['status']}")
    return table


def _check_row(row, place, usable):
    if not isinstance(row, dict) or not isinstance(row.get("status"), str):
        raise TableError(f"{place}: expected an object with a status")
    if not usable(row):
        return  # a run that failed early may not even have a mesh
    for key in ("h", "nodes", "tau"):
        value = row.get(key)
        if not isinstance(value, (int, float)) or not (0 < value < math.inf):
            raise TableError(f"{place}: {key} is {json.dumps(value)}, expected a positive number")
    if not isinstance(row.get("labels", {}), dict):
        raise TableError(f"{place}: labels is {json.dumps(row['labels'])}, expected an object")
    errors = row.get("errors")
    if not isinstance(errors, dict) or not all(isinstance(norms, dict) for norms in errors.values()):
        raise TableError(f"{place}: errors is not an object {{quantity: {{norm: value}}}}")


def label_of(row, name, otherwise=None):
    """A label of the run, a string or a number."""
    return row.get("labels", {}).get(name, otherwise)


def label_text(labels):
    """Labels for people: "bdf 4, flow dziuk"."""
    return ", ".join(f"{name} {value}" for name, value in sorted(labels.items()))


def succeeded(row):
    """Whether the run of this row finished."""
    return row["status"] == "ok"


def has_series(row):
    """Whether everything that the run wrote is good: it finished, or stopped where the flow becomes singular."""
    return succeeded(row) or row["status"].startswith("singular")


def series(row, name):
    """(times, values) of one quantity as arrays, null being NaN; None when the row does not have it.

    Raises TableError when times and values are no lists of numbers, or not equally many.
    """
    cell, columns = row.get("cell", "?"), row.get("series")
    if not isinstance(columns, dict) or name not in columns:
        return None
    try:
        t, values = (np.array([math.nan if value is None else value for value in columns[key]], dtype=float)
                     for key in ("t", name))
    except (KeyError, TypeError, ValueError) as error:
        raise TableError(f"{cell}: the series {name} or its t is missing or no list of numbers") from error
    if len(t) != len(values) or len(t) == 0:
        raise TableError(f"{cell}: the series {name} has {len(values)} values at {len(t)} times")
    return t, values
