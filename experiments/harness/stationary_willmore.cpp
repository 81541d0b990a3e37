// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/stationary_willmore.hpp"

#include <algorithm>
#include <cmath>

#include "solver/analysis/diagnostics.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/error.hpp"
#include "solver/geometry/discrete_curvature.hpp"
#include "solver/linalg/spd_solver.hpp"
#include "solver/problems/exact_evolution.hpp"

namespace esfem {

namespace {

/// Nodal errors of v, V and z on a surface at rest, whose matrices do not change: maxima over time.
class VelocityErrors {
 public:
  VelocityErrors(const SurfaceSpace& space, const WillmoreFlow::State& exact)
      : quantities_(space, {{"v", 3}, {"V", 1}, {"z", 3}}),
        exact_(quantities_.of(exact)),
        M_(space.matrix()),
        A_(space.matrix()) {
    space.assemble(exact.x, M_, A_);
  }

  void record(const WillmoreFlow::State& state) {
    raise_maxima(quantities_, "nodal", nodal_norms(M_, A_, quantities_.of(state) - exact_), maxima_);
  }
  const Errors& maxima() const { return maxima_; }

  /// Errors of V and z from (3.5b) at the start, M^-1 theta, also in the dual norm of kll21 §5.4, in which
  /// the square of e is (M e)ᵀ (M + A)^-1 M e.
  Errors of_start(const SurfaceSpace& space, const Field& theta) const {
    SpdSolver spd(space.pattern());
    Field e = theta, dual = theta;
    spd.factorise(1, M_, 0, A_);
    spd.solve(e);
    spd.factorise(1, M_, 1, A_);
    spd.solve(dual);
    Errors errors;
    raise_maxima({space, {{"V_initial", 1}, {"z_initial", 3}}}, "nodal", nodal_norms(M_, A_, e), errors);
    const Eigen::VectorXd squares = theta.cwiseProduct(dual).colwise().sum();
    errors["V_initial"]["nodal_dual"] = std::sqrt(std::max(0.0, squares[0]));
    errors["z_initial"]["nodal_dual"] = std::sqrt(std::max(0.0, squares.tail(3).sum()));
    return errors;
  }

 private:
  Quantities quantities_;
  Field exact_;
  SymmetricMatrix M_, A_;
  Errors maxima_;
};

}  // namespace

WillmoreFlow::Variant::Projection projection_of(const std::string& name) {
  static const std::map<std::string, WillmoreFlow::Variant::Projection> projections = {
      {"none", WillmoreFlow::Variant::none},
      {"projected", WillmoreFlow::Variant::after_steps},
      {"coefficients", WillmoreFlow::Variant::in_coefficients}};
  return projections.at(name);
}

void run_stationary_willmore(const SurfaceSpace& space, const Mesh& mesh, const ExactEvolution& exact,
                             const StationaryWillmore& setting, double exact_energy,
                             const WillmoreObserver& observe, Row& row) {
  using State = WillmoreFlow::State;
  const WillmoreStart start =
      willmore_start_on(space, exact.surface(0), mesh.nodes, setting.variant.law, true);
  WillmoreFlow flow(space, setting.variant, setting.theta ? start.theta : Field());
  const auto exact_state = [&](double t) {
    State state = start.state;
    state.t = t;
    return state;
  };
  ErrorRecorder errors(space, exact, mesh.nodes);
  VelocityErrors velocity_errors(space, start.state);
  State last;
  const auto record = [&](int, const State& state) {
    errors.record(state);
    velocity_errors.record(state);
    if (observe) observe(state);
    last = state;
  };
  try {
    integrate(flow, setting.grid, {exact_state(0), exact_state}, record);
  } catch (const SingularityError& singularity) {
    row.status = singularity.what();
  }
  row.errors = errors.maxima();
  row.errors.insert(velocity_errors.maxima().begin(), velocity_errors.maxima().end());
  row.errors.merge(velocity_errors.of_start(space, start.theta));
  for (const auto& [name, values] : errors.series()) row.series[name] = values;
  record_energies(space, last, exact_energy, row);
  row.errors["energy"]["excess"] = std::abs(row.values["willmore_excess"]);
  row.values["end_time"] = last.t;
}

void record_energies(const SurfaceSpace& space, const WillmoreFlow::State& state, double exact_energy,
                     Row& row) {
  Series energy;
  record_curvature(space, state.x, state.u.col(0), energy);
  DiscreteCurvature curvature(space);
  curvature.compute(state.x);
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(state.x, M, A);
  const Field M_kappa = M * curvature.kappa();
  row.values["willmore_energy"] = energy["willmore_energy"].back();
  row.values["willmore_excess"] = energy["willmore_energy"].back() - exact_energy;
  row.values["kappa_energy"] = 0.5 * curvature.kappa().cwiseProduct(M_kappa).sum();
}

}  // namespace esfem
