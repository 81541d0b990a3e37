// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <limits>
#include <utility>
#include <vector>

#include "solver/assembly/surface_space.hpp"
#include "solver/error.hpp"
#include "solver/linalg/block_solver.hpp"
#include "solver/linalg/metis_ordering.hpp"
#include "tests/assembly/meshes.hpp"

namespace esfem::test_block_solver {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// M and A of a P2 ellipsoid, with right-hand sides.
struct Blocks {
  Mesh mesh;
  SurfaceSpace space;
  SymmetricMatrix M, A;
  Field r, s;
  explicit Blocks(int subdivisions)
      : mesh(ellipsoid_mesh({2, 1, 0.7}, 2, subdivisions)),
        space(mesh),
        M(space.matrix()),
        A(space.matrix()),
        r(space.dofs(), 4),
        s(space.dofs(), 4) {
    space.assemble(mesh.nodes, M, A);
    const auto x = mesh.nodes.array();
    r << x.sin(), x.col(0).cos();
    s << (2 * x).cos(), x.col(1).sin();
  }

  /// The larger of the two lines' residuals, relative to their right-hand sides.
  double residual(double alpha, double beta, double gamma, const Field& u, const Field& w) const {
    const double first = (alpha * (M * u) - beta * (A * w) - r).norm() / r.norm();
    const double second = (gamma * (A * u) + M * w - s).norm() / s.norm();
    return std::max(first, second);
  }
};

TEST(BlockSolver, SolvesBothLinesForAllFactors) {
  const Blocks of(3);
  BlockSolver solver(of.space.pattern());
  for (const auto& [alpha, beta, gamma] :
       {std::array{1.0, 1.0, 1.0}, std::array{1.5 / 1e-4, 1.0, 1.0}, std::array{11.0 / 6, 1e-3, 0.1}}) {
    solver.factorise(alpha, beta, gamma, of.M, of.A);
    Field u = of.r, w = of.s;
    solver.solve(u, w);
    EXPECT_LT(of.residual(alpha, beta, gamma, u, w), 1e-11);
    EXPECT_GT(of.residual(alpha, 1.001 * beta, gamma, u, w), 1e-8) << "the residual sees another system";
  }
}

/// [alpha/beta M  -A; -A  -M/gamma] is symmetric quasi-definite: L D L^T exists for every ordering
/// (Vanderbei, SIAM J. Optim. 5, 1995), here on the 2N x 2N matrix of real numbers.
std::pair<Field, Field> solve_quasi_definite(const Blocks& of, double alpha, double beta, double gamma) {
  const int n = of.space.dofs();
  const SparsityPattern& pattern = *of.space.pattern();
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < n; ++j) {
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
      const int i = pattern.row[k];
      entries.emplace_back(i, j, alpha / beta * of.M.values[k]);
      entries.emplace_back(n + i, n + j, -of.M.values[k] / gamma);
      entries.emplace_back(n + i, j, -of.A.values[k]);
      if (i != j) entries.emplace_back(n + j, i, -of.A.values[k]);
    }
  }
  Eigen::SparseMatrix<double> matrix(2 * n, 2 * n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Field right(2 * n, of.r.cols());
  right << of.r / beta, -of.s / gamma;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
  const Field solution = factors.solve(right);
  return {solution.topRows(n), solution.bottomRows(n)};
}

TEST(BlockSolver, AgreesWithTheRealQuasiDefiniteForm) {
  const Blocks of(2);
  BlockSolver solver(of.space.pattern());
  for (const auto& [alpha, beta, gamma] : {std::array{1500.0, 1.0, 1.0}, std::array{1.5, 0.02, 0.5}}) {
    solver.factorise(alpha, beta, gamma, of.M, of.A);
    Field u = of.r, w = of.s;
    solver.solve(u, w);
    const auto [u_real, w_real] = solve_quasi_definite(of, alpha, beta, gamma);
    EXPECT_LT((u - u_real).norm(), 1e-9 * u.norm());
    EXPECT_LT((w - w_real).norm(), 1e-9 * w.norm());
  }
}

