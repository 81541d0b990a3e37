// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "solver/error.hpp"
#include "solver/flows/lagged_block_solver.hpp"
#include "tests/assembly/meshes.hpp"

namespace esfem::test_lagged_block_solver {
namespace {

double difference(const Field& found, const Field& expected) {
  return (found - expected).norm() / expected.norm();
}

// Two right-hand sides per step on a surface that grows, as from two equations with one matrix: each has a
// guess of its own, and the factors serve both.
TEST(LaggedBlockSolver, ServesTwoRightHandSidesWithAGuessEach) {
  const Mesh mesh = ellipsoid_mesh({2, 1, 0.7}, 2, 3);
  const SurfaceSpace space(mesh);
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  LaggedBlockSolver solver(space);
  BlockSolver direct(space.pattern());
  LaggedBlockSolver::Guess guesses[2];
  constexpr int steps = 12;
  for (int n = 0; n < steps; ++n) {
    const Field x = (1 + 1e-5 * n) * mesh.nodes;
    space.assemble(x, M, A);
    direct.factorise(1500, 1, 1, M, A);
    for (const int which : {0, 1}) {
      const Field r = which == 0 ? Field(x.array().sin()) : Field(x.col(0).array().cos()),
                  s = which == 0 ? Field(x.array().cos()) : Field(x.col(1).array().sin());
      Field u = r, w = s, u_direct = r, w_direct = s;
      direct.solve(u_direct, w_direct);
      LaggedBlockSolver::Guess& guess = guesses[which];
      if (n == 0) guess.u.setZero(r.rows(), r.cols()), guess.w = guess.u;
      solver.solve(1500, x, M, A, guess, u, w);
      EXPECT_LT(difference(u, u_direct), 1e-12) << n << " " << which;
      EXPECT_LT(difference(w, w_direct), 1e-12) << n << " " << which;
      guess.u = u;
      guess.w = w;
    }
  }
  EXPECT_LE(solver.factorisations(), steps / 2);
  EXPECT_EQ(guesses[0].u.cols(), 3);
  EXPECT_EQ(guesses[1].u.cols(), 1);
}

TEST(LaggedBlockSolver, SaysThatASavedGuessIsOfAnotherSurface) {
  LaggedBlockSolver::Guess guess;
  guess.u_change = guess.w_change = Field::Zero(10, 4);
  LaggedBlockSolver::Guess other;
  EXPECT_NO_THROW(resume(other, progress(guess), 10));
  EXPECT_EQ(other.u_change, guess.u_change);
  EXPECT_THROW(resume(other, progress(guess), 11), InputError);
}

}  // namespace
}  // namespace esfem::test_lagged_block_solver
