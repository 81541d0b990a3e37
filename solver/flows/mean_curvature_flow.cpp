// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/mean_curvature_flow.hpp"

#include "solver/flows/mean_curvature_loads.hpp"

namespace esfem {

MeanCurvatureFlow::MeanCurvatureFlow(const SurfaceSpace& space, Variant variant,
                                     const RegularityLimits& limits)
    : space_(space),
      variant_(variant),
      limits_(limits),
      mass_factor_(1 / (space.length() * space.length())),
      M_(space.matrix()),
      A_(space.matrix()),
      spd_(space.pattern()),
      reinitialisation_(space, variant.reinitialise, {}) {
  if (variant.tangential == Variant::minimal_deformation)
    deformation_ = std::make_unique<MinimalDeformation>(space);
}

/// g (without tangential motion) and f.
void MeanCurvatureFlow::assemble_loads(const Field& u) {
  space_.assemble_load<4, 7, 3>(x_tilde_, u, MeanCurvatureLoads{variant_.stabilise, mass_factor_}, loads_);
  f_ = loads_.rightCols(4);
}

/// f with the convective term of v.
void MeanCurvatureFlow::assemble_load_along(const Field& v) {
  u_v_.resize(v.rows(), 7);
  u_v_ << u_tilde_, v;
  const auto weight = [](const Pack&) { return 1.0; };
  space_.assemble_load<7, 4, 0>(x_tilde_, u_v_, MovingCurvatureLoad{variant_.stabilise, weight}, f_);
}

/// After assemble_loads(u), unless there is tangential motion.
void MeanCurvatureFlow::velocity(const Field& u, Field& v) {
  if (deformation_) {
    deformation_->velocity(x_tilde_, u, M_, A_, v);
    return;
  }
  if (variant_.velocity == Variant::interpolation) {
    v = interpolated_velocity(u);
    return;
  }
  v = loads_.leftCols(3);
  spd_.factorise(mass_factor_, M_, 1.0, A_);
  spd_.solve(v);
}

void MeanCurvatureFlow::Fields::complete(State& state) const {
  state.v = interpolated_velocity(state.u);
}

void MeanCurvatureFlow::step(const BdfStep<State>& step, State& next) {
  const double tau = step.tau, delta_0 = step.delta[0];

  // (5.2)
  step.extrapolate(&State::x, x_tilde_);
  step.extrapolate(&State::u, u_tilde_);

  assemble_regular(space_, x_tilde_, M_, A_);

  // (5.1), first line: K(x̃) v = g(x̃, ũ)
  const bool u_follows_x = variant_.reinitialise > 0;
  if (!deformation_) assemble_loads(u_tilde_);
  if (deformation_ || !u_follows_x) velocity(u_tilde_, next.v);
  if (deformation_) assemble_load_along(next.v);

  // (5.1), second line: (delta_0/tau M(x̃) + A(x̃)) u = f(x̃, ũ) - M(x̃) 1/tau sum_{j>=1} delta_j u^{n-j}
  step.known_sum(&State::u, sum_);
  M_.multiply(sum_, M_sum_);
  next.u = f_ - M_sum_ / tau;
  spd_.factorise(delta_0 / tau, M_, 1.0, A_);
  spd_.solve(next.u);
  if (variant_.normalise) next.u.leftCols(3).rowwise().normalize();

  // Where ũ comes from the surface, a step with it would be explicit in x, and stable for tau < c h² alone.
  if (u_follows_x) {
    if (!deformation_) assemble_loads(next.u);
    velocity(next.u, next.v);
  }

  // (5.1), third line: delta_0 x = tau v - sum_{j>=1} delta_j x^{n-j}
  step.known_sum(&State::x, sum_);
  next.x = (tau * next.v - sum_) / delta_0;
  require_regular(space_, next.x, next.u.col(3), limits_);
  require_normal(next.x, next.u.leftCols(3), limits_);
}

MeanCurvatureFlow::State mean_curvature_state(double t, Field x, const Field& nu, const Field& H) {
  MeanCurvatureFlow::State state;
  state.t = t;
  state.u.resize(x.rows(), 4);
  state.u << nu, H;
  state.v = interpolated_velocity(state.u);
  state.x = std::move(x);
  return state;
}

MeanCurvatureFlow::State mean_curvature_state_on(const Surface& surface, const Field& x) {
  Field nu(x.rows(), 3), H(x.rows(), 1);
  for (int j = 0; j < x.rows(); ++j) {
    const Surface::Shape shape = surface.shape_at(x.row(j));
    nu.row(j) = shape.normal;
    H(j, 0) = shape.weingarten.trace();
  }
  return mean_curvature_state(0, x, nu, H);
}

MeanCurvatureFlow::State discrete_mean_curvature_state(const SurfaceSpace& space, const Field& x) {
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  SpdSolver spd(space.pattern());
  spd.factorise(1.0, M, 0.0, A);
  const auto normals = [](const PointData<3>& p, Integrand<3, 0>& load) {
    for (int l = 0; l < 3; ++l) load.value[l] = p.normal[l];
  };
  Field nu, H;
  space.assemble_load<3, 3, 0>(x, x, normals, nu);
  spd.solve(nu);
  nu.rowwise().normalize();
  const auto divergence = [](const PointData<3>& p, Integrand<1, 0>& load) {
    load.value[0] = p.grad[0][0] + p.grad[1][1] + p.grad[2][2];
  };
  space.assemble_load<3, 1, 0>(x, nu, divergence, H);
  spd.solve(H);
  return mean_curvature_state(0, x, nu, H);
}

NodalFields nodal_fields(const MeanCurvatureFlow::State& state) {
  return {{"v", state.v}, {"nu", state.u.leftCols(3)}, {"H", state.u.col(3)}};
}

}  // namespace esfem
