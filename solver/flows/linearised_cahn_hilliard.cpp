// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/linearised_cahn_hilliard.hpp"

#include <cmath>

#include "solver/error.hpp"
#include "solver/geometry/regularity.hpp"

namespace esfem {

LinearisedCahnHilliardScheme::LinearisedCahnHilliardScheme(const SurfaceSpace& space, NodalMotion motion,
                                                           double epsilon)
    : space_(space),
      motion_(std::move(motion)),
      epsilon_(epsilon),
      M_(space.matrix()),
      A_(space.matrix()),
      kappa_M_(space.matrix()),
      B_(space.matrix()),
      block_(space.pattern()) {
  if (!(epsilon > 0) || !std::isfinite(epsilon))
    throw InputError(format("epsilon: found %g, expected a positive number", epsilon));
}

void LinearisedCahnHilliardScheme::prepare(const BdfStep<State>& step, State& next) {
  next.x = motion_(next.t);
  assemble_regular(space_, next.x, M_, A_);
  step.extrapolate(&State::u, next.u);
}

void LinearisedCahnHilliardScheme::advance(const BdfStep<State>& step, const Field& load,
                                           const SymmetricMatrix& W, State& next) {
  // With kappa² = delta_0/(tau epsilon), kappa epsilon u and w have one unit, and both diagonal blocks one
  // size.
  const double kappa = std::sqrt(step.delta[0] / (step.tau * epsilon_));
  kappa_M_.values = kappa * M_.values;
  B_.values = -A_.values - W.values / (epsilon_ * epsilon_);
  // w first: A and B have good pivots on the diagonal, for small steps and for large ones.
  block_.factorise(A_, kappa_M_, B_);
  step.known_sum(&State::Mu, Mu_sum_);
  W.multiply(next.u, Wu_);
  next.w = Mu_sum_ / -step.tau;
  next.u = kappa / epsilon_ * (load - Wu_);
  block_.solve(next.w, next.u);
  next.u /= kappa * epsilon_;
  M_.multiply(next.u, next.Mu);
}

}  // namespace esfem
