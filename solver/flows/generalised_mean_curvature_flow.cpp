// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/generalised_mean_curvature_flow.hpp"

#include <cmath>
#include <utility>

#include "solver/error.hpp"
#include "solver/flows/mean_curvature_loads.hpp"

namespace esfem {

PowerLaw::PowerLaw(double power) : power_(power) {
  if (power == 0 || !std::isfinite(power))
    throw InputError(format("power %g of the mean curvature: expected a number other than 0", power));
}

double PowerLaw::V(double H) const {
  if (power_ == 1) return H;
  return power_ > 0 ? std::pow(H, power_) : -std::pow(H, power_);
}

double PowerLaw::H(double V) const {
  if (power_ == 1) return V;
  return std::pow(std::abs(V), 1 / power_);
}

// 1/V' = H^(1-k)/|k|, H = |V|^(1/k).
double PowerLaw::weight(double V) const {
  if (power_ == 1) return 1;
  return std::pow(std::abs(V), 1 / power_ - 1) / std::abs(power_);
}

GeneralisedMeanCurvatureFlow::GeneralisedMeanCurvatureFlow(const SurfaceSpace& space, PowerLaw law,
                                                           Velocity velocity, const RegularityLimits& limits,
                                                           Tangential tangential)
    : space_(space),
      law_(law),
      velocity_(velocity),
      limits_(limits),
      mass_factor_(1 / (space.length() * space.length())),
      M_(space.matrix()),
      A_(space.matrix()),
      D_(space.matrix()),
      spd_(space.pattern()) {
  if (tangential == MeanCurvatureFlow::Variant::minimal_deformation)
    deformation_ = std::make_unique<MinimalDeformation>(space);
}

// w in the quadrature points of V~_h, not interpolated: where w varies much its interpolation is worse.
void GeneralisedMeanCurvatureFlow::assemble_weighted_mass() {
  double beyond = 0;
  bool is_beyond = false;
  const auto weight = [&](const PointData<1>& p) {
    Pack w;
    for (int lane = 0; lane < pack_size; ++lane) {
      const double V = p.u[0][lane];
      if (!law_.has(V) && !is_beyond) is_beyond = true, beyond = V;
      w[lane] = law_.weight(V);
    }
    return w;
  };
  space_.assemble_weighted_mass<1>(x_tilde_, u_tilde_.col(3), weight, D_);
  if (is_beyond)
    throw SingularityError(format(
        "V is %g at a point of the surface, but the law with power %g requires V %s 0: H is not positive "
        "there, or the mesh does not resolve it",
        beyond, law_.power(), law_.power() > 0 ? ">" : "<"));
}

/// K(x~) v = g(x~, u~), the nodal values of -V~ nu~, or the velocity of minimal deformation rate; and f.
void GeneralisedMeanCurvatureFlow::velocity_and_load(Field& v) {
  if (deformation_) {
    deformation_->velocity(x_tilde_, u_tilde_, M_, A_, v);
    u_v_.resize(v.rows(), 7);
    u_v_ << u_tilde_, v;
    const auto weight = [this](const Pack& V) {
      return apply([this](double value) { return law_.weight(value); }, V);
    };
    space_.assemble_load<7, 4, 0>(x_tilde_, u_v_, MovingCurvatureLoad{0, weight}, f_);
    return;
  }
  space_.assemble_load<4, 7, 3>(x_tilde_, u_tilde_, MeanCurvatureLoads{0, mass_factor_}, loads_);
  f_ = loads_.rightCols(4);
  if (velocity_ == MeanCurvatureFlow::Variant::interpolation) {
    v = interpolated_velocity(u_tilde_);
  } else {
    v = loads_.leftCols(3);
    spd_.factorise(mass_factor_, M_, 1.0, A_);
    spd_.solve(v);
  }
}

void GeneralisedMeanCurvatureFlow::step(const BdfStep<State>& step, State& next) {
  const double tau = step.tau, delta_0 = step.delta[0];

  step.extrapolate(&State::x, x_tilde_);
  step.extrapolate(&State::u, u_tilde_);

  assemble_regular(space_, x_tilde_, M_, A_);
  velocity_and_load(next.v);

  // (delta_0/tau D(x~, u~) + A(x~)) u = f(x~, u~) - D(x~, u~) 1/tau sum_{j>=1} delta_j u^{n-j}
  assemble_weighted_mass();
  step.known_sum(&State::u, sum_);
  D_.multiply(sum_, D_sum_);
  next.u = f_ - D_sum_ / tau;
  spd_.factorise(delta_0 / tau, D_, 1.0, A_);
  spd_.solve(next.u);

  // delta_0 x = tau v - sum_{j>=1} delta_j x^{n-j}
  step.known_sum(&State::x, sum_);
  next.x = (tau * next.v - sum_) / delta_0;
  H_ = next.u.col(3).unaryExpr([this](double V) { return law_.H(V); });
  require_regular(space_, next.x, H_, limits_);
  require_normal(next.x, next.u.leftCols(3), limits_);
}

GeneralisedMeanCurvatureFlow::State generalised_mean_curvature_state(const PowerLaw& law, Field x,
                                                                     const Field& nu, const Field& H) {
  for (int j = 0; j < H.rows(); ++j)
    if (law.power() != 1 && !(H(j, 0) > 0))
      throw InputError(format(
          "mean curvature at node %d (counted from 1) is %g; the law with power %g needs a positive one",
          j + 1, H(j, 0), law.power()));
  GeneralisedMeanCurvatureFlow::State state;
  state.u.resize(x.rows(), 4);
  state.u << nu, H.unaryExpr([&law](double value) { return law.V(value); });
  state.v = interpolated_velocity(state.u);
  state.x = std::move(x);
  return state;
}

NodalFields nodal_fields(const GeneralisedMeanCurvatureFlow::State& state) {
  return {{"v", state.v}, {"nu", state.u.leftCols(3)}, {"V", state.u.col(3)}};
}

}  // namespace esfem
