#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How reference/meshes/animal.ply was made: an animal of ten soft ellipsoids, meshed by evolve, roughened like a scan.

Made anew it is the same, except that a few of its numbers are rounded to the other side in their last digit.

Usage: python3 reference/meshes/make_animal.py build/bin/evolve reference/meshes/animal.ply
"""
import json
import os
import subprocess
import sys
import tempfile

import numpy as np

# Centre and semi-axes of body, head, snout, ears, legs and tail.
PARTS = (((0, 0, 0), (0.95, 0.5, 0.45)), ((1.05, 0, 0.5), (0.4, 0.36, 0.36)), ((1.5, 0, 0.42), (0.22, 0.2, 0.18)),
         *(((0.95, y, 0.95), (0.1, 0.13, 0.22)) for y in (0.25, -0.25)),
         *(((x, y, -0.6), (0.2, 0.18, 0.42)) for x in (0.55, -0.6) for y in (0.3, -0.3)),
         ((-1.2, 0, 0.3), (0.3, 0.12, 0.14)))
ROUGHNESS = 0.08  # standard deviation of a node's place in each direction, relative to its shortest edge


def level_set():
    """1 - sum exp(1 - q) with q = 1 on each ellipsoid."""
    terms = (" - ".join(f"(({x}-({c}))/{a})^2" for x, c, a in zip("xyz", *part)) for part in PARTS)
    return "1" + "".join(f" - exp(1 - {term})" for term in terms)


def smooth_mesh(evolve):
    """Nodes (N, 3) and triangles (E, 3) of the level set; its edges are at most 0.125, and the radius of curvature."""
    with tempfile.TemporaryDirectory() as folder:
        end, configuration = os.path.join(folder, "end.json"), os.path.join(folder, "animal.json")
        with open(configuration, "w", encoding="utf-8") as file:
            json.dump({"flow": "dziuk", "degree": 1, "bdf": 1, "tau": 1, "steps": 0, "output": {"nodal": end},
                       "surface": {"level_set": level_set(), "box": [[-2.5, -1.2, -1.6], [2.5, 1.2, 1.8]]},
                       "mesh": {"edge_length": 0.125, "grading": 1}}, file)
        subprocess.run([evolve, configuration], check=True)
        with open(end, encoding="utf-8") as file:
            nodal = json.load(file)
    return np.array(nodal["x"]), np.array(nodal["elements"])


def roughened(x, triangles):
    shortest = np.full(len(x), np.inf)
    for i, j in ((0, 1), (1, 2), (2, 0)):
        lengths = np.linalg.norm(x[triangles[:, i]] - x[triangles[:, j]], axis=1)
        for k in (i, j):
            np.minimum.at(shortest, triangles[:, k], lengths)
    return x + ROUGHNESS * shortest[:, None] * np.random.default_rng(1).normal(size=x.shape)


def write_ply(path, x, triangles):
    with open(path, "w", encoding="ascii") as file:
        file.write(f"ply\nformat ascii 1.0\nelement vertex {len(x)}\nproperty double x\nproperty double y\n"
                   f"property double z\nelement face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
        np.savetxt(file, x, "%.4f")
        np.savetxt(file, np.column_stack([np.full(len(triangles), 3), triangles]), "%d")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    nodes, elements = smooth_mesh(sys.argv[1])
    write_ply(sys.argv[2], roughened(nodes, elements), elements)
