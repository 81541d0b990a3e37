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
  // One column a point: what a sum over the nodes runs through.
  const Eigen::MatrixXd values = shapes.value.transpose(), dxi = shapes.dxi.transpose(),
                        deta = shapes.deta.transpose();
  const int nodes = static_cast<int>(values.rows());
  Eigen::MatrixXd local(nodes, components);
  Eigen::VectorXd exact_value(components);
  Eigen::MatrixXd exact_gradient(3, components);
  SquaredNorms norms{Eigen::VectorXd::Zero(components), Eigen::VectorXd::Zero(components)};
  visit_lifted_points(space, x_star, exact.surface(t), [&](const LiftedPoint& point) {
    if (point.q == 0)
      for (int i = 0; i < nodes; ++i) local.row(i) = w.row(space.elements()(point.element, i));
    exact.fields(t, point.y, point.shape, exact_value, exact_gradient);
    for (int l = 0; l < components; ++l) {
      const auto nodal = local.col(l);
      const double e = values.col(point.q).dot(nodal) - exact_value[l];
      const Vec3 e_gradient = point.dual.col(0) * dxi.col(point.q).dot(nodal) +
                              point.dual.col(1) * deta.col(point.q).dot(nodal) - exact_gradient.col(l);
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
