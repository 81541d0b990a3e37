// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/bgn_willmore_flow.hpp"

#include "solver/geometry/discrete_curvature.hpp"
#include "solver/geometry/l2_project.hpp"
#include "solver/geometry/regularity.hpp"

namespace esfem {

WeakWeingarten::WeakWeingarten(const SurfaceSpace& space) : space_(space), spd_(space.pattern()) {}

// nu x grad chi has integral 0 over a closed surface, so that -(nu_j, (grad chi)_i) is symmetric in i and j:
// its symmetric part is taken.
void WeakWeingarten::compute(const Field& x, const Field& H, const SymmetricMatrix& M) {
  const auto integrand = [](const PointData<1>& p, Integrand<6, 6>& load) {
    int k = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j, ++k) {
        load.value[k] = p.u[0] * p.normal[i] * p.normal[j];
        for (Pack& component : load.flux[k]) component = Pack{};
        load.flux[k][i] -= 0.5 * p.normal[j];
        load.flux[k][j] -= 0.5 * p.normal[i];
      }
  };
  space_.assemble_load<1, 6, 6>(x, H, integrand, A_);
  spd_.factorise(1.0, M, 0.0, M);
  spd_.solve(A_);
}

void WeakWeingarten::assemble_Q(const Field& x, const Field& H, Field& out) {
  H_and_A_.resize(x.rows(), 7);
  H_and_A_ << H, A_;
  const auto integrand = [](const PointData<7>& p, Integrand<1, 0>& load) {
    const Pack &H = p.u[0], *A = p.u + 1;
    const Pack A_squared =
        A[0] * A[0] + A[3] * A[3] + A[5] * A[5] + 2.0 * (A[1] * A[1] + A[2] * A[2] + A[4] * A[4]);
    load.value[0] = (A_squared - 0.5 * H * H) * H;
  };
  space_.assemble_load<7, 1, 0>(x, H_and_A_, integrand, out);
}

BgnWillmoreFlow::BgnWillmoreFlow(const SurfaceSpace& space)
    : space_(space), system_(space), weingarten_(space), tau_A_(space.matrix()) {}

void BgnWillmoreFlow::step(const BdfStep<State>& step, State& next) {
  if (step.order != 1) {
    throw InputError(format(
        "BDF order %d: expected 1, the order of the scheme of Barrett, Garcke and Nürnberg", step.order));
  }
  const double tau = step.tau;
  const State& old = step.past(0);
  system_.assemble(space_, old.x);
  weingarten_.compute(old.x, old.H, system_.M());
  weingarten_.assemble_Q(old.x, old.H, tau_Q_);
  tau_Q_ *= tau;
  tau_A_.values = tau * system_.A().values;
  system_.solve(tau_A_, tau_Q_, old.x, next.H, next.v);
  next.v /= tau;
  next.x = old.x + tau * next.v;
  require_regular(space_, next.x, next.H);
}

BgnWillmoreFlow::State bgn_willmore_state_on(const SurfaceSpace& space, const Field& x) {
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  DiscreteCurvature curvature(space);
  curvature.compute(x);
  WeakWeingarten weingarten(space);
  weingarten.compute(x, curvature.H(), M);
  Field load;
  weingarten.assemble_Q(x, curvature.H(), load);
  const Field V = l2_project(M, load - A * curvature.H());
  return {0, x, V.col(0).asDiagonal() * curvature.nu(), curvature.H()};
}

NodalFields nodal_fields(const BgnWillmoreFlow::State& state) {
  return {{"v", state.v}, {"H", state.H}};
}

}  // namespace esfem
