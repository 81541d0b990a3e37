// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "solver/assembly/surface_space.hpp"
#include "solver/error.hpp"
#include "solver/linalg/sparse_cholesky.hpp"
#include "tests/assembly/meshes.hpp"

namespace esfem {
namespace {

/// M and A of a P2 sphere.
struct Matrices {
  Mesh mesh;
  SurfaceSpace space;
  SymmetricMatrix M, A;
  explicit Matrices(int subdivisions)
      : mesh(sphere_mesh(2, 2, subdivisions)), space(mesh), M(space.matrix()), A(space.matrix()) {
    space.assemble(mesh.nodes, M, A);
  }
};

double relative_residual(const Matrices& of, double a, double b, const Field& y, const Field& rhs) {
  return (a * (of.M * y) + b * (of.A * y) - rhs).norm() / rhs.norm();
}

TEST(SparseCholesky, SolvesTwoSystemsOneAfterTheOther) {
  const Matrices of(4);
  ASSERT_GT(of.space.dofs(), 5000);
  SparseCholesky cholesky(of.space.pattern());
  const Field rhs = (5 * of.mesh.nodes).array().sin();
  for (const auto& [a, b] : {std::pair{1.0, 1.0}, std::pair{100.0, 1.0}, std::pair{1.0, 1e-3}}) {
    cholesky.factorise(a, of.M, b, of.A);
    Field y = rhs;
    cholesky.solve(y);
    EXPECT_LT(relative_residual(of, a, b, y, rhs), 1e-12);
    Field first = rhs.col(0);
    cholesky.solve(first);
    EXPECT_LT((first - y.col(0)).norm(), 1e-12 * y.norm());
  }
}

}  // namespace
}  // namespace esfem
