// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "solver/linalg/symmetric_factor.hpp"

namespace esfem {

/// Solver of symmetric positive definite systems (a M + b A) y = r for matrices M, A on one pattern: symbolic
/// phase once, numbers per call.
class SpdSolver {
 public:
  /// The symbolic phase for M and A on this pattern. Throws NumericsError when METIS fails.
  explicit SpdSolver(std::shared_ptr<const SparsityPattern> pattern);

  /// Factorises a M + b A. Throws InputError when a matrix is on another pattern, NumericsError with the node
  /// when it is not positive definite to round-off or not finite.
  void factorise(double a, const SymmetricMatrix& M, double b, const SymmetricMatrix& A);
  /// From now on the factors are read in single precision, which takes half the time for one column and is
  /// enough for a preconditioner; until the next factorise().
  void round() { factor_.round(); }
  /// Solves for all columns at once, in place (N x c).
  void solve(Field& right) { factor_.solve(right); }
  /// Bytes of the factor and of its work space.
  std::ptrdiff_t memory() const { return factor_.memory(); }

 private:
  std::shared_ptr<const SparsityPattern> pattern_;
  SymmetricFactor<double> factor_;
};

}  // namespace esfem
