// SPDX-License-Identifier: GPL-3.0-or-later
// What kll19 (5.1) and the generalised flow have in common, u = (nu, V): V = H in (5.1).
#pragma once

#include "solver/assembly/surface_space.hpp"

namespace esfem {

/// -V nu in the nodes.
template <class U>
Field interpolated_velocity(const U& u) {
  return (-u.col(3)).asDiagonal() * u.leftCols(3);
}

/// |A|² u - alpha (nu_h - nu_Gamma_h), the load f of §3.3 with the stabilising term of §14: 4 values. The
/// first inputs are nu and V.
template <int inputs>
[[gnu::always_inline]] inline void set_curvature_load(const PointData<inputs>& p, double alpha, Pack* f) {
  Pack weingarten_squared = {};  // alpha_h² = |grad nu_h|²
  for (int l = 0; l < 3; ++l) {
    for (int i = 0; i < 3; ++i) weingarten_squared += p.grad[l][i] * p.grad[l][i];
  }
  for (int l = 0; l < 3; ++l) f[l] = weingarten_squared * p.u[l] - alpha * (p.u[l] - p.normal[l]);
  f[3] = weingarten_squared * p.u[3];
}

/// The loads g (columns 0-2) and f (columns 3-6) of §3.3.
struct MeanCurvatureLoads {
  double alpha;        ///< of the stabilising term, 1/time
  double mass_factor;  ///< 1/L², L of K = M/L² + A

  /// The integrand, with the inputs nu and V.
  void operator()(const PointData<4>& p, Integrand<7, 3>& load) const {
    const Pack V = p.u[3];
    for (int l = 0; l < 3; ++l) {
      load.value[l] = -mass_factor * V * p.u[l];
      for (int i = 0; i < 3; ++i) load.flux[l][i] = -(V * p.grad[l][i] + p.u[l] * p.grad[3][i]);
    }
    set_curvature_load(p, alpha, load.value + 3);
  }
};

/// f + w (v . grad) u where the nodes move by v, a velocity with a tangential part: inputs nu, V, v. Normal
/// motion at speed -V has w d°nu = Lap nu + |A|² nu and w d°V = Lap V + |A|² V. Along v the derivative is
/// d• = d° + v_T . grad, and v_T . grad = v . grad, since gradients are tangential. weight(V) is w, 1 in
/// mean curvature flow.
template <class Weight>
struct MovingCurvatureLoad {
  double alpha;   ///< of the stabilising term, 1/time
  Weight weight;  ///< (const Pack& V) -> w

  /// The integrand.
  void operator()(const PointData<7>& p, Integrand<4, 0>& load) const {
    set_curvature_load(p, alpha, load.value);
    const auto w = weight(p.u[3]);
    for (int l = 0; l < 4; ++l)
      for (int i = 0; i < 3; ++i) load.value[l] += w * (p.u[4 + i] * p.grad[l][i]);
  }
};

/// @cond

template <class Weight>
MovingCurvatureLoad(double alpha, Weight weight) -> MovingCurvatureLoad<Weight>;

/// @endcond

}  // namespace esfem
