// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/reaction_diffusion.hpp"

#include "solver/error.hpp"

namespace esfem {

ReactionDiffusion::ReactionDiffusion(const SurfaceSpace& space, PointwiseKinetics kinetics,
                                     const std::vector<double>& diffusion, NodalMotion x, Velocity v,
                                     const RegularityLimits& limits)
    : space_(space),
      kinetics_(std::move(kinetics)),
      diffusion_(diffusion),
      x_(std::move(x)),
      v_(std::move(v)),
      limits_(limits),
      M_(space.matrix()),
      A_(space.matrix()),
      spd_(space.pattern()) {}

void ReactionDiffusion::move(double t, State& state) {
  state.x = x_(t);
  if (v_)
    v_(t, state.x, state.v);
  else
    state.v.setZero(state.x.rows(), 3);
  assemble_regular(space_, state.x, M_, A_);
}

void ReactionDiffusion::step(const BdfStep<State>& step, State& next) {
  move(next.t, next);
  step.extrapolate(&State::u, u_tilde_);
  const auto f = [&](const Pack* point, Pack* values) { kinetics_(next.t, point, values); };
  assemble_pointwise_load(space_, next.x, u_tilde_, diffusion_.species(), f, loads_);
  step.known_sum(&State::Mu, Mu_sum_);
  next.u = loads_ - Mu_sum_ / step.tau;
  diffusion_.solve(spd_, step.delta[0] / step.tau, M_, A_, next.u);
  require_bounded("u", next.x, next.u, limits_);
  M_.multiply(next.u, next.Mu);
}

ReactionDiffusionState ReactionDiffusion::state(double t, Field u) {
  if (u.rows() != space_.dofs() || u.cols() != diffusion_.species())
    throw InputError(
        format("u is %td x %td; expected %d x %d", u.rows(), u.cols(), space_.dofs(), diffusion_.species()));
  State state;
  state.t = t;
  move(t, state);
  state.Mu = M_ * u;
  state.u = std::move(u);
  return state;
}

NodalFields nodal_fields(const ReactionDiffusionState& state) {
  return concentration_fields(state.v, state.u);
}

}  // namespace esfem
