# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodal and lifted errors of elements of degree 2 to 4, computed anew from nodal values.

Usage: python3 tests/analysis/test_norms.py, after a build. `evolve` writes the nodes and nodal values at the end of a run
on a sphere, `mcf_sphere` the errors of the same run. Here these errors, and the area, follow from the nodal values by
another basis (Vandermonde's matrix of monomials), another quadrature rule (Gauss and Gauss-Jacobi) and the closest point
of the sphere as a formula. No code is shared: M, A, the lift and the norms are seen to be right for each degree.
"""
import itertools
import json
import math
import os
import subprocess
import tempfile
import unittest

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.path.join(ROOT, os.environ.get("BUILD", "build"), "bin")
RADIUS, TAU, STEPS = 2.0, 0.05, 12
RULE = "conical:12"  # both rules integrate to round-off
FIELDS = {"x": 3, "v": 3, "nu": 3, "H": 1}  # components


def lattice(k):
    """Nodes of degree k: corners, edges 01, 12, 20, then inner ones, as those of a triangle of degree k - 3."""
    if k == 0:
        return [(1 / 3, 1 / 3)]
    corners = np.array([(0, 0), (1, 0), (0, 1)], float)
    points = list(corners)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        points += [corners[a] + i / k * (corners[b] - corners[a]) for i in range(1, k)]
    if k >= 3:
        points += [(1 / k, 1 / k) + (k - 3) / k * np.array(p) if k > 3 else p for p in lattice(k - 3)]
    return [tuple(p) for p in points]


def monomials(k, points):
    """All xi^i eta^j with i + j <= k at the points, and both derivatives: points x monomials each."""
    xi, eta = np.asarray(points).T[:, :, None]
    i, j = np.array([(i, j) for i, j in itertools.product(range(k + 1), repeat=2) if i + j <= k]).T[:, None, :]
    power = lambda base, n: np.where(n >= 0, base ** np.maximum(n, 0), 0)
    return (power(xi, i) * power(eta, j), i * power(xi, i - 1) * power(eta, j), j * power(xi, i) * power(eta, j - 1))


def gauss(n, alpha):
    """Points and weights on (0, 1) for the weight (1 - t)^alpha, alpha = 0, 1: Golub and Welsch."""
    m = np.arange(n)
    diagonal = -alpha / ((2 * m + 1.0) * (2 * m + 3)) if alpha else np.zeros(n)
    m = np.arange(1, n)
    off = m * (m + 1) / (2 * m + 1.0) ** 2 if alpha else m**2 / (4.0 * m**2 - 1)
    values, vectors = np.linalg.eigh(np.diag(diagonal) + np.diag(np.sqrt(off), 1) + np.diag(np.sqrt(off), -1))
    return (values + 1) / 2, vectors[0] ** 2 / (1 + alpha)


def triangle_rule(n):
    (s, ws), (t, wt) = gauss(n, 0), gauss(n, 1)
    points = np.array([(a * (1 - b), b) for a in s for b in t])
    return points, np.outer(ws, wt).ravel()


class Elements:
    """Functions with nodal values on curved triangles."""

    def __init__(self, degree, elements, order=None, n=12):
        self.elements = np.asarray(elements)
        nodes = lattice(degree) if order is None else [lattice(degree)[i] for i in order]
        points, self.weights = triangle_rule(n)
        inverse = np.linalg.inv(monomials(degree, nodes)[0])
        self.value, self.dxi, self.deta = (rows @ inverse for rows in monomials(degree, points))

    def at(self, nodal):
        """Value (elements x points x components) and derivatives (.. x 2) of a function."""
        local = np.asarray(nodal).reshape(len(nodal), -1)[self.elements]
        value, *derivatives = (np.einsum("qa,eac->eqc", rows, local) for rows in (self.value, self.dxi, self.deta))
        return value, np.stack(derivatives, -1)

    def squares(self, tangents, value, derivative, exact=None, gradient=None):
        """L2 norm and H1 seminorm, squared, of value - exact on the surface with these tangents (.. x 3 x 2)."""
        metric = np.einsum("eqik,eqil->eqkl", tangents, tangents)
        dA = self.weights * np.sqrt(np.linalg.det(metric))
        slope = np.einsum("eqik,eqkl,eqcl->eqci", tangents, np.linalg.inv(metric), derivative)
        difference = value if exact is None else value - exact
        slope = slope if gradient is None else slope - gradient
        return np.einsum("eq,eqc->", dA, difference**2), np.einsum("eq,eqci->", dA, slope**2)


def exact_on_sphere(radius):
    """Each field as a factor: x, v, nu are multiples of the position y, H is constant."""
    return {"x": 1, "v": -2 / radius**2, "nu": 1 / radius, "H": 2 / radius}


def errors(on, nodal, radius):
    """{field: {norm: error}} of a run at the time when the sphere has this radius."""
    start = nodal["start"] / np.linalg.norm(nodal["start"], axis=1)[:, None]
    nodes, found = radius * start, {}
    x, dx = on.at(nodes)
    r = np.linalg.norm(x, axis=2)
    normal = x / r[..., None]
    projection = np.eye(3) - np.einsum("eqi,eqj->eqij", normal, normal)
    y = radius * normal
    dy = radius / r[..., None, None] * np.einsum("eqij,eqjk->eqik", projection, dx)
    for field, factor in exact_on_sphere(radius).items():
        scalar = FIELDS[field] == 1
        at_nodes = np.full(len(nodes), factor) if scalar else factor * nodes
        nodal_norms = on.squares(dx, *on.at(np.asarray(nodal[field]) - at_nodes))
        exact, gradient = (factor, None) if scalar else (factor * y, factor * projection)
        lifted = on.squares(dy, *on.at(nodal[field]), exact, gradient)
        found[field] = {f"{kind}_{norm}": np.sqrt(square) for kind, squares in (("nodal", nodal_norms), ("lifted", lifted))
                        for norm, square in zip(("L2", "H1_semi"), squares)}
    return found


def run(program, *arguments):
    done = subprocess.run([os.path.join(BIN, program), *arguments], capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{program} {' '.join(arguments)}: {done.stderr}")


def load(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def evolve(folder, name, steps, degree, mesh):
    """Nodal values at the end of a run, and its series; also NAME.pvd with the start."""
    path = lambda suffix: os.path.join(folder, name + suffix)
    output = {"nodal": path(".json"), "series": path("_series.json"), "vtu": path(".pvd")}
    config = {"flow": "mean_curvature", "surface": {"name": "sphere", "radius": RADIUS}, "mesh": mesh, "degree": degree,
              "bdf": 3, "tau": TAU, "steps": steps, "start": "exact", "quadrature": {"conical": 12}, "output": output}
    with open(path("_config.json"), "w", encoding="utf-8") as file:
        json.dump(config, file)
    run("evolve", path("_config.json"))
    return load(output["nodal"]), load(output["series"])


class Norms(unittest.TestCase):
    def runs(self, degree):
        """Nodal values with those at the start, the series of evolve, and the errors of mcf_sphere at the end."""
        with tempfile.TemporaryDirectory() as folder:
            start, _ = evolve(folder, "start", 0, degree, {"edge_length": 1.5})
            mesh = os.path.join(folder, "start_0000.vtu")
            nodal, series = evolve(folder, "end", STEPS, degree, {"file": mesh})
            table = os.path.join(folder, "table.json")
            run("mcf_sphere", "--flow", "mean_curvature", "--mesh", mesh, "--degree", str(degree), "--steps", "2",
                "--quadrature", RULE, "--output", table)
            row, = load(table)["rows"]
        self.assertEqual([row["tau"], row["steps"]], [TAU, STEPS])
        self.assertEqual(start["elements"], nodal["elements"])
        last = {name: values[-1] for name, values in row["series"].items()}
        return {**nodal, "start": np.array(start["x"])}, series, last

    def largest_difference(self, degree, nodal, last, order=None):
        """The largest relative difference of all errors to those of mcf_sphere."""
        radius = np.sqrt(RADIUS**2 - 4 * nodal["t"])
        found = errors(Elements(degree, nodal["elements"], order), nodal, radius)
        return max(abs(error / last[f"{field}_{norm}"] - 1) for field, norms in found.items() for norm, error in norms.items())

    def test_errors_and_area(self):
        for degree in (2, 3, 4):
            with self.subTest(degree=degree):
                nodal, series, last = self.runs(degree)
                self.assertLess(self.largest_difference(degree, nodal, last), 1e-8)
                on = Elements(degree, nodal["elements"])
                _, tangents = on.at(nodal["x"])
                one = np.ones_like(on.at(nodal["H"])[0])
                area, _ = on.squares(tangents, one, np.zeros((*one.shape, 2)))
                self.assertLess(abs(area / series["area"][-1] - 1), 1e-12)
                energy = on.squares(tangents, *on.at(nodal["H"]))[0] / 2
                self.assertLess(abs(energy / series["willmore_energy"][-1] - 1), 1e-12)
                # Another order of the nodes on an edge, or inside, is another function.
                order = list(range((degree + 1) * (degree + 2) // 2))
                for a, b in {2: [(3, 4)], 3: [(3, 4)], 4: [(3, 5), (12, 13)]}[degree]:
                    order[a], order[b] = b, a
                    self.assertGreater(self.largest_difference(degree, nodal, last, order), 1e-2)
                    order[a], order[b] = a, b

    def test_the_rules_are_exact(self):
        points, weights = triangle_rule(6)
        xi, eta = points.T
        for i, j in itertools.product(range(6), repeat=2):
            exact = math.factorial(i) * math.factorial(j) / math.factorial(i + j + 2)
            self.assertAlmostEqual(weights @ (xi**i * eta**j), exact, delta=1e-15)


if __name__ == "__main__":
    unittest.main()
