#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh for `evolve` from what meshio reads: VTU, legacy VTK, XDMF, Abaqus, Nastran, Medit, and others.

  /usr/bin/python3 plots/convert_mesh.py scan.vtk scan.msh
  build/bin/evolve CONFIG.json          with "mesh": {"file": "scan.msh"}

Triangles of degree 1 to 4 are kept with their curved nodes, and what else evolve reads: 4-node quadrangles, and the
linear volume elements and 10-node tetrahedra whose boundary it takes. Other cells are skipped, and a remark says so.
Point data (scalars and vectors) become nodal values of the same name, from which a flow that has them starts.
"""
import argparse
import os
import sys
from collections import Counter

import meshio
import numpy as np

KEPT = {"triangle", "triangle6", "triangle10", "triangle15", "quad", "tetra", "tetra10", "hexahedron", "wedge",
        "pyramid"}
# VTK's Lagrange triangles have the nodes of Gmsh's, in the same order up to degree 4.
LAGRANGE = {3: "triangle", 6: "triangle6", 10: "triangle10", 15: "triangle15"}


EXPECTED = "a mesh expected; what evolve reads itself, ParaView saves as PLY and STL, Gmsh as MSH"


class ConversionError(Exception):
    """What was found, and what was expected, in one line."""


def kind_of(block):
    """The name of a block's cells."""
    if block.type == "VTK_LAGRANGE_TRIANGLE":
        return LAGRANGE.get(block.data.shape[1], block.type)
    return block.type


def kept_cells(mesh, remarks):
    """[(kind, nodes)] of the cells that evolve reads."""
    kept, skipped = [], Counter()
    for block in mesh.cells:
        kind = kind_of(block)
        if kind in KEPT:
            kept.append((kind, np.asarray(block.data)))
        else:
            skipped[kind] += len(block.data)
    remarks += [f"{count} cells of type {kind} skipped" for kind, count in skipped.items()]
    return kept


def kept_point_data(mesh, remarks):
    """Scalars and vectors with three components as numbers of double precision."""
    kept = {}
    for name, values in mesh.point_data.items():
        values = np.asarray(values)
        columns = values.shape[1:] or (1,)
        if name.startswith("gmsh:"):  # entities, which meshio makes of a Gmsh file
            continue
        if columns in ((1,), (3,)) and values.dtype.kind in "fiu":
            kept[name] = values.astype(float).reshape(len(values), *(columns if columns == (3,) else ()))
        else:
            remarks.append(f"point data {name} skipped: {'x'.join(map(str, columns))} values of type {values.dtype} a "
                           "point, 1 or 3 numbers expected")
    return kept


def converted(mesh, remarks):
    """The mesh that evolve reads; what is skipped goes to the remarks."""
    points = np.asarray(mesh.points, float)
    if points.ndim != 2 or points.shape[1] != 3:
        raise ConversionError(f"points with {points.shape[-1]} coordinates, 3 expected")
    cells = kept_cells(mesh, remarks)
    one_part = [np.ones(len(nodes), np.int32) for _, nodes in cells]
    return meshio.Mesh(points, cells, point_data=kept_point_data(mesh, remarks),
                       cell_data={"gmsh:physical": one_part, "gmsh:geometrical": one_part})


def read(path):
    try:
        return meshio.read(path)
    except SystemExit as error:  # meshio has said why
        raise ConversionError(f"meshio cannot read it, {EXPECTED}") from error
    except Exception as error:  # whatever its parsers raise
        if not os.path.exists(path):
            raise ConversionError("no such file, a mesh expected") from error
        why = " ".join(str(error).split()) or type(error).__name__
        raise ConversionError(f"meshio cannot read it ({why}), {EXPECTED}") from error


def write(path, mesh):
    """Whole or not at all. MSH 2.2: in 4.1 meshio writes one block of cells only."""
    new = path + ".new"
    try:
        meshio.gmsh.write(new, mesh, fmt_version="2.2", binary=True)
        os.replace(new, path)
    finally:
        if os.path.exists(new):
            os.remove(new)


def main():
    parser = argparse.ArgumentParser(prog="convert_mesh.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", metavar="IN", help="a file that meshio reads")
    parser.add_argument("output", metavar="OUT.msh", help="the mesh for evolve, binary MSH 2.2")
    parser.error = lambda message: sys.exit(f"{parser.prog}: {message} (--help lists what is accepted)")
    arguments = parser.parse_args()
    if not arguments.output.endswith(".msh"):
        parser.error(f"found {arguments.output} as output, a name with the ending .msh expected")
    try:
        remarks = []
        mesh = converted(read(arguments.mesh), remarks)
        for remark in remarks:
            print(f"{parser.prog}: {arguments.mesh}: {remark}", file=sys.stderr)
        if not mesh.cells:
            raise ConversionError("no cell that evolve reads, triangles of degree 1 to 4 expected")
        write(arguments.output, mesh)
    except ConversionError as error:
        sys.exit(f"{parser.prog}: {arguments.mesh}: {error}")
    except OSError as error:
        sys.exit(f"{parser.prog}: {error.filename}: {error.strerror}")


if __name__ == "__main__":
    main()
