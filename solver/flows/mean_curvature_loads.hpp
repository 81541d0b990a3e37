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

/// The loads g (columns 0-2) and f (columns 3-6) of §3.3, with the stabilising term of §14 in f_1.
struct MeanCurvatureLoads {
  double alpha, mass_factor;

  void operator()(const PointData<4>& p, Integrand<7, 3>& load) const {
    const Pack V = p.u[3];
    Pack weingarten_squared = {};  // alpha_h² = |grad nu_h|²
    for (int l = 0; l < 3; ++l) {
      for (int i = 0; i < 3; ++i) weingarten_squared += p.grad[l][i] * p.grad[l][i];
    }
    for (int l = 0; l < 3; ++l) {
      load.value[l] = -mass_factor * V * p.u[l];
      for (int i = 0; i < 3; ++i) load.flux[l][i] = -(V * p.grad[l][i] + p.u[l] * p.grad[3][i]);
      load.value[3 + l] = weingarten_squared * p.u[l] - alpha * (p.u[l] - p.normal[l]);
    }
    load.value[6] = weingarten_squared * V;
  }
};

}  // namespace esfem
