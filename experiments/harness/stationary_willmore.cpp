// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/stationary_willmore.hpp"

#include "solver/analysis/diagnostics.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/error.hpp"
#include "solver/flows/discrete_curvature.hpp"

namespace esfem {

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
  State last;
  const auto record = [&](int, const State& state) {
    errors.record(state.t, table_columns(state));
    if (observe) observe(state);
    last = state;
  };
  try {
    integrate(flow, setting.grid, exact_state(0), exact_state, record);
  } catch (const SingularityError& singularity) {
    row.status = singularity.what();
  }
  row.errors = errors.maxima();
  for (const auto& [name, values] : errors.series()) row.series[name] = values;
  record_energies(space, last, exact_energy, row);
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
