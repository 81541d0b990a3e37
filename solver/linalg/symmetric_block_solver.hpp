// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "solver/assembly/symmetric_matrix.hpp"

namespace esfem {

/// Solver of symmetric block systems
///   P u + Q w = r,
///   Q u + R w = s
/// for symmetric, in general indefinite matrices P, Q, R on one pattern: L D L^T with threshold pivoting by
/// MUMPS; symbolic analysis once, numbers per call. Where P and R are multiples of M and Q of A the complex
/// form of BlockSolver takes half as long; and an LU factorisation (NodeBlockLu) takes three times as long.
class SymmetricBlockSolver {
 public:
  /// Symbolic analysis. Throws NumericsError when it fails.
  explicit SymmetricBlockSolver(std::shared_ptr<const SparsityPattern> pattern);
  ~SymmetricBlockSolver();
  SymmetricBlockSolver(const SymmetricBlockSolver&) = delete;
  SymmetricBlockSolver& operator=(const SymmetricBlockSolver&) = delete;

  /// Throws InputError when a matrix is on another pattern, NumericsError when the system is singular or not
  /// finite.
  void factorise(const SymmetricMatrix& P, const SymmetricMatrix& Q, const SymmetricMatrix& R);
  /// Solves in place: the right-hand sides r and s (N x 1) become u and w.
  void solve(Field& r_to_u, Field& s_to_w);

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

}  // namespace esfem
