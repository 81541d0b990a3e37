// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/lagged_block_solver.hpp"

#include <cmath>

#include "solver/error.hpp"
#include "solver/time/checkpoint.hpp"

namespace esfem {
namespace {

/// Iterations that take as long as a factorisation: 1.7 on P2 meshes with 10,000 nodes, 2.4 with 41,000.
constexpr int factorisation_cost = 2;

/// Relative change of alpha beyond which the factors are of no use: an iteration reduces the error by half of
/// it, so that `most_iterations` of them reduce a guess's 1e-6 to round-off at 0.04.
constexpr double largest_change = 0.05;

constexpr int most_iterations = factorisation_cost + 1;

void check_rows(const Field& saved, int dofs) {
  if (saved.size() > 0 && saved.rows() != dofs)
    throw InputError(format("factors of a surface with %td nodes, expected %d", saved.rows(), dofs));
}

}  // namespace

LaggedBlockSolver::LaggedBlockSolver(const SurfaceSpace& space)
    : space_(space), block_(space.pattern()), service_(factorisation_cost) {}

bool LaggedBlockSolver::is_due(double alpha) const {
  return service_.is_over() || !(std::abs(alpha_ / alpha - 1) <= largest_change);
}

BlockSolver& LaggedBlockSolver::factorise(double alpha, const Field& x, const SymmetricMatrix& M,
                                          const SymmetricMatrix& A) {
  service_.end();
  block_.factorise(alpha, 1, 1, M, A);
  alpha_ = alpha;
  x_ = x;
  service_.start();
  ++factorisations_;
  return block_;
}

void LaggedBlockSolver::solve(double alpha, const Field& x, const SymmetricMatrix& M,
                              const SymmetricMatrix& A, Guess& guess, Field& r_to_u, Field& s_to_w) {
  if (guess.u_change.size() == 0) {
    guess.u_change.setZero(guess.u.rows(), guess.u.cols());
    guess.w_change = guess.u_change;
  }
  u_ = guess.u + guess.u_change;
  w_ = guess.w + guess.w_change;
  std::optional<int> iterations;
  if (!is_due(alpha)) iterations = block_.refine(alpha, 1, 1, M, A, r_to_u, s_to_w, most_iterations, u_, w_);
  if (!iterations) {
    factorise(alpha, x, M, A);
    iterations = 1;
    block_.solve(r_to_u, s_to_w);
  } else {
    r_to_u = u_;
    s_to_w = w_;
  }
  service_.add_step(*iterations);
  guess.u_change = r_to_u - guess.u;
  guess.w_change = s_to_w - guess.w;
}

nlohmann::json LaggedBlockSolver::progress() const {
  return {{"has_factors", service_.serves()},
          {"alpha", alpha_},
          {"x", packed(x_)},
          {"service", service_.progress()}};
}

void LaggedBlockSolver::resume(const nlohmann::json& saved) {
  const Field x = unpacked(saved.at("x"));
  check_rows(x, space_.dofs());
  service_.end();
  if (saved.at("has_factors").get<bool>()) {
    SymmetricMatrix M = space_.matrix(), A = space_.matrix();
    space_.assemble(x, M, A);
    factorise(saved.at("alpha").get<double>(), x, M, A);
  }
  service_.resume(saved.at("service"));
}

nlohmann::json progress(const LaggedBlockSolver::Guess& guess) {
  return {{"u_change", packed(guess.u_change)}, {"w_change", packed(guess.w_change)}};
}

void resume(LaggedBlockSolver::Guess& guess, const nlohmann::json& saved, int dofs) {
  const Field u_change = unpacked(saved.at("u_change")), w_change = unpacked(saved.at("w_change"));
  for (const Field* field : {&u_change, &w_change}) check_rows(*field, dofs);
  guess.u_change = u_change;
  guess.w_change = w_change;
}

}  // namespace esfem
