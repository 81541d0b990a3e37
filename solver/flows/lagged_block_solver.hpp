// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "solver/assembly/surface_space.hpp"
#include "solver/flows/factor_service.hpp"
#include "solver/linalg/block_solver.hpp"

namespace esfem {

/// Solves the block systems of a sequence of time steps, alpha M u - A w = r, A u + M w = s (N x c), with the
/// factors of an earlier step's system as long as that is cheaper than a factorisation per step
/// (FactorService): BlockSolver::refine from a guess, to the accuracy of a direct solution.
class LaggedBlockSolver {
 public:
  /// The space must outlive the solver.
  explicit LaggedBlockSolver(const SurfaceSpace& space);

  /// The guess of a sequence of solutions, kept by the caller: u and w extrapolated from the steps before,
  /// with the error that this extrapolation had in the newest step added to them.
  struct Guess {
    /// Extrapolated from the steps before, N x c.
    /// @{
    Field u, w;
    /// @}

    /// Newest solution minus its extrapolation; empty: none yet.
    /// @{
    Field u_change, w_change;
    /// @}
  };

  /// Solves the system with M(x) and A(x) in place: the right-hand sides r and s become u and w, and the
  /// guess's changes those of this step. Throws as BlockSolver does.
  void solve(double alpha, const Field& x, const SymmetricMatrix& M, const SymmetricMatrix& A, Guess& guess,
             Field& r_to_u, Field& s_to_w);

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
  double alpha_ = 0;  ///< of the factors
  Field x_;           ///< nodes of the factors' matrices
  FactorService service_;
  Field u_, w_;
  int factorisations_ = 0;
};

/// The changes of a guess, for checkpoints; resume throws InputError when they have not N rows.
/// @{
nlohmann::json progress(const LaggedBlockSolver::Guess& guess);
void resume(LaggedBlockSolver::Guess& guess, const nlohmann::json& saved, int dofs);
/// @}

}  // namespace esfem
