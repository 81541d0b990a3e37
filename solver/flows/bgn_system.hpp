// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/assembly/surface_space.hpp"
#include "solver/linalg/symmetric_factor.hpp"

namespace esfem {

/// The linear system of a step of Barrett, Garcke and Nürnberg. With N_a the integrals of nu_a phi_i phi_j
/// (a = 1, 2, 3) on the old surface, nu its own normal, x its nodes and x + dx the new ones, it is
///   S H + sum_a N_a dx_a = r,
///   N_a H - A dx_a = A x_a:
/// the second line is (H nu, eta) = (grad (x + dx), grad eta), the first, with a symmetric S, the flow's own.
/// It is symmetric and indefinite. Unknowns and equations go node by node, dx_1, dx_2, dx_3, H: each pair of
/// nodes that share an element has a block
///   [-A            N_1]
///   [     -A       N_2]
///   [          -A  N_3]
///   [N_1  N_2  N_3  S ].
/// A comes first because S is small in small steps.
///
/// With S and A positive semi-definite it needs no pivoting, in any order of the nodes. Take the rows and
/// columns of some of the unknowns, h of H and d of dx, with K = [-A N^T; N S] in short. K (d, h) = 0 gives
/// h^T S h + d^T A d = 0, hence S h = 0, A d = 0, N d = 0 and N^T h = 0. So h and d are constant on
/// components of the surface all of whose unknowns were taken, and 0 elsewhere. Were h such a constant and
/// not 0, its N^T h would be the integrals of nu_a phi_i, the derivative of the volume, and they would vanish
/// in all nodes but the last, hence in all of them, since their sum over a closed surface does. Were d, N d =
/// 0 would say that d . nu is 0 in the mean around each node. Neither happens on a surface that bounds a
/// volume: all these minors are regular. Replacing S and A by S + e I and A + e I makes K quasi-definite,
/// with a positive pivot for each unknown of H and a negative one for each of dx (Vanderbei, SIAM J. Optim.
/// 5, 1995), and e -> 0 crosses no singular matrix: the signs stay.
class BgnSystem {
 public:
  /// The symbolic phase; keeps no reference to the space. Throws NumericsError when METIS fails.
  explicit BgnSystem(const SurfaceSpace& space);

  /// M, A and N_a on Gamma_h[x].
  void assemble(const SurfaceSpace& space, const Field& x);
  /// Solves with the nodes x that it was assembled for. r: N x 1; H (N x 1) and dx (N x 3) are resized if
  /// needed. Throws NumericsError when the matrix is singular or not finite.
  void solve(const SymmetricMatrix& S, const Field& r, const Field& x, Field& H, Field& dx);

  /// Mass matrix of the last assemble.
  const SymmetricMatrix& M() const { return M_; }
  /// Its stiffness matrix.
  const SymmetricMatrix& A() const { return A_; }

 private:
  double length_;
  SymmetricMatrix M_, A_, N_[3];
  SymmetricFactor<double, 4> factor_;
  Field Ax_, solution_;
};

}  // namespace esfem
