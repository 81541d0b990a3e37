// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/dziuk_flow.hpp"

#include "solver/error.hpp"
#include "solver/geometry/discrete_curvature.hpp"

namespace esfem {

DziukFlow::DziukFlow(const SurfaceSpace& space, const RegularityLimits& limits)
    : space_(space), limits_(limits), M_(space.matrix()), A_(space.matrix()), spd_(space.pattern()) {}

void DziukFlow::step(const BdfStep<State>& step, State& next) {
  const double tau = step.tau, delta_0 = step.delta[0];

  // (5.2)
  step.extrapolate(&State::x, x_tilde_);
  assemble_regular(space_, x_tilde_, M_, A_);

  // (3.6) with BDF: (delta_0/tau M(x̃) + A(x̃)) x = -M(x̃) 1/tau sum_{j>=1} delta_j x^{n-j}
  step.known_sum(&State::x, sum_);
  M_.multiply(sum_, next.x);
  next.x /= -tau;
  spd_.factorise(delta_0 / tau, M_, 1.0, A_);
  spd_.solve(next.x);

  next.v = (delta_0 * next.x + sum_) / tau;
  require_regular(space_, next.x, next.v, limits_);
}

std::string dziuk_warning(int q) {
  return q > 3 ? format("Dziuk's scheme is unstable with BDF%d: expected BDF1 to BDF3", q) : "";
}

DziukFlow::State dziuk_state_on(const SurfaceSpace& space, const Field& x) {
  DiscreteCurvature curvature(space);
  curvature.compute(x);
  return {0, x, -curvature.kappa()};
}

NodalFields nodal_fields(const DziukFlow::State& state) {
  return {{"v", state.v}};
}

}  // namespace esfem
