// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Dense>
#include <string>

namespace esfem {

/// Quadrature on the reference triangle; the weights sum to its area 1/2.
struct Quadrature {
  Eigen::Matrix<double, Eigen::Dynamic, 2> points;  ///< rows (xi, eta)
  Eigen::VectorXd weights;                          ///< one a point
  int degree = 0;                                   ///< exact for polynomials up to this total degree
  std::string name;                                 ///< e.g. "symmetric degree 6 (12 points)", "conical 6x6"
};

/// Symmetric rule with positive weights and inner points that is exact to at least this degree.
/// Throws InputError beyond the largest tabulated degree (the message names it and the conical rules).
Quadrature symmetric_quadrature(int degree);

/// Conical product Gauss n x n: xi = s(1 - t), eta = t with Gauss points s, t in (0, 1), weights
/// w_s w_t (1 - t); exact to degree 2n - 2. Throws InputError unless 1 <= n <= 64.
Quadrature conical_quadrature(int n);

/// The corners with equal weights: mass lumping on P1; exact to degree 1.
Quadrature vertex_quadrature();

/// The rule for P_k elements when nothing else is asked for.
Quadrature default_quadrature(int fe_degree);

/// The rule named "conical:N" or "degree:D"; throws InputError that lists these forms.
Quadrature parse_quadrature(const std::string& text);

}  // namespace esfem
