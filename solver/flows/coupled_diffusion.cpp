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
                                               const RegularityLimits& limits, VariableLaw law)
    : space_(space),
      parameters_((check(parameters, species), std::move(parameters))),
      variant_(variant),
      limits_(limits),
      law_(std::move(law)),
      diffusion_(parameters_.diffusion),
      M_(space.matrix()),
      A_(space.matrix()),
      spd_(space.pattern()) {
  if (law_.alpha || law_.beta) A_alpha_ = A_beta_ = K_ = space.matrix();
}

void CoupledDiffusionScheme::extrapolate(const BdfStep<State>& step) {
  step.extrapolate(&State::x, x_tilde_);
  step.extrapolate(&State::u, u_tilde_);
  assemble_regular(space_, x_tilde_, M_, A_);
}

void CoupledDiffusionScheme::advance(const BdfStep<State>& step, const Field& loads, State& next) {
  diffuse(step, loads, next.u);
  require_bounded_u(step.tau, next.u);
  if (law_.alpha || law_.beta) find_coefficients(next.t);
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

/// A_alpha, A_beta and the load of grad beta.
void CoupledDiffusionScheme::find_coefficients(double t) {
  const auto weigh = [&](const NodalFunction& function, double constant, const char* name, bool may_vanish,
                         SymmetricMatrix& out) {
    if (!function) {
      out.values = constant * A_.values;
      return;
    }
    function(t, x_tilde_, u_tilde_, coefficient_);
    Eigen::Index node;
    const double least = coefficient_.col(0).minCoeff(&node);
    if (!(may_vanish ? least >= 0 : least > 0))
      throw NumericsError(format("%s is %g at (%g, %g, %g), t = %g: expected %s", name, least,
                                 x_tilde_(node, 0), x_tilde_(node, 1), x_tilde_(node, 2), t,
                                 may_vanish ? "0 or a positive number" : "a positive number"));
    space_.assemble_weighted_stiffness<1>(
        x_tilde_, coefficient_, [](const PointData<1>& p) { return p.u[0]; }, out);
  };
  weigh(law_.alpha, parameters_.alpha, "alpha", false, A_alpha_);
  weigh(law_.beta, parameters_.beta, "beta", true, A_beta_);
  if (!law_.beta) return;
  const auto gradient = [](const PointData<1>& p, Integrand<3, 0>& load) {
    for (int i = 0; i < 3; ++i) load.value[i] = p.grad[0][i];
  };
  space_.assemble_load<1, 3, 0>(x_tilde_, coefficient_, gradient, grad_beta_);
}

// (2.20) with x from (2.21):
//   (M(x̃) + (alpha + beta tau/delta_0) A(x̃)) v = g(x̃, ũ) + beta/delta_0 A(x̃) sum_{j>=1} delta_j x^{n-j}
void CoupledDiffusionScheme::move_regularised(const BdfStep<State>& step, const Field& loads, State& next) {
  const double tau = step.tau, delta_0 = step.delta[0], beta = parameters_.beta / delta_0;
  step.known_sum(&State::x, x_sum_);
  if (law_.alpha || law_.beta) {
    A_beta_.multiply(x_sum_, A_x_sum_);
    next.v = loads.rightCols(3) + A_x_sum_ / delta_0;
    if (law_.beta) next.v -= grad_beta_;
    K_.values = A_alpha_.values + tau / delta_0 * A_beta_.values;
    spd_.factorise(1.0, M_, 1.0, K_);
  } else {
    A_.multiply(x_sum_, A_x_sum_);
    next.v = loads.rightCols(3) + beta * A_x_sum_;
    spd_.factorise(1.0, M_, parameters_.alpha + beta * tau, A_);
  }
  spd_.solve(next.v);
  next.x = (tau * next.v - x_sum_) / delta_0;
}

// (delta_0/tau M(x̃) + alpha A(x̃)) v = g(x̃, ũ) - 1/tau sum_{j>=1} delta_j (M v)^{n-j}, and (2.21)
void CoupledDiffusionScheme::move_dynamic(const BdfStep<State>& step, const Field& loads, State& next) {
  const double tau = step.tau, delta_0 = step.delta[0];
  step.known_sum(&State::Mv, Mv_sum_);
  next.v = loads.rightCols(3) - Mv_sum_ / tau;
  if (law_.alpha)
    spd_.factorise(delta_0 / tau, M_, 1.0, A_alpha_);
  else
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
                                 const RegularityLimits& limits, VariableLaw law, bool with_curvature)
    : space_(space),
      kinetics_(std::move(kinetics)),
      species_(static_cast<int>(parameters.diffusion.size())),
      scheme_(space, species_, std::move(parameters), variant, limits, std::move(law)) {
  if (with_curvature) curvature_.emplace(space);
}

void CoupledKinetics::step(const BdfStep<State>& step, State& next) {
  scheme_.extrapolate(step);
  const auto f_and_g_nu = [&](const Pack* point, Pack* values) {
    kinetics_(next.t, point, values);
    const Pack g = values[species_];
    for (int i = 0; i < 3; ++i) values[species_ + i] = g * point[3 + i];
  };
  const Field* inputs = &scheme_.u_tilde();
  if (curvature_) {
    curvature_->compute(scheme_.x_tilde());
    u_and_H_.resize(space_.dofs(), species_ + 1);
    u_and_H_ << scheme_.u_tilde(), curvature_->H();
    inputs = &u_and_H_;
  }
  assemble_pointwise_load(space_, scheme_.x_tilde(), *inputs, species_ + 3, f_and_g_nu, loads_);
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
