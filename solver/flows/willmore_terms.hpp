// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/assembly/surface_space.hpp"
#include "solver/flows/willmore_law.hpp"

namespace esfem {

/// The terms of kll21 (3.5) at a quadrature point at time t, with u = (H, nu) as the first four inputs.
/// Without Q, which is 0: what F needs.
template <int inputs>
WillmorePoint willmore_point(const PointData<inputs>& p, double t = 0) {
  WillmorePoint at;
  at.t = t;
  at.H = p.u[0];
  at.A_squared = Pack{};
  for (int i = 0; i < 3; ++i) {
    at.x[i] = p.x[i];
    at.nu[i] = p.u[1 + i];
    at.grad_H[i] = p.grad[0][i];
    for (int l = 0; l < 3; ++l) {
      at.A[i][l] = 0.5 * (p.grad[1 + l][i] + p.grad[1 + i][l]);
      at.A_squared += at.A[i][l] * at.A[i][l];
    }
  }
  for (int i = 0; i < 3; ++i) at.A_grad_H[i] = dot(at.A[i], at.grad_H);
  at.Q = Pack{};
  return at;
}

/// The same with Q of a law.
template <int inputs>
WillmorePoint willmore_point(const PointData<inputs>& p, const WillmoreLaw& law, double t = 0) {
  WillmorePoint at = willmore_point(p, t);
  law(at, at.Q);
  return at;
}

/// Adds F(x, u) w of (3.3) to the values of the rows (H, nu): -|A|² V and (H A - A²) z, w = (V, z).
inline void add_F(const WillmorePoint& at, const Pack* w, Pack* value) {
  const Pack z[3] = {w[1], w[2], w[3]};
  Pack A_z[3];
  for (int i = 0; i < 3; ++i) A_z[i] = dot(at.A[i], z);
  value[0] -= at.A_squared * w[0];
  for (int i = 0; i < 3; ++i) value[1 + i] += at.H * A_z[i] - dot(at.A[i], A_z);
}

/// Adds Q's part of f_2 of (3.5a) to values and fluxes of the rows nu: -Q H nu, tested with phi, and Q e_l,
/// tested with grad phi. It is -grad Q, integrated by parts.
inline void add_Q(const WillmorePoint& at, const Pack& Q, Pack* value, Pack (*flux)[3]) {
  for (int l = 0; l < 3; ++l) {
    value[l] -= Q * at.H * at.nu[l];
    flux[l][l] += Q;
  }
}

/// Adds f_2 of (3.5a) to values and fluxes of the rows (H, nu): |grad H|² nu + A² grad H - Q H nu, tested
/// with phi, and 2 (A grad H) nu_l + Q e_l, tested with grad phi.
inline void add_f(const WillmorePoint& at, Pack* value, Pack (*flux)[3]) {
  const Pack along_nu = dot(at.grad_H, at.grad_H);
  for (int l = 0; l < 3; ++l) {
    value[1 + l] += along_nu * at.nu[l] + dot(at.A[l], at.A_grad_H);
    for (int i = 0; i < 3; ++i) flux[1 + l][i] += 2.0 * at.A_grad_H[i] * at.nu[l];
  }
  add_Q(at, at.Q, value + 1, flux + 1);
}

/// Adds g = (g_1, g_2) of (3.5b) to the values of the rows (V, z): Q and |A|² nu.
inline void add_g(const WillmorePoint& at, Pack* value) {
  value[0] += at.Q;
  for (int l = 0; l < 3; ++l) value[1 + l] += at.A_squared * at.nu[l];
}

/// Adds the relaxation towards the geometry of Gamma_h, with its normal n, to values and fluxes of the rows
/// (H, nu): lambda (div nu_h - H_h) and lambda (n - nu_h), tested with phi, and lambda nu_h, tested with grad
/// phi. Integration by parts turns the row H into the weak mean curvature of Gamma_h, times n . nu_h, minus
/// H_h.
inline void add_relaxation(const WillmorePoint& at, double lambda, const Pack (&n)[3], Pack* value,
                           Pack (*flux)[3]) {
  value[0] += lambda * (at.A[0][0] + at.A[1][1] + at.A[2][2] - at.H);
  for (int l = 0; l < 3; ++l) {
    value[1 + l] += lambda * (n[l] - at.nu[l]);
    flux[0][l] += lambda * at.nu[l];
  }
}

}  // namespace esfem
