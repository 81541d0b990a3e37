// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "solver/flows/coupled_diffusion.hpp"
#include "solver/problems/exact_evolution.hpp"

namespace esfem {

/// The manufactured solution of nick18 §7.3: X(q, t) = r(t) q on the unit sphere, u = a(t) x1 x2 x3, and r,
/// r', r'', a, a' at one time.
struct GrowingSphere {
  double r;    ///< radius, 1 + sin(pi t)/2
  double dr;   ///< r'
  double ddr;  ///< r''
  double a;    ///< exp(-t²)
  double da;   ///< a'

  /// All of them at time t.
  explicit GrowingSphere(double t);
};

/// f and g of (2.7)-(2.8) that have this solution, for one species.
///
/// u is a homogeneous harmonic polynomial of degree 3, so on the sphere of radius r, Lap u = -12 u/r², and
/// d•u = (3 r'/r + a'/a) u along x = r q; v = (r'/r) x = r' nu, div v = 2 r'/r, Lap v = -2 r'/r² nu, d•v =
/// r'' nu:
///   f = d•u + u div v - D Lap u = (5 r'/r + a'/a + 12 D/r²) u,
///   G = r' + 2 alpha r'/r² + 2 beta/r             for the regularised law,
///   G = r'' + 2 r'²/r + 2 alpha r'/r²             for the dynamic law.
/// f amplifies errors: relative to u, those in the spherical harmonics of degree l = 0, 1, 2 grow over [0, 1]
/// by exp int (12 - l(l+1)) D/r² dt = 1372, 412, 37 (D = 1).
class GrowingSphereProblem {
 public:
  /// Of a Problem of CoupledDiffusion.
  static constexpr int species = 1;

  /// How g depends on u; all have the same exact solution.
  enum Coupling {
    additive,  ///< g = G(t) + (u - a x1 x2 x3)

    /// g = u G(t)/(a x1 x2 x3), as §7.3 prints it: 0/0 on three planes. Errors of u are amplified where
    /// quadrature points come near them; on coarse meshes the run becomes unstable.
    quotient,
    none  ///< g = G(t)
  };

  /// parameters and law are those of the flow. Throws InputError when there is not one D.
  GrowingSphereProblem(const CoupledDiffusionParameters& parameters, CoupledDiffusionVariant::Law law,
                       Coupling coupling = additive);

  /// f at points where u is p.u: a multiple of u.
  void f(double t, const PointData<1>& p, Pack (&out)[1]) const {
    const GrowingSphere s(t);
    out[0] = (5 * s.dr / s.r + s.da / s.a + 12 * D_ / (s.r * s.r)) * p.u[0];
  }

  /// g, by the coupling.
  Pack g(double t, const PointData<1>& p) const {
    const GrowingSphere s(t);
    const Pack exact_u = s.a * p.x[0] * p.x[1] * p.x[2];
    const double G = normal_load(s);
    if (coupling_ == additive) return G + (p.u[0] - exact_u);
    if (coupling_ == quotient) return G * p.u[0] / exact_u;
    return pack(G);
  }

 private:
  double normal_load(const GrowingSphere& s) const;  ///< G

  double alpha_, beta_, D_;
  CoupledDiffusionVariant::Law law_;
  Coupling coupling_;
};

/// The exact solution, from the unit sphere at t = 0. Quantities x, v, u.
ExactEvolution growing_sphere();

/// The state whose nodal values are those of an exact solution with quantities v and u, in the nodes that
/// start at x0.
CoupledDiffusionState exact_growing_sphere_state(const SurfaceSpace& space, const ExactEvolution& exact,
                                                 const Field& x0, double t);

}  // namespace esfem
