// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "solver/assembly/surface_space.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/surfaces/surface.hpp"

namespace esfem {

/// A quadrature point of a discrete surface, lifted to the exact one (kll19 §3.4).
struct LiftedPoint {
  int element, q;
  Vec3 y;                            ///< closest point of the surface
  Surface::Shape shape;              ///< there
  double dA;                         ///< weight of the rule times the lifted element's area
  Eigen::Matrix<double, 3, 2> dual;  ///< grad of a lifted function = dual (d_xi, d_eta) of its reference form
};

/// Calls visit(LiftedPoint) for the quadrature points of Gamma_h[x] that are lifted to `surface` by its
/// closest point.
///
/// With x = y + s nu(y) the tangents of the lifted element are dy = (I + s A(y))^{-1} P dx.
template <class Visit>
void visit_lifted_points(const SurfaceSpace& space, const Field& x, const Surface& surface, Visit&& visit) {
  const Quadrature& rule = space.quadrature();
  const ShapeTable shapes = shape_functions(space.degree(), rule.points);
  const int nodes = static_cast<int>(shapes.value.cols());
  Eigen::Matrix<double, 3, Eigen::Dynamic> local(3, nodes);
  for (int element = 0; element < space.element_count(); ++element) {
    for (int i = 0; i < nodes; ++i) local.col(i) = x.row(space.elements()(element, i));
    for (int q = 0; q < rule.weights.size(); ++q) {
      Vec3 position = Vec3::Zero();
      Eigen::Matrix<double, 3, 2> tangents = Eigen::Matrix<double, 3, 2>::Zero();
      for (int i = 0; i < nodes; ++i) {
        position += shapes.value(q, i) * local.col(i);
        tangents.col(0) += shapes.dxi(q, i) * local.col(i);
        tangents.col(1) += shapes.deta(q, i) * local.col(i);
      }
      LiftedPoint point;
      point.element = element;
      point.q = q;
      point.y = surface.closest_point(position);
      point.shape = surface.shape_at(point.y);
      const double s = point.shape.normal.dot(position - point.y);

      tangents -= point.shape.normal * (point.shape.normal.transpose() * tangents);
      tangents = (Mat3::Identity() + s * point.shape.weingarten).inverse() * tangents;
      const Eigen::Matrix2d metric = tangents.transpose() * tangents;
      point.dA = rule.weights[q] * std::sqrt(metric.determinant());
      point.dual = tangents * metric.inverse();
      visit(point);
    }
  }
}

}  // namespace esfem