TEST(BlockSolver, AnyNumberOfRightHandSidesAtOnce) {
  const Blocks of(2);
  BlockSolver solver(of.space.pattern());
  solver.factorise(30, 1, 1, of.M, of.A);
  Field u = of.r, w = of.s;
  solver.solve(u, w);
  for (int c = 0; c < 4; ++c) {
    Field u_alone = of.r.col(c), w_alone = of.s.col(c);
    solver.solve(u_alone, w_alone);
    EXPECT_LT((u.col(c) - u_alone).norm(), 1e-12 * u.norm());
    EXPECT_LT((w.col(c) - w_alone).norm(), 1e-12 * w.norm());
  }
}

TEST(BlockSolver, TheSameNumbersGiveTheSameBits) {
  const Blocks of(2);
  Field u[2], w[2];
  for (int i = 0; i < 2; ++i) {
    BlockSolver solver(of.space.pattern());
    solver.factorise(30, 1, 1, of.M, of.A);
    u[i] = of.r, w[i] = of.s;
    solver.solve(u[i], w[i]);
  }
  EXPECT_EQ(u[0], u[1]);
  EXPECT_EQ(w[0], w[1]);
}

/// M and A after the surface has moved.
std::pair<SymmetricMatrix, SymmetricMatrix> moved(const Blocks& of, double distance) {
  std::pair<SymmetricMatrix, SymmetricMatrix> matrices = {of.space.matrix(), of.space.matrix()};
  const Field x = of.mesh.nodes + distance * of.mesh.nodes.array().sin().matrix();
  of.space.assemble(x, matrices.first, matrices.second);
  return matrices;
}

double difference(const Field& found, const Field& expected) {
  return (found - expected).norm() / expected.norm();
}

TEST(BlockSolver, RefinementAttainsTheDirectSolutionWithTheFactorsOfAnotherSystem) {
  const Blocks of(3);
  BlockSolver direct(of.space.pattern()), solver(of.space.pattern());
  const auto [M, A] = moved(of, 1e-3);
  for (const auto& [alpha, beta, gamma] : {std::array{1500.0, 1.0, 1.0}, std::array{1.5, 0.02, 0.5}}) {
    solver.factorise(1.01 * alpha, beta, gamma, of.M, of.A);
    direct.factorise(alpha, beta, gamma, M, A);
    Field u_direct = of.r, w_direct = of.s;
    direct.solve(u_direct, w_direct);
    Field u = 0.99 * u_direct, w = 0.99 * w_direct;
    EXPECT_FALSE(solver.refine(alpha, beta, gamma, M, A, of.r, of.s, 1, u, w));
    EXPECT_GT(difference(u, u_direct) + difference(w, w_direct), 1e-7);
    const std::optional<int> iterations = solver.refine(alpha, beta, gamma, M, A, of.r, of.s, 20, u, w);
    ASSERT_TRUE(iterations);
    EXPECT_GE(*iterations, 3);
    EXPECT_LT(difference(u, u_direct), 1e-12);
    EXPECT_LT(difference(w, w_direct), 1e-12);
    EXPECT_EQ(solver.refine(alpha, beta, gamma, M, A, of.r, of.s, 20, u, w), 1) << "it is there already";
  }
}

TEST(BlockSolver, RefinementWithTheSystemsOwnFactorsTakesOneIteration) {
  const Blocks of(3);
  BlockSolver solver(of.space.pattern());
  solver.factorise(1500, 1, 1, of.M, of.A);
  Field u = Field::Zero(of.r.rows(), 4), w = u, u_direct = of.r, w_direct = of.s;
  EXPECT_EQ(solver.refine(1500, 1, 1, of.M, of.A, of.r, of.s, 5, u, w), 1);
  solver.solve(u_direct, w_direct);
  EXPECT_LT(difference(u, u_direct), 1e-13);
  EXPECT_LT(difference(w, w_direct), 1e-13);
}

