# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line that all plotting scripts share."""
import argparse
import os
import sys

import style
from table import TableError, has_series, read_table, succeeded

NORMS = ("nodal_L2", "nodal_H1", "nodal_H1_semi", "lifted_L2", "lifted_H1", "lifted_H1_semi")


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        sys.exit(f"{self.prog}: {message} (--help lists what is accepted)")  # exit 1: argparse would take 2


def parser_of(description):
    """A parser of command lines whose errors are one line, and exit 1."""
    return _Parser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)


def run(experiment, draw, description, default_norm=None, norms=NORMS, beside_table=False):
    """The main function of a plotting script: `SCRIPT TABLE FOLDER [--norm NORM]`.

    `draw(table, norm)` yields (name, figure), name being e.g. "kll19/fig13_1"; each goes to FOLDER as PDF and PNG.
    `norms`: what --norm accepts.
    Without a default norm there is no --norm: the figures show series and snapshots, of singular runs as well, and
    `draw(table, folder)` gets the folder of the table, where snapshots are.
    `beside_table`: FOLDER may be omitted, and is then that of the table.
    Bad input gives one line on standard error and exit 1.
    """
    parser = parser_of(description)
    parser.add_argument("table", help="table.json" if beside_table else f"results/PRESET/{experiment}.json")
    if beside_table:
        parser.add_argument("folder", nargs="?", help="where figures go (default: the folder of the table)")
    else:
        parser.add_argument("folder", help="where figures go, e.g. figures")
    if default_norm:
        parser.add_argument("--norm", choices=norms, default=default_norm, metavar="NORM",
                            help=f"{', '.join(norms)} (default: {default_norm})")
    arguments = parser.parse_args()
    try:
        table = read_table(arguments.table, experiment, succeeded if default_norm else has_series)
        figures = draw(table, arguments.norm if default_norm else os.path.dirname(arguments.table))
        folder = arguments.folder or os.path.dirname(arguments.table) or "."
        for name, figure in figures:
            style.save(figure, f"{folder}/{name}")
    except TableError as error:
        sys.exit(f"{parser.prog}: {arguments.table}: {error}")
    except OSError as error:
        sys.exit(f"{parser.prog}: {error.filename}: {error.strerror}")
