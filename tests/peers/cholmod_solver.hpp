// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "solver/assembly/symmetric_matrix.hpp"

namespace esfem {

/// What SpdSolver does, by CHOLMOD (supernodal): nested dissection once, numbers per call.
class CholmodSolver {
 public:
  /// Symbolic analysis.
  explicit CholmodSolver(std::shared_ptr<const SparsityPattern> pattern);
  ~CholmodSolver();
  CholmodSolver(const CholmodSolver&) = delete;
  CholmodSolver& operator=(const CholmodSolver&) = delete;

  /// Factorises a M + b A. Throws NumericsError when it is not positive definite or not finite.
  void factorise(double a, const SymmetricMatrix& M, double b, const SymmetricMatrix& A);
  /// Solves for all columns at once, in place (N x c).
  void solve(Field& rhs);
  /// Bytes that CHOLMOD holds.
  std::size_t memory() const;

 private:
  struct Cholmod;
  std::unique_ptr<Cholmod> cholmod_;
};

}  // namespace esfem
