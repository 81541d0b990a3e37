// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/problems/exact_states.hpp"

namespace esfem {

MeanCurvatureFlow::State exact_mean_curvature_state(const ExactEvolution& exact, const Field& x0, double t) {
  Field x = exact.trajectories(x0, t);
  const Field values = exact.nodal_values(x, t);
  return mean_curvature_state(t, std::move(x), values.middleCols(exact.column("nu"), 3),
                              values.col(exact.column("H")));
}

DziukFlow::State exact_dziuk_state(const ExactEvolution& exact, const Field& x0, double t) {
  const Field x = exact.trajectories(x0, t);
  return {t, x, exact.nodal_values(x, t).middleCols(exact.column("v"), 3)};
}

GeneralisedMeanCurvatureFlow::State exact_generalised_mean_curvature_state(const ExactEvolution& exact,
                                                                           const Field& x0, double t) {
  GeneralisedMeanCurvatureFlow::State state;
  state.t = t;
  state.x = exact.trajectories(x0, t);
  const Field values = exact.nodal_values(state.x, t);
  state.v = values.middleCols(exact.column("v"), 3);
  state.u.resize(x0.rows(), 4);
  state.u << values.middleCols(exact.column("nu"), 3), values.col(exact.column("V"));
  return state;
}

}  // namespace esfem
