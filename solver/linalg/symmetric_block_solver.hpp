// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "solver/linalg/symmetric_factor.hpp"

namespace esfem {

/// Solver of symmetric block systems
///   P u + Q w = r,
///   Q u + R w = s
/// for symmetric, in general indefinite matrices P, Q, R on one pattern. Where P and R are multiples of M and
/// Q of A the complex form of BlockSolver takes half as long.
///
/// L D L^T without pivoting meets small pivots in such systems. They are replaced, and iterative refinement,
/// or GMRES where that is slow, compensates for this and for the growth of round-off.
class SymmetricBlockSolver {
 public:
  /// The symbolic phase for P, Q and R on this pattern. Throws NumericsError when METIS fails.
  explicit SymmetricBlockSolver(std::shared_ptr<const SparsityPattern> pattern);

  /// The matrices are needed until the last solve. Throws InputError when a matrix is on another pattern,
  /// NumericsError when the system is singular or not finite.
  void factorise(const SymmetricMatrix& P, const SymmetricMatrix& Q, const SymmetricMatrix& R);
  /// Solves in place: the right-hand sides r and s (N x 1) become u and w. Throws NumericsError when the
  /// iteration does not converge: the system is singular to round-off.
  void solve(Field& r_to_u, Field& s_to_w);

 private:
  void multiply(const Field& y, Field& out) const;

  std::shared_ptr<const SparsityPattern> pattern_;
  SymmetricFactor<double, 2> factor_;
  const SymmetricMatrix *P_ = nullptr, *Q_ = nullptr, *R_ = nullptr;
  Field row_size_;  ///< sum of the sizes of a row's entries
  Field right_, y_, correction_;
};

}  // namespace esfem
