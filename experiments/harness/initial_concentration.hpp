// SPDX-License-Identifier: GPL-3.0-or-later
// The initial values of bk22 §9.3 on a sphere.
#pragma once

#include <cmath>
#include <functional>

#include "solver/flows/cahn_hilliard.hpp"
#include "solver/geometry/ritz_map.hpp"
#include "solver/mesh/mesh.hpp"
#include "solver/surfaces/surface.hpp"

namespace esfem {

constexpr double initial_radius = 5;

/// u at t = 0 as a function of space, c (x1 + x1² x2² x3).
struct Concentration {
  double c;
  template <class T>
  T operator()(const T& x1, const T& x2, const T& x3) const {
    return c * (x1 + x1 * x1 * x2 * x2 * x3);
  }
};

/// w = -epsilon Delta_Gamma u + (u³ - u)/epsilon on the initial sphere. There Delta_Gamma p = Delta p - l (l
/// + 1) p/initial_radius² for p homogeneous of degree l, here 1 and 5.
struct Potential {
  Concentration u;
  double epsilon;
  template <class T>
  T operator()(const T& x1, const T& x2, const T& x3) const {
    const double inverse = 1 / (initial_radius * initial_radius);
    const T laplacian =
        u.c * (2.0 * (x1 * x1 + x2 * x2) * x3 - inverse * (2.0 * x1 + 30.0 * x1 * x1 * x2 * x2 * x3));
    const T value = u(x1, x2, x3);
    return value * (value * value - 1.0) / epsilon - epsilon * laplacian;
  }
};

/// Value and tangential gradient on the initial sphere of a function in space.
template <class Function>
std::function<ValueAndGradient(const Vec3&)> on_sphere(const Function& f) {
  return [f](const Vec3& y) {
    const LevelSetJet jet = level_set_jet(f, y);
    const Vec3 normal = y.normalized();
    return ValueAndGradient{jet.value, jet.gradient - normal.dot(jet.gradient) * normal};
  };
}

/// The maximum of |f| on the initial sphere: from the best node of a mesh, steps along the tangential
/// gradient, halved where they lead down.
template <class Function>
double largest_on_sphere(const Function& f) {
  const Field nodes = octasphere(initial_radius, 5).nodes;
  const auto size = [&](const Vec3& y) { return std::abs(f(y[0], y[1], y[2])); };
  Vec3 best = nodes.row(0);
  for (int j = 1; j < nodes.rows(); ++j)
    if (size(nodes.row(j)) > size(best)) best = nodes.row(j);
  for (double step = initial_radius / 10; step > 1e-9 * initial_radius;) {
    const ValueAndGradient at = on_sphere(f)(best);
    const Vec3 uphill = at.value > 0 ? at.gradient : Vec3(-at.gradient);
    if (uphill.norm() == 0) break;
    const Vec3 next = initial_radius * (best + step * uphill.normalized()).normalized();
    if (size(next) > size(best))
      best = next;
    else
      step /= 2;
  }
  return size(best);
}

/// Initial values of the runs.
struct InitialValues {
  CahnHilliardState state;
  Field theta;  ///< empty: none
};

/// From u: its interpolation, or its Ritz map, with the theta that belongs to the Ritz map of w, or with w
/// from the second equation. The paper's Ritz map has no length in it, though the radius is 5.
inline InitialValues initial_values(const SurfaceSpace& space, const Field& x, const Concentration& u_0,
                                    double epsilon, bool by_ritz_map, bool with_theta) {
  const double ritz_length = 1;
  const Surface surface = sphere(initial_radius);
  Field u(x.rows(), 1);
  if (by_ritz_map) {
    u = ritz_map(space, x, surface, on_sphere(u_0), ritz_length);
  } else {
    for (int j = 0; j < x.rows(); ++j) u(j, 0) = u_0(x(j, 0), x(j, 1), x(j, 2));
  }
  if (!with_theta) return {cahn_hilliard_start(space, DoubleWell(), epsilon, 0, x, u), {}};
  const Field w = ritz_map(space, x, surface, on_sphere(Potential{u_0, epsilon}), ritz_length);
  const CahnHilliardState state = cahn_hilliard_state(space, 0, x, u, w);
  return {state, cahn_hilliard_theta(space, DoubleWell(), epsilon, state)};
}

}  // namespace esfem