TEST(BlockSolver, RefinementTakesAnyNumberOfColumns) {
  const Blocks of(3);
  BlockSolver direct(of.space.pattern()), solver(of.space.pattern());
  const auto [M, A] = moved(of, 1e-3);
  solver.factorise(1500, 1, 1, of.M, of.A);
  direct.factorise(1500, 1, 1, M, A);
  for (const int columns : {1, 4, 6, 9}) {
    const Field r = of.r.col(0) * Eigen::RowVectorXd::LinSpaced(columns, 1, 2),
                s = of.s.replicate(1, 3).leftCols(columns);
    Field u = Field::Zero(r.rows(), columns), w = u, u_direct = r, w_direct = s;
    EXPECT_TRUE(solver.refine(1500, 1, 1, M, A, r, s, 20, u, w));
    direct.solve(u_direct, w_direct);
    for (int c = 0; c < columns; ++c) {
      EXPECT_LT(difference(u.col(c), u_direct.col(c)), 1e-12) << c << " of " << columns;
      EXPECT_LT(difference(w.col(c), w_direct.col(c)), 1e-12) << c << " of " << columns;
    }
    u.setZero(), w.setZero();
    u.col(columns - 1).setConstant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(solver.refine(1500, 1, 1, M, A, r, s, 20, u, w)) << "of every group";
  }
}

TEST(BlockSolver, RefinementGivesUpWhereTheFactorsAreTooOld) {
  const Blocks of(2);
  BlockSolver solver(of.space.pattern());
  solver.factorise(1500, 1, 1, of.M, of.A);
  Field u = Field::Zero(of.r.rows(), 4), w = u;
  const auto [M, A] = moved(of, 0.5);
  EXPECT_FALSE(solver.refine(1500, 1, 1, M, A, of.r, of.s, 20, u, w));
  Field bad = of.r;
  bad(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(solver.refine(1500, 1, 1, of.M, of.A, bad, of.s, 20, u, w));
}

TEST(MetisOrdering, IsTheSamePermutationEachTime) {
  const Blocks of(3);
  const std::vector<int> ordering = metis_ordering(*of.space.pattern());
  EXPECT_EQ(metis_ordering(*of.space.pattern()), ordering);
  std::vector<int> sorted = ordering;
  std::sort(sorted.begin(), sorted.end());
  for (int i = 0; i < of.space.dofs(); ++i) ASSERT_EQ(sorted[i], i);
}

TEST(BlockSolver, SaysWhatIsWrong) {
  const Blocks of(1), other(2);
  BlockSolver solver(of.space.pattern());
  Field u = of.r, w = of.s;
  EXPECT_THAT([&] { solver.solve(u, w); }, ThrowsMessage<NumericsError>(HasSubstr("call factorise()")));
  EXPECT_THAT([&] { solver.factorise(1, -1, 1, of.M, of.A); },
              ThrowsMessage<InputError>(HasSubstr("1, -1, 1")));
  EXPECT_THAT([&] { solver.factorise(1, 1, 1, other.M, other.A); },
              ThrowsMessage<InputError>(HasSubstr("pattern")));
  SymmetricMatrix bad = of.A;
  bad.values[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { solver.factorise(1, 1, 1, of.M, bad); },
              ThrowsMessage<NumericsError>(HasSubstr("not finite")));
  SymmetricMatrix zero = of.M;
  zero.values.setZero();
  EXPECT_THAT([&] { solver.factorise(1, 1, 1, zero, zero); },
              ThrowsMessage<NumericsError>(HasSubstr("singular")));
  solver.factorise(1, 1, 1, of.M, of.A);
  Field wrong = other.r;
  EXPECT_THAT([&] { solver.solve(wrong, w); }, ThrowsMessage<InputError>(HasSubstr("rows")));
  EXPECT_THAT([&] { solver.refine(1, 1, 1, of.M, of.A, of.r, of.s, 1, wrong, w); },
              ThrowsMessage<InputError>(HasSubstr("162 x 4 and 642 x 4")));
}

}  // namespace
}  // namespace esfem::test_block_solver
