// SPDX-License-Identifier: GPL-3.0-or-later
// nick18's growing sphere on one mesh.
#pragma once

#include <array>

#include "solver/problems/exact_evolution.hpp"
#include "solver/problems/growing_sphere.hpp"
#include "solver/time/last_state.hpp"

namespace esfem {

/// The flow of the growing sphere, alpha = beta = D = 1.
inline CoupledDiffusion<GrowingSphereProblem> growing_sphere_flow(
    const SurfaceSpace& space, CoupledDiffusionVariant variant,
    GrowingSphereProblem::Coupling coupling = GrowingSphereProblem::additive) {
  const CoupledDiffusionParameters parameters;
  return {space, GrowingSphereProblem(parameters, variant.law, coupling), parameters, variant};
}

inline CoupledDiffusionVariant with_law(CoupledDiffusionVariant::Law law) {
  CoupledDiffusionVariant variant;
  variant.law = law;
  return variant;
}

inline CoupledDiffusionVariant with_mass(CoupledDiffusionVariant::Mass mass) {
  CoupledDiffusionVariant variant;
  variant.mass = mass;
  return variant;
}

/// (2.19)-(2.21) with x̃ and ũ as (2.18) is printed, sum gamma_j x^{n-p+j}: backwards.
class ExtrapolationAsPrinted {
 public:
  using State = CoupledDiffusionState;

  ExtrapolationAsPrinted(const SurfaceSpace& space, const CoupledDiffusionParameters& parameters)
      : space_(space),
        problem_(parameters, CoupledDiffusionVariant::regularised),
        scheme_(space, 1, parameters, {}, {}) {}

  void step(const BdfStep<State>& step, State& next) {
    std::array<const State*, max_bdf_order> oldest_first = {};
    for (int j = 0; j < step.order; ++j) oldest_first[j] = &step.past(step.order - 1 - j);
    scheme_.extrapolate({step.t, step.tau, step.order, bdf_weights(step.order), oldest_first});
    Field loads;
    const auto f_and_g = [&](const PointData<1>& p, Integrand<4, 0>& load) {
      Pack f[1];
      problem_.f(next.t, p, f);
      load.value[0] = f[0];
      const Pack g = problem_.g(next.t, p);
      for (int i = 0; i < 3; ++i) load.value[1 + i] = g * p.normal[i];
    };
    space_.assemble_load<1, 4, 0>(scheme_.x_tilde(), scheme_.u_tilde(), f_and_g, loads);
    scheme_.advance(step, loads, next);
  }

 private:
  const SurfaceSpace& space_;
  GrowingSphereProblem problem_;
  CoupledDiffusionScheme scheme_;
};

/// Runs from exact values with the same time steps.
struct GrowingSphereRuns {
  using State = CoupledDiffusionState;

  const SurfaceSpace& space;
  const Field& x0;
  UniformSteps steps;
  ExactEvolution exact = growing_sphere();

  State exact_state(double t) const { return exact_growing_sphere_state(space, exact, x0, t); }
  StartingValues<State> start() const {
    return {exact_state(0), [this](double t) { return exact_state(t); }};
  }
  State end_of(CoupledDiffusionVariant variant,
               GrowingSphereProblem::Coupling coupling = GrowingSphereProblem::additive) const {
    CoupledDiffusion<GrowingSphereProblem> flow = growing_sphere_flow(space, variant, coupling);
    return last_state(flow, steps, start());
  }
};

}  // namespace esfem
