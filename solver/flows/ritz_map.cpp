// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/ritz_map.hpp"

#include "solver/assembly/lifted_points.hpp"
#include "solver/linalg/spd_solver.hpp"

namespace esfem {

Field ritz_map(const SurfaceSpace& space, const Field& x, const Surface& surface,
               const std::function<ValueAndGradient(const Vec3& y)>& u, double length) {
  const ShapeTable shapes = shape_functions(space.degree(), space.quadrature().points);
  const double mass_factor = 1 / (length * length);
  Field load = Field::Zero(space.dofs(), 1);
  visit_lifted_points(space, x, surface, [&](const LiftedPoint& point) {
    const ValueAndGradient exact = u(point.y);
    const Eigen::Vector2d flux = point.dual.transpose() * exact.gradient;
    for (int i = 0; i < shapes.value.cols(); ++i) {
      load(space.elements()(point.element, i), 0) +=
          point.dA * (mass_factor * exact.value * shapes.value(point.q, i) +
                      flux[0] * shapes.dxi(point.q, i) + flux[1] * shapes.deta(point.q, i));
    }
  });
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  SpdSolver spd(space.pattern());
  spd.factorise(mass_factor, M, 1.0, A);
  spd.solve(load);
  return load;
}

}  // namespace esfem
