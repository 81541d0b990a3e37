// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/assembly/surface_space.hpp"
#include "solver/linalg/node_block_lu.hpp"

namespace esfem {

/// The linear system of a step of Barrett, Garcke and Nürnberg. With N_a the integrals of nu_a phi_i phi_j
/// (a = 1, 2, 3) on the old surface, nu its own normal, x its nodes and x + dx the new ones, it is
///   S H + sum_a N_a dx_a = r,
///   N_a H - A dx_a = A x_a:
/// the second line is (H nu, eta) = (grad (x + dx), grad eta), the first, with a symmetric S, the flow's own.
/// It is symmetric and indefinite. Unknowns and equations go node by node, H, dx_1, dx_2, dx_3: each pair of
/// nodes that share an element has a block
///   [S    N_1  N_2  N_3]
///   [N_1  -A           ]
///   [N_2       -A      ]
///   [N_3            -A ].
class BgnSystem {
 public:
  explicit BgnSystem(const SurfaceSpace& space);

  /// M, A and N_a on Gamma_h[x].
  void assemble(const SurfaceSpace& space, const Field& x);
  /// Solves with the nodes x that it was assembled for. r: N x 1; H (N x 1) and dx (N x 3) are resized if
  /// needed. Throws NumericsError when the matrix is singular or not finite.
  void solve(const SymmetricMatrix& S, const Field& r, const Field& x, Field& H, Field& dx);

  const SymmetricMatrix& M() const { return M_; }
  const SymmetricMatrix& A() const { return A_; }

 private:
  double length_;
  SymmetricMatrix M_, A_, N_[3];
  NodeBlockLu lu_;
  Field Ax_;
  Eigen::VectorXd right_, solution_;
};

}  // namespace esfem
