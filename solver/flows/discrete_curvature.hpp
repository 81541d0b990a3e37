// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/assembly/surface_space.hpp"
#include "solver/linalg/sparse_cholesky.hpp"

namespace esfem {

/// Normal and mean curvature of a discrete surface of which only the nodes are known: what flows without
/// these unknowns (Dziuk's, BGN's) are judged by. On P_k surfaces nu converges with order k in L2, kappa and
/// H with order k - 1: not at all for P1.
class DiscreteCurvature {
 public:
  /// The space must outlive the object.
  explicit DiscreteCurvature(const SurfaceSpace& space);

  /// Computes all three for Gamma_h[x]; no allocation after the first call.
  void compute(const Field& x);

  /// N x 3: M(x)^-1 A(x) x, the discrete H nu = -Delta x (kll19 (2.7)). Nodal.
  const Field& kappa() const { return kappa_; }
  /// N x 3: the L2 projection of the normals of Gamma_h[x], rescaled to unit length in the nodes.
  const Field& nu() const { return nu_; }
  /// N x 1: kappa . nu in the nodes; 2/R on a sphere.
  const Field& H() const { return H_; }
  /// Willmore energy of kappa, 1/2 int |kappa_h|². Integrated.
  double willmore_energy() const { return 0.5 * M_.energy(kappa_); }

 private:
  const SurfaceSpace& space_;
  SymmetricMatrix M_, A_;
  SparseCholesky cholesky_;
  Field kappa_, nu_, H_;
  Field kappa_and_nu_;  ///< right-hand sides and solutions of the six systems with M
};

}  // namespace esfem
