// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/assembly/surface_space.hpp"
#include "solver/linalg/spd_solver.hpp"

namespace esfem {

/// Normal and mean curvature of a discrete surface of which only the nodes are known. Flows without these
/// unknowns (Dziuk's, BGN's) are assessed by them. On P_k surfaces nu converges with order k in L2, kappa and
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

  /// How far a flow's own nu (N x 3) and H (N x 1) are from the surface of the last compute(): with
  /// f_l = (M + l² A)^-1 M f, which smooths over a length l,
  ///   ||(H nu - kappa)_l|| / ||kappa_l||   in L2, l² = 4/sqrt(3) (mean area of an element)/k²,
  /// l being the edge of an equilateral element, over k. kappa itself does not converge on P1 surfaces, as a
  /// functional on H1 it does. Costs a factorisation.
  double deviation(const Field& nu, const Field& H);

  /// ||H nu - H_0 nu_0|| / ||H_0 nu_0|| in L2, with nu_0 and H_0 those of the last compute().
  double distance(const Field& nu, const Field& H) const;

  /// For nodes that move with v (N x 3): the rate at which the area changes, int grad x : grad v, and what it
  /// would be if kappa were H nu, int H nu . v; `scale` is ||H nu|| ||v||, which bounds the second.
  struct AreaRates {
    double of_surface;  ///< int grad x : grad v
    double of_fields;   ///< int H nu . v
    double scale;       ///< ||H nu|| ||v|| in L2
  };
  /// Computes them with a flow's own nu and H on the surface of the last compute().
  AreaRates area_rates(const Field& nu, const Field& H, const Field& v) const;

 private:
  const SurfaceSpace& space_;
  SymmetricMatrix M_, A_;
  SpdSolver spd_;
  Field kappa_, nu_, H_;
  Field kappa_and_nu_;  ///< right-hand sides and solutions of the six systems with M
};

}  // namespace esfem
