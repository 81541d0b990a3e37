// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/geometry/ritz_map.hpp"

#include "solver/assembly/lifted_points.hpp"
#include "solver/linalg/spd_solver.hpp"

namespace esfem {

Field ritz_map(const SurfaceSpace& space, const Field& x, const Surface& surface,
               const std::function<ValueAndGradient(const Vec3& y)>& u, double length) {
  const ElementBatches& batches = space.batches();
  const double mass_factor = 1 / (length * length);
  Field load = Field::Zero(space.dofs(), 1);
  visit_lifted_points(space, x, surface, [&](const Batch& batch, const LiftedPoints& points) {
    Pack value, gradient[3];
    for (int lane = 0; lane < pack_size; ++lane) {
      const ValueAndGradient exact = u(lane_of(points.on_surface.y, lane));
      value[lane] = exact.value;
      for (int i = 0; i < 3; ++i) gradient[i][lane] = exact.gradient[i];
    }
    const Pack flux_xi = dot(points.dual.xi, gradient), flux_eta = dot(points.dual.eta, gradient);
    const ElementBatches::Shape* shape = batches.shapes(points.q);
    for (int a = 0; a < batches.nodes(); ++a) {
      const Pack at_node = points.dA * (mass_factor * value * shape[a].value + flux_xi * shape[a].dxi +
                                        flux_eta * shape[a].deta);
      for (int lane = 0; lane < pack_size; ++lane) load(batch.node[pack_size * a + lane], 0) += at_node[lane];
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
