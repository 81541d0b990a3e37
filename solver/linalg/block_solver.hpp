// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>

#include "solver/assembly/symmetric_matrix.hpp"

namespace esfem {

/// Solver of the block systems of fourth order flows,
///   alpha M u - beta A w = r,
///   gamma A u +      M w = s,      alpha, beta, gamma > 0,
/// for matrices M, A on one pattern: kll21 (3.5) after BDF in time (alpha = delta_0/tau, beta = gamma = 1),
/// and bk22 (8.3) with -w for w.
///
/// With kappa² = gamma/(alpha beta) and y = kappa alpha u + i w the system is the complex symmetric
///   (M + i kappa beta A) y = kappa r + i s
/// of half the size: its real part is kappa times the first line, its imaginary part the second, because
/// kappa² alpha beta = gamma. Its real part M is positive definite, so that no pivoting is needed (Higham,
/// Math. Comp. 67, 1998). Symbolic phase once, numbers per call.
class BlockSolver {
 public:
  /// The symbolic phase for M and A on this pattern. Throws NumericsError when METIS fails.
  explicit BlockSolver(std::shared_ptr<const SparsityPattern> pattern);
  ~BlockSolver();
  BlockSolver(const BlockSolver&) = delete;
  BlockSolver& operator=(const BlockSolver&) = delete;

  /// Throws InputError unless the factors are positive, NumericsError when the matrix is singular or not
  /// finite.
  void factorise(double alpha, double beta, double gamma, const SymmetricMatrix& M, const SymmetricMatrix& A);
  /// Solves for all columns at once, in place: the right-hand sides r and s (N x c) become u and w.
  void solve(Field& r_to_u, Field& s_to_w);

  /// Solves another system, of which u and w (N x c) are a guess, by iterative refinement: the factors of the
  /// system that was factorised last precondition it. Ends when each column's residual in the complex form is
  /// at most 5e-16 of |right-hand side| + |diagonal of the matrix times y|, which is about what a direct
  /// solution attains. Four columns at once: returns the largest number of iterations of these groups, at
  /// least one; none when a group needs more than `most` of them at the rate of the newest: then u and w are
  /// the last iterates. Allocates nothing from the second call on. Throws as factorise and solve do; numbers
  /// that are not finite make it return none.
  std::optional<int> refine(double alpha, double beta, double gamma, const SymmetricMatrix& M,
                            const SymmetricMatrix& A, const Field& r, const Field& s, int most, Field& u,
                            Field& w);

 private:
  void check_system(double alpha, double beta, double gamma, const SymmetricMatrix& M,
                    const SymmetricMatrix& A) const;
  void check_columns(const Field& r, const Field& other) const;

  struct Factor;
  std::unique_ptr<Factor> factor_;
};

}  // namespace esfem
