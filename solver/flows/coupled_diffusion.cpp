// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/coupled_diffusion.hpp"

#include <cmath>

#include "solver/error.hpp"

namespace esfem {

namespace {

void check(const CoupledDiffusionParameters& parameters, int species) {
  if (!(parameters.alpha > 0) || !std::isfinite(parameters.alpha))
    throw InputError(format("alpha = %g: expected a positive number", parameters.alpha));
  if (!(parameters.beta >= 0) || !std::isfinite(parameters.beta))
    throw InputError(format("beta = %g: expected 0 or a positive number", parameters.beta));
  const int count = static_cast<int>(parameters.diffusion.size());
  if (count != species)
    throw InputError(format("%d diffusion coefficients for %d species: expected one each", count, species));
}

}  // namespace

CoupledDiffusionScheme::CoupledDiffusionScheme(const SurfaceSpace& space, int species,
                                               CoupledDiffusionParameters parameters,
                                               CoupledDiffusionVariant variant,
                                               const RegularityLimits& limits)
    : space_(space),
      parameters_((check(parameters, species), std::move(parameters))),
      variant_(variant),
      limits_(limits),
      diffusion_(parameters_.diffusion),
      M_(space.matrix()),
      A_(space.matrix()),
      spd_(space.pattern()) {}

void CoupledDiffusionScheme::extrapolate(const BdfStep<State>& step) {
  step.extrapolate(&State::x, x_tilde_);
  step.extrapolate(&State::u, u_tilde_);
  assemble_regular(space_, x_tilde_, M_, A_);
}

void CoupledDiffusionScheme::advance(const BdfStep<State>& step, const Field& loads, State& next) {
  diffuse(step, loads, next.u);
  require_bounded_u(step.tau, next.u);
  if (variant_.law == CoupledDiffusionVariant::regularised)
    move_regularised(step, loads, next);
  else
    move_dynamic(step, loads, next);
  require_regular(space_, next.x, limits_);

  if (variant_.mass == CoupledDiffusionVariant::reassembled) space_.assemble(next.x, M_, A_);
  M_.multiply(next.u, next.Mu);
  M_.multiply(next.v, next.Mv);
}

void CoupledDiffusionScheme::require_bounded_u(double tau, const Field& u) const {
  try {
    require_bounded("u", x_tilde_, u, limits_);
  } catch (const SingularityError& unbounded) {
    if (parameters_.reaction_rate == 0) throw;
    throw SingularityError(
        format("%s; the reaction is taken explicitly, and its rate times the step size is %g",
               unbounded.what(), parameters_.reaction_rate * tau));
  }
}

// (2.19): (delta_0/tau M(x̃) + D_l A(x̃)) u_l = f_l(x̃, ũ) - 1/tau sum_{j>=1} delta_j (M u_l)^{n-j}
void CoupledDiffusionScheme::diffuse(const BdfStep<State>& step, const Field& loads, Field& u) {
  step.known_sum(&State::Mu, Mu_sum_);
  u = loads.leftCols(u.cols()) - Mu_sum_ / step.tau;
  diffusion_.solve(spd_, step.delta[0] / step.tau, M_, A_, u);
}

// (2.20) with x from (2.21):
//   (M(x̃) + (alpha + beta tau/delta_0) A(x̃)) v = g(x̃, ũ) + beta/delta_0 A(x̃) sum_{j>=1} delta_j x^{n-j}
void CoupledDiffusionScheme::move_regularised(const BdfStep<State>& step, const Field& loads, State& next) {
  const double tau = step.tau, delta_0 = step.delta[0], beta = parameters_.beta / delta_0;
  step.known_sum(&State::x, x_sum_);
  A_.multiply(x_sum_, A_x_sum_);
  next.v = loads.rightCols(3) + beta * A_x_sum_;
  spd_.factorise(1.0, M_, parameters_.alpha + beta * tau, A_);
  spd_.solve(next.v);
  next.x = (tau * next.v - x_sum_) / delta_0;
}

// (delta_0/tau M(x̃) + alpha A(x̃)) v = g(x̃, ũ) - 1/tau sum_{j>=1} delta_j (M v)^{n-j}, and (2.21)
void CoupledDiffusionScheme::move_dynamic(const BdfStep<State>& step, const Field& loads, State& next) {
  const double tau = step.tau, delta_0 = step.delta[0];
  step.known_sum(&State::Mv, Mv_sum_);
  next.v = loads.rightCols(3) - Mv_sum_ / tau;
  spd_.factorise(delta_0 / tau, M_, parameters_.alpha, A_);
  spd_.solve(next.v);
  step.known_sum(&State::x, x_sum_);
  next.x = (tau * next.v - x_sum_) / delta_0;
}

CoupledDiffusionState coupled_diffusion_state(const SurfaceSpace& space, double t, Field x, Field v,
                                              Field u) {
  if (v.rows() != x.rows() || v.cols() != 3)
    throw InputError(format("velocity has %td x %td values; expected %td x 3", v.rows(), v.cols(), x.rows()));
  if (u.rows() != x.rows())
    throw InputError(format("u has values in %td nodes; expected %td", u.rows(), x.rows()));
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  CoupledDiffusionState state;
  state.t = t;
  state.Mu = M * u;
  state.Mv = M * v;
  state.x = std::move(x);
  state.v = std::move(v);
  state.u = std::move(u);
  return state;
}

CoupledKinetics::CoupledKinetics(const SurfaceSpace& space, PointwiseKinetics kinetics,
                                 CoupledDiffusionParameters parameters, CoupledDiffusionVariant variant,
                                 const RegularityLimits& limits)
    : space_(space),
      kinetics_(std::move(kinetics)),
      species_(static_cast<int>(parameters.diffusion.size())),
      scheme_(space, species_, std::move(parameters), variant, limits) {}

void CoupledKinetics::step(const BdfStep<State>& step, State& next) {
  scheme_.extrapolate(step);
  const auto f_and_g_nu = [&](const Pack* point, Pack* values) {
    kinetics_(next.t, point, values);
    const Pack g = values[species_];
    for (int i = 0; i < 3; ++i) values[species_ + i] = g * point[3 + i];
  };
  assemble_pointwise_load(space_, scheme_.x_tilde(), scheme_.u_tilde(), species_ + 3, f_and_g_nu, loads_);
  scheme_.advance(step, loads_, next);
}

std::vector<std::string> concentration_names(int species) {
  if (species == 1) return {"u"};
  std::vector<std::string> names;
  for (int l = 1; l <= species; ++l) names.push_back("u" + std::to_string(l));
  return names;
}

NodalFields concentration_fields(const Field& v, const Field& u) {
  NodalFields fields = {{"v", v}};
  const std::vector<std::string> names = concentration_names(static_cast<int>(u.cols()));
  for (int l = 0; l < u.cols(); ++l) fields.push_back({names[l], u.col(l)});
  return fields;
}

NodalFields nodal_fields(const CoupledDiffusionState& state) {
  return concentration_fields(state.v, state.u);
}

}  // namespace esfem
