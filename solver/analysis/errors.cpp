// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/analysis/errors.hpp"

#include <cmath>

#include "solver/assembly/lifted_points.hpp"
#include "solver/fe/lagrange.hpp"

namespace esfem {

SquaredNorms nodal_norms(const SymmetricMatrix& M, const SymmetricMatrix& A, const Field& e) {
  Field Me, Ae;
  M.multiply(e, Me);
  A.multiply(e, Ae);
  return {e.cwiseProduct(Me).colwise().sum(), e.cwiseProduct(Ae).colwise().sum()};
}

SquaredNorms lifted_errors(const SurfaceSpace& space, const Field& x_star, const ExactEvolution& exact,
                           double t, const Field& w) {
  const int components = exact.components();
  const ShapeTable shapes = shape_functions(space.degree(), space.quadrature().points);
  const int points = static_cast<int>(shapes.value.rows()), nodes = static_cast<int>(shapes.value.cols());
  // Nodal values of an element -> values and reference derivatives in its points: three rows a point.
  Eigen::MatrixXd to_points(3 * points, nodes);
  for (int q = 0; q < points; ++q) {
    to_points.row(3 * q) = shapes.value.row(q);
    to_points.row(3 * q + 1) = shapes.dxi.row(q);
    to_points.row(3 * q + 2) = shapes.deta.row(q);
  }
  Eigen::MatrixXd local(nodes, components), at_points(3 * points, components);
  Eigen::VectorXd exact_value(components);
  Eigen::MatrixXd exact_gradient(3, components);
  SquaredNorms norms{Eigen::VectorXd::Zero(components), Eigen::VectorXd::Zero(components)};
  visit_lifted_points(space, x_star, exact.surface(t), [&](const LiftedPoint& point) {
    if (point.q == 0) {
      for (int i = 0; i < nodes; ++i) local.row(i) = w.row(space.elements()(point.element, i));
      at_points.noalias() = to_points.lazyProduct(local);
    }
    exact.fields(t, point.y, point.shape, exact_value, exact_gradient);
    for (int l = 0; l < components; ++l) {
      const double* w_l = &at_points(3 * point.q, l);
      const double e = w_l[0] - exact_value[l];
      const Vec3 e_gradient = point.dual.col(0) * w_l[1] + point.dual.col(1) * w_l[2] - exact_gradient.col(l);
      norms.L2[l] += point.dA * e * e;
      norms.H1_semi[l] += point.dA * e_gradient.squaredNorm();
    }
  });
  return norms;
}

ErrorRecorder::ErrorRecorder(const SurfaceSpace& space, const ExactEvolution& exact, Field x0)
    : space_(space), exact_(exact), x0_(std::move(x0)), M_(space.matrix()), A_(space.matrix()) {}

void ErrorRecorder::record(double t, const Field& w) {
  const Field x_star = exact_.trajectories(x0_, t);
  space_.assemble(x_star, M_, A_);
  series_["t"].push_back(t);
  add("nodal", nodal_norms(M_, A_, w - exact_.nodal_values(x_star, t)));
  add("lifted", lifted_errors(space_, x_star, exact_, t, w));
}

void ErrorRecorder::add(const std::string& kind, const SquaredNorms& norms) {
  int column = 0;
  for (const auto& [quantity, components] : exact_.quantities) {
    // Round-off can make a vanishing eᵀAe negative.
    const double L2 = std::max(0.0, norms.L2.segment(column, components).sum());
    const double H1_semi = std::max(0.0, norms.H1_semi.segment(column, components).sum());
    const std::pair<const char*, double> values[] = {
        {"_L2", std::sqrt(L2)}, {"_H1", std::sqrt(L2 + H1_semi)}, {"_H1_semi", std::sqrt(H1_semi)}};
    for (const auto& [norm, error] : values) {
      double& maximum = maxima_[quantity][kind + norm];
      maximum = std::max(maximum, error);
      series_[quantity + "_" + kind + norm].push_back(error);
    }
    column += components;
  }
}

}  // namespace esfem
