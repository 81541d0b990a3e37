// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "solver/assembly/symmetric_matrix.hpp"

namespace esfem {

/// Cholesky factorisation of matrices on one pattern (CHOLMOD, supernodal): nested dissection once, numbers
/// per call.
class SparseCholesky {
 public:
  /// Symbolic analysis.
  explicit SparseCholesky(std::shared_ptr<const SparsityPattern> pattern);
  ~SparseCholesky();
  SparseCholesky(const SparseCholesky&) = delete;
  SparseCholesky& operator=(const SparseCholesky&) = delete;

  /// Factorises a M + b A. Throws NumericsError when it is not positive definite or not finite.
  void factorise(double a, const SymmetricMatrix& M, double b, const SymmetricMatrix& A);
  /// Solves for all columns at once, in place (N x c).
  void solve(Field& rhs);

 private:
  struct Cholmod;
  std::unique_ptr<Cholmod> cholmod_;
};

}  // namespace esfem
