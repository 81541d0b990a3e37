// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "solver/assembly/surface_space.hpp"
#include "solver/linalg/block_solver.hpp"

namespace esfem {

/// Solves the block systems of a sequence of time steps, alpha M u - A w = r, A u + M w = s (N x 4), with the
/// factors of an earlier step's system as long as that is cheaper than a factorisation per step:
/// BlockSolver::refine from a guess, to the accuracy of a direct solution.
///
/// With c the cost of a factorisation in iterations and m_j the iterations of step j, a factorisation that
/// serves n steps costs (c + m_1 + .. + m_n) / n a step. That is minimal when a new factorisation is made as
/// soon as m_n exceeds this mean, or after 50 steps. The decision depends on counts alone, not on clocks.
class LaggedBlockSolver {
 public:
  /// The space must outlive the solver.
  explicit LaggedBlockSolver(const SurfaceSpace& space);

  /// Solves the system with M(x) and A(x) in place: the right-hand sides r and s become u and w. u_guess and
  /// w_guess come from the steps before; the error of the newest guess is added to them. Throws as
  /// BlockSolver does.
  void solve(double alpha, const Field& x, const SymmetricMatrix& M, const SymmetricMatrix& A,
             const Field& u_guess, const Field& w_guess, Field& r_to_u, Field& s_to_w);

  /// Factorises the system, for repeated solves.
  BlockSolver& factorise(double alpha, const Field& x, const SymmetricMatrix& M, const SymmetricMatrix& A);

  /// The number of factorisations since the solver has been made.
  int factorisations() const { return factorisations_; }

  /// What later solutions depend on to the last bit, for checkpoints.
  nlohmann::json progress() const;
  /// Resumes from there; factorises. Throws InputError when a field has not N rows.
  void resume(const nlohmann::json& saved);

 private:
  bool is_due(double alpha) const;

  const SurfaceSpace& space_;
  BlockSolver block_;
  double alpha_ = 0;           ///< of the factors; 0: there are none
  Field x_;                    ///< nodes of the factors' matrices
  int steps_ = 0;              ///< that the factors have served
  int iterations_ = 0;         ///< of all these steps
  int newest_iterations_ = 0;  ///< of the last step
  Field u_change_, w_change_;  ///< solution minus guess of the newest step
  Field u_, w_;
  int factorisations_ = 0;
};

}  // namespace esfem
