// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/cahn_hilliard.hpp"

#include <cmath>

#include "solver/error.hpp"
#include "solver/geometry/l2_project.hpp"

namespace esfem {

CahnHilliardScheme::CahnHilliardScheme(const SurfaceSpace& space, NodalMotion motion, double epsilon,
                                       Field theta, Velocity tangential, Mobility mobility,
                                       const RegularityLimits& limits)
    : space_(space),
      motion_(std::move(motion)),
      epsilon_(epsilon),
      theta_(std::move(theta)),
      tangential_(std::move(tangential)),
      mobility_(std::move(mobility)),
      limits_(limits),
      M_(space.matrix()),
      A_(space.matrix()) {
  if (!(epsilon > 0) || !std::isfinite(epsilon))
    throw InputError(format("epsilon: found %g, expected a positive number", epsilon));
  if (mobility_.at_points)
    variable_.emplace(space);
  else
    block_.emplace(space.pattern());
}

CahnHilliardScheme::VariableMobility::VariableMobility(const SurfaceSpace& space)
    : A_m(space.matrix()), P(space.matrix()), Q(space.matrix()), block(space.pattern()) {}

void CahnHilliardScheme::prepare(const BdfStep<State>& step, State& next) {
  next.x = motion_(next.t);
  assemble_regular(space_, next.x, M_, A_);
  step.extrapolate(&State::u, u_tilde_);
}

void CahnHilliardScheme::add_advection(const State& at, Field& load_of_u) {
  tangential_(at.t, at.x, W_);
  u_and_W_.resize(at.x.rows(), 4);
  u_and_W_ << u_tilde_, W_;
  const auto minus_u_W = [](const PointData<4>& p, Integrand<1, 1>& load) {
    load.value[0] = Pack{};
    for (int l = 0; l < 3; ++l) load.flux[0][l] = -p.u[0] * p.u[1 + l];
  };
  space_.assemble_load<4, 1, 1>(at.x, u_and_W_, minus_u_W, advection_);
  load_of_u += advection_;
}

void CahnHilliardScheme::advance(const BdfStep<State>& step, const Field& loads, const Field& b,
                                 State& next) {
  // The block solver's second unknown is -w.
  step.known_sum(&State::Mu, Mu_sum_);
  next.u = loads.col(0) - Mu_sum_ / step.tau;
  if (b.size() > 0) {
    M_.multiply(b, Mb_);
    next.u += Mb_;
  }
  if (tangential_) add_advection(next, next.u);
  next.w = loads.col(1) / -epsilon_;
  if (theta_.size() > 0) next.w -= theta_;
  if (variable_)
    solve_with_variable_mobility(step.delta[0] / step.tau, next);
  else
    solve(step.delta[0] / step.tau, next);
  require_bounded("u", next.x, next.u, limits_);
  M_.multiply(next.u, next.Mu);
}

void CahnHilliardScheme::solve(double a, State& next) {
  const double m = mobility_.in_time ? mobility_.in_time(next.t) : 1.0;
  block_->factorise(a, m, epsilon_, M_, A_);
  block_->solve(next.u, next.w);
  next.w *= -1.0;
}

void CahnHilliardScheme::solve_with_variable_mobility(double a, State& next) {
  auto& [A_m, P, Q, block] = *variable_;
  const auto m = [&](const PointData<1>& p) {
    Pack value;
    mobility_.at_points(next.t, p, value);
    return value;
  };
  space_.assemble_weighted_stiffness<1>(next.x, u_tilde_, m, A_m);
  const double mean = A_m.trace() / A_.trace();
  const double c = std::sqrt(a * epsilon_ / (mean > 0 ? mean : 1));
  P.values = -(a * epsilon_ / (c * c)) * A_.values;
  Q.values = (a / c) * M_.values;
  block.factorise(P, Q, A_m);
  next.w *= -a / c;
  block.solve(next.w, next.u);
  std::swap(next.w, next.u);
  next.u /= c;
}

CahnHilliardState cahn_hilliard_state(const SurfaceSpace& space, double t, Field x, Field u, Field w) {
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  CahnHilliardState state;
  state.t = t;
  state.Mu = M * u;
  state.x = std::move(x);
  state.u = std::move(u);
  state.w = std::move(w);
  return state;
}

Field cahn_hilliard_theta(const SurfaceSpace& space, const Field& x, const Field& u, const Field& w,
                          double epsilon, const Field& load_of_g) {
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  return M * w - epsilon * (A * u) - load_of_g / epsilon;
}

Field cahn_hilliard_w(const SurfaceSpace& space, const Field& x, const Field& u, double epsilon,
                      const Field& load_of_g) {
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  return l2_project(M, epsilon * (A * u) + load_of_g / epsilon);
}

double ginzburg_landau_energy(const SurfaceSpace& space, const Field& x, const Field& u, double epsilon) {
  const auto density = [epsilon](const PointData<1>& p, Integrand<1, 0>& load) {
    const Pack well = p.u[0] * p.u[0] - 1.0;
    load.value[0] = epsilon / 2 * dot(p.grad[0], p.grad[0]) + well * well / (4 * epsilon);
  };
  Field load;
  space.assemble_load<1, 1, 0>(x, u, density, load);
  return load.sum();  // the shape functions sum to 1
}

NodalFields nodal_fields(const CahnHilliardState& state) {
  return {{"u", state.u}, {"w", state.w}};
}

}  // namespace esfem
