// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/flows/linearised_cahn_hilliard.hpp"

namespace esfem {

/// Benchmark 1d of PFHub (Jokisaari, Voorhees, Guyer, Warren, Heinonen, Comput. Mater. Sci. 126, 2017):
/// spinodal decomposition on a sphere of radius 100 at rest,
///   c_t = div(M grad mu),   mu = f'(c) - kappa Lap c,   f = 5 (c - 0.3)² (0.7 - c)²,   kappa = 2,   M = 5.
/// With u = c and w = M mu this is the equation of LinearisedCahnHilliard for epsilon = M kappa and g =
/// epsilon M f'.
struct PfhubSphere {
  static constexpr double radius = 100;                ///< of the sphere
  static constexpr double kappa = 2;                   ///< of the gradient energy
  static constexpr double mobility = 5;                ///< M
  static constexpr double epsilon = mobility * kappa;  ///< of LinearisedCahnHilliard

  /// f for doubles and Packs.
  template <class T>
  static T f(const T& c) {
    return 5.0 * (c - 0.3) * (c - 0.3) * (0.7 - c) * (0.7 - c);
  }
  /// With a = c - 0.3, b = 0.7 - c: a' = 1, b' = -1, so f' = 10 a b (b - a) and f'' = 10 ((b - a)² - 2 a b).
  template <class T>
  static T df(const T& c) {
    return 10.0 * (c - 0.3) * (0.7 - c) * (1.0 - 2.0 * c);
  }
  /// f''.
  template <class T>
  static T d2f(const T& c) {
    return 10.0 * ((1.0 - 2.0 * c) * (1.0 - 2.0 * c) - 2.0 * (c - 0.3) * (0.7 - c));
  }

  /// The functions of a Problem: g, its derivative with respect to u, f = 0 and no b.
  /// @{
  Pack g(double, const PointData<1>& p) const { return epsilon * mobility * df(p.u[0]); }
  Pack dg(double, const PointData<1>& p) const { return epsilon * mobility * d2f(p.u[0]); }
  Pack f(double, const PointData<1>&) const { return Pack{}; }
  void b(double, const Field&, Field&) const {}
  /// @}
};

/// c at the start in the nodes x, N x 1: three waves in the Cartesian coordinates x1, x2, at most 0.03 high.
Field pfhub_initial_values(const Field& x);

/// The state at t = 0 on nodes x with given c (N x 1); w from the second equation.
CahnHilliardState pfhub_state(const SurfaceSpace& space, const Field& x, const Field& c);

/// Total energy, integral of f + kappa/2 |grad c|² over Gamma_h[x]. c: N x 1.
double pfhub_energy(const SurfaceSpace& space, const Field& x, const Field& c);

}  // namespace esfem
