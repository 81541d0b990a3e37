#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The step of kll19 (5.1) that `bench_step --write-step FILE.json` has written, done again by DOLFINx and PETSc.

    build/bin/bench_step --write-step build/step.json
    python3 bench/peer_dolfinx.py build/step.json       (Debian: python3-dolfinx)

The same mesh, quadrature rule and data; M, A and loads are assembled, two matrices are factorised, 3 and 4 right-hand
sides are solved for, by PETSc's Cholesky factorisation with CHOLMOD and with MUMPS. Both solutions must agree to 1e-10;
then the ratio of the times is printed, each the least of some rounds on one core.
"""
import json
import logging
import os
import sys
import time

for variable in ("OMP_NUM_THREADS", "OMP_THREAD_LIMIT", "OPENBLAS_NUM_THREADS"):
    os.environ[variable] = "1"

try:
    import numpy as np
    import ufl
    from dolfinx import fem, mesh as dolfinx_mesh
    from dolfinx.fem import petsc
    from mpi4py import MPI
    from petsc4py import PETSc
except ImportError as error:
    print(f"DOLFINx is not installed ({error}); on Debian: apt-get install python3-dolfinx")
    sys.exit()

logging.disable(logging.WARNING)  # UFL would warn of a quadrature rule given as arrays

TOLERANCE = 1e-10
ROUNDS = 5
# Gmsh's order of the nodes of a quadratic triangle is 0, 1, 2, 01, 12, 20; DOLFINx numbers edges by the opposite corner.
DOLFINX_ORDER = [0, 1, 2, 4, 5, 3]


class Step:
    def __init__(self, data):
        self.mass_factor = data["mass_factor"]
        nodes = np.array(data["nodes"])
        cells = np.array(data["elements"], dtype=np.int64)[:, DOLFINX_ORDER]
        domain = ufl.Mesh(ufl.VectorElement("Lagrange", ufl.Cell("triangle", geometric_dimension=3), 2))
        self.mesh = dolfinx_mesh.create_mesh(MPI.COMM_WORLD, cells, nodes, domain)
        self.space = fem.FunctionSpace(self.mesh, ("Lagrange", 2))

        # Node of our numbering for each degree of freedom.
        geometry = self.mesh.geometry
        self.node = np.empty(len(nodes), dtype=np.int64)
        for cell in range(len(cells)):
            self.node[self.space.dofmap.cell_dofs(cell)] = np.array(geometry.input_global_indices)[
                geometry.dofmap.links(cell)]

        weights = np.array(data["quadrature_weights"]).ravel()
        rule = {"quadrature_rule": "custom", "quadrature_points": np.array(data["quadrature_points"]),
                "quadrature_weights": 0.5 * weights / weights.sum()}
        self.set_forms(ufl.Measure("dx", domain=self.mesh, metadata=rule), np.array(data["u"])[self.node])

    def set_forms(self, dx, u_values):
        u = [fem.Function(self.space) for _ in range(4)]
        for function, values in zip(u, u_values.T):
            function.x.array[:] = values
        nu, H = u[:3], u[3]
        p, q = ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        grad_nu_squared = sum(ufl.inner(ufl.grad(n), ufl.grad(n)) for n in nu)
        mass, stiffness = p * q * dx, ufl.inner(ufl.grad(p), ufl.grad(q)) * dx
        self.matrices = [fem.form(mass + stiffness), fem.form(self.mass_factor * mass + stiffness)]
        self.loads = [[fem.form(-H * n * q * dx - ufl.inner(ufl.grad(H * n), ufl.grad(q)) * dx) for n in nu],
                      [fem.form(grad_nu_squared * f * q * dx + self.mass_factor * f * q * dx) for f in u]]

    def prepare(self, package):
        """Matrices and solvers, made once as a program with many steps would."""
        self.assembled = [petsc.create_matrix(form) for form in self.matrices]
        self.solvers = []
        for matrix in self.assembled:
            solver = PETSc.KSP().create(MPI.COMM_WORLD)
            matrix.setOption(PETSc.Mat.Option.SPD, True)
            solver.setOperators(matrix)
            solver.setType("preonly")
            solver.getPC().setType("cholesky")
            solver.getPC().setFactorSolverType(package)
            self.solvers.append(solver)

    def run(self):
        solutions = []
        for matrix, form, solver, loads in zip(self.assembled, self.matrices, self.solvers, self.loads):
            matrix.zeroEntries()
            petsc.assemble_matrix(matrix, form)
            matrix.assemble()
            for load in loads:
                right = petsc.assemble_vector(load)
                solution = right.duplicate()
                solver.solve(right, solution)
                solutions.append(solution.array.copy())
        values = np.empty((len(self.node), 7))
        values[self.node] = np.array(solutions).T
        return values


def main():
    with open(sys.argv[1]) as file:
        data = json.load(file)
    expected = np.hstack([np.array(data["v"]), np.array(data["u_new"])])
    step = Step(data)
    print(f"{len(expected)} nodes, esfem: {data['ms']:.1f} ms")
    for package in ("cholmod", "mumps"):
        try:
            step.prepare(package)
            found = step.run()
        except PETSc.Error as error:
            print(f"PETSc with {package}: not available ({str(error).splitlines()[0]})")
            continue
        difference = np.linalg.norm(found - expected) / np.linalg.norm(expected)
        if not difference <= TOLERANCE:
            sys.exit(f"PETSc with {package} gives another solution: difference {difference:.1e}, "
                     f"expected at most {TOLERANCE:g}")
        least = float("inf")
        for _ in range(ROUNDS):
            begin = time.perf_counter()
            step.run()
            least = min(least, 1e3 * (time.perf_counter() - begin))
        print(f"DOLFINx, PETSc with {package}: {least:.1f} ms, {least / data['ms']:.1f} times as long; "
              f"difference {difference:.1e}")


if __name__ == "__main__":
    main()
