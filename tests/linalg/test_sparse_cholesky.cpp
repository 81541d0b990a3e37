// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iterator>
#include <limits>
#include <string>

#include "solver/assembly/surface_space.hpp"
#include "solver/error.hpp"
#include "solver/linalg/sparse_cholesky.hpp"
#include "tests/assembly/meshes.hpp"

namespace esfem::test_sparse_cholesky {
namespace {

using testing::HasSubstr;

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

std::string complaint(SparseCholesky& cholesky, double a, const SymmetricMatrix& M, double b,
                      const SymmetricMatrix& A) {
  try {
    cholesky.factorise(a, M, b, A);
  } catch (const NumericsError& error) {
    return error.what();
  }
  return "";
}

TEST(SparseCholesky, SolvesDifferentSystemsOneAfterTheOther) {
  const Matrices of(4);
  ASSERT_GT(of.space.dofs(), 5000);
  SparseCholesky cholesky(of.space.pattern());
  const Field rhs = (5 * of.mesh.nodes).array().sin();
  for (const auto& [a, b] : {std::pair{1.0, 1.0}, std::pair{100.0, 1.0}, std::pair{1.0, 1e-3}}) {
    cholesky.factorise(a, of.M, b, of.A);
    Field y = rhs;
    cholesky.solve(y);
    EXPECT_LT(relative_residual(of, a, b, y, rhs), 1e-12);
    EXPECT_GT(relative_residual(of, a, 1.001 * b, y, rhs), 1e-9) << "the residual sees another matrix";
  }
}

TEST(SparseCholesky, AnyNumberOfRightHandSidesAtOnce) {
  const Matrices of(2);
  SparseCholesky cholesky(of.space.pattern());
  cholesky.factorise(1, of.M, 1, of.A);
  for (const int count : {4, 1, 7, 3}) {
    const Field rhs = Field::Random(of.space.dofs(), count);
    Field together = rhs;
    cholesky.solve(together);
    for (int c = 0; c < count; ++c) {
      Field alone = rhs.col(c);
      cholesky.solve(alone);
      EXPECT_LT((alone - together.col(c)).norm(), 1e-12 * alone.norm());
    }
  }
}

TEST(SparseCholesky, ErrorsSayWhyAndTheObjectStaysUsable) {
  const Matrices of(2);
  SparseCholesky cholesky(of.space.pattern());
  EXPECT_THAT(complaint(cholesky, -1, of.M, 1, of.A), HasSubstr("not positive definite at column"));
  EXPECT_THAT(complaint(cholesky, 1, of.M, -1, of.A), HasSubstr("not positive definite at column"));
  SymmetricMatrix broken = of.A;
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    broken.values[77] = value;
    EXPECT_THAT(complaint(cholesky, 1, of.M, 1, broken), HasSubstr("not finite"));
  }
  EXPECT_EQ(complaint(cholesky, 1, of.M, 1, of.A), "");
  const Field rhs = of.mesh.nodes;
  Field y = rhs;
  cholesky.solve(y);
  EXPECT_LT(relative_residual(of, 1, 1, y, rhs), 1e-12);
}

TEST(SparseCholesky, TheColumnThatFailsIsNamedInTheCallersNumbering) {
  const Matrices of(1);
  SparseCholesky cholesky(of.space.pattern());
  SymmetricMatrix diagonal = of.space.matrix();
  const SparsityPattern& pattern = *diagonal.pattern;
  for (int j = 0; j < pattern.size; ++j) diagonal.values[pattern.entry(j, j)] = j == 41 ? -1 : 1;
  EXPECT_THAT(complaint(cholesky, 1, diagonal, 0, of.A), HasSubstr("at column 41 of"));
}

TEST(SparseCholesky, SolvingNeedsAFactorisationAndTheRightSize) {
  const Matrices of(1);
  SparseCholesky cholesky(of.space.pattern());
  Field y = of.mesh.nodes;
  EXPECT_THROW(cholesky.solve(y), NumericsError);
  EXPECT_NE(complaint(cholesky, -1, of.M, 1, of.A), "");
  EXPECT_THROW(cholesky.solve(y), NumericsError) << "after a failed factorisation";
  cholesky.factorise(1, of.M, 1, of.A);
  y = Field::Ones(of.space.dofs() - 1, 1);
  EXPECT_THROW(cholesky.solve(y), InputError);
}

/// Threads of this process. OpenMP keeps those that it has started.
long thread_count() {
  const auto tasks = std::filesystem::directory_iterator("/proc/self/task");
  return std::distance(begin(tasks), end(tasks));
}

void factorise_and_solve() {
  const Matrices of(4);
  SparseCholesky cholesky(of.space.pattern());
  cholesky.factorise(1, of.M, 1, of.A);
  Field y = of.mesh.nodes;
  cholesky.solve(y);
}

TEST(SparseCholesky, StartsThreadsOnlyWhenAsked) {
  unsetenv("OMP_NUM_THREADS");
  const long before = thread_count();
  factorise_and_solve();
  EXPECT_EQ(thread_count(), before);
  setenv("OMP_NUM_THREADS", "2", 1);
  factorise_and_solve();
  unsetenv("OMP_NUM_THREADS");
  EXPECT_GT(thread_count(), before);
}

}  // namespace
}  // namespace esfem::test_sparse_cholesky
