// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/bgn_flow.hpp"

#include "solver/geometry/discrete_curvature.hpp"

namespace esfem {

BgnFlow::BgnFlow(const SurfaceSpace& space, const RegularityLimits& limits)
    : space_(space),
      limits_(limits),
      system_(space),
      tau_M_(space.matrix()),
      zero_(Field::Zero(space.dofs(), 1)) {}

void BgnFlow::step(const BdfStep<State>& step, State& next) {
  if (step.order != 1) {
    throw InputError(format(
        "BDF order %d: expected 1, the order of the scheme of Barrett, Garcke and Nürnberg", step.order));
  }
  const double tau = step.tau;
  const Field& x = step.past(0).x;
  system_.assemble(space_, x);
  tau_M_.values = tau * system_.M().values;
  system_.solve(tau_M_, zero_, x, next.H, next.v);
  next.v /= tau;
  next.x = x + tau * next.v;
  require_regular(space_, next.x, next.H, limits_);
}

BgnFlow::State bgn_state_on(const SurfaceSpace& space, const Field& x) {
  DiscreteCurvature curvature(space);
  curvature.compute(x);
  return {0, x, -curvature.kappa(), curvature.H()};
}

NodalFields nodal_fields(const BgnFlow::State& state) {
  return {{"v", state.v}, {"H", state.H}};
}

}  // namespace esfem
