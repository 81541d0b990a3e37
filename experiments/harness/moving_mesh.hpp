// SPDX-License-Identifier: GPL-3.0-or-later
// The evolving ellipsoid of bk22 §9.1 on one mesh.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "solver/flows/cahn_hilliard.hpp"
#include "solver/mesh/mesh.hpp"
#include "solver/problems/evolving_ellipsoid.hpp"
#include "solver/problems/exact_evolution.hpp"

namespace esfem {

/// A mesh and the data that all runs on it share, mainly the positions of its nodes at all steps of the
/// smallest tau. Runs in separate processes recompute them: that takes 0.03 microseconds per node and step,
/// compared with 12 for a step of a run with its errors; reading them from a file would not be faster.
struct MovingMesh {
  ManufacturedCahnHilliard exact;
  Mesh mesh;
  SurfaceSpace space;
  double smallest_tau;
  MovingNodes nodes;

  /// substeps: how many of them the starting steps take. The positions at all of them are too many to keep.
  MovingMesh(double epsilon, Mesh initial, const Quadrature& rule, double tau, int substeps)
      : exact(EvolvingEllipsoid{}, epsilon),
        mesh(std::move(initial)),
        space(mesh, rule),
        smallest_tau(tau),
        nodes(exact.ellipsoid().velocity(), mesh.nodes, tau / substeps,
              substeps > 1 ? MovingNodes::newest_few : MovingNodes::all) {}
};

/// Those of one process by level, degree and i of the smallest tau, made by the first run that needs them.
using MovingMeshes = std::map<std::array<int, 3>, std::optional<MovingMesh>>;

/// d•u = -6u + v . grad u of the exact solution, its quantity u_derivative. The gradient by differences in
/// space.
inline ExactEvolution exact_derivative(MovingMesh& on) {
  const auto value = [&on, velocity = on.exact.ellipsoid().velocity()](const Vec3& x, double t) {
    Field v;
    velocity(t, x.transpose(), v);
    return -6 * on.exact.u(x, t) + std::exp(-6 * t) * (v(0, 0) * x[1] + v(0, 1) * x[0]);
  };
  ExactEvolution exact;
  exact.quantities = {{"u_derivative", 1}};
  exact.surface = [&on](double t) { return on.exact.ellipsoid().surface(t); };
  exact.trajectories = [&on](const Field&, double t) { return on.nodes.at(t); };
  exact.fields = [value](double t, const SurfacePoints& at, FieldsAtPoints& out) {
    const double step = 1e-5;
    for (int lane = 0; lane < pack_size; ++lane) {
      const Vec3 y = lane_of(at.y, lane), nu = lane_of(at.normal, lane);
      Vec3 gradient;
      for (int i = 0; i < 3; ++i)
        gradient[i] = (value(y + step * Vec3::Unit(i), t) - value(y - step * Vec3::Unit(i), t)) / (2 * step);
      gradient -= nu.dot(gradient) * nu;
      out.value[0][lane] = value(y, t);
      for (int i = 0; i < 3; ++i) out.gradient[0][i][lane] = gradient[i];
    }
  };
  return exact;
}

/// The load of the exact solution times a factor.
struct ScaledLoad : ManufacturedCahnHilliard::Problem {
  double factor = 1;

  void b(double t, const Field& x, Field& nodal) const {
    Problem::b(t, x, nodal);
    nodal *= factor;
  }
};

using EllipsoidCahnHilliard = CahnHilliard<ScaledLoad>;

/// Exact starting values. From interpolated u, w comes from the second equation.
inline std::function<CahnHilliardState(double t)> exact_starts(MovingMesh& on, StartValues values) {
  return [&on, values](double t) {
    const CahnHilliardState state = exact_cahn_hilliard_state(on.space, on.exact, on.nodes.at(t), t, values);
    if (values == StartValues::ritz) return state;
    return cahn_hilliard_start(on.space, DoubleWell(), on.exact.epsilon(), t, state.x, state.u);
  };
}

/// The flow on it: (8.3), or with a load that is this factor times that of the exact solution.
inline EllipsoidCahnHilliard cahn_hilliard_flow(MovingMesh& on, Field theta, double factor_of_load = 1) {
  ScaledLoad problem;
  problem.exact = &on.exact;
  problem.factor = factor_of_load;
  return EllipsoidCahnHilliard(
      on.space, problem, [&on](double t) -> const Field& { return on.nodes.at(t); }, on.exact.epsilon(),
      std::move(theta));
}

}  // namespace esfem
