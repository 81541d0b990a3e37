// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/phase_separation.hpp"

#include <cmath>

#include "solver/error.hpp"

namespace esfem {

namespace {

/// u lies between about -1 and 1; where a step changes it by more than this, g is linearised again.
constexpr double newton_tolerance = 0.1;

/// Relative rise of the energy in a step that is taken for an error of the time discretisation.
constexpr double harmless_rise = 1e-7;

/// In units of epsilon³: backward Euler has one solution, and its energy falls, up to 4.
constexpr double smallest_step = 1e-3;

}  // namespace

PhaseSeparation::PhaseSeparation(const SurfaceSpace& space, Field x, double epsilon)
    : space_(space),
      x_(std::move(x)),
      epsilon_(epsilon),
      flow_(
          space, DoubleWell(), [this](double) -> const Field& { return x_; }, epsilon, newton_tolerance) {}

void PhaseSeparation::step(const BdfStep<State>& step, State& next) {
  if (energy_falls(step, next)) return;
  take_small_steps(step.past(0), next);
  ++replaced_steps_;
}

bool PhaseSeparation::energy_falls(const BdfStep<State>& step, State& next) {
  try {
    flow_.step(step, next);
  } catch (const SingularityError&) {
    throw;
  } catch (const NumericsError&) {
    return false;
  }
  const double before = ginzburg_landau_energy(space_, x_, step.past(0).u, epsilon_);
  return ginzburg_landau_energy(space_, x_, next.u, epsilon_) <= (1 + harmless_rise) * before;
}

void PhaseSeparation::take_small_steps(const State& start, State& next) {
  const double end = next.t;
  History<State> past(1);
  State first = start;
  past.push(first);
  double tau = (end - start.t) / 2;
  for (;;) {
    const double t = past.back(0).t;
    next.t = tau < (1 - 1e-10) * (end - t) ? t + tau : end;
    tau = next.t - t;
    if (energy_falls(past.equal_step(1, tau, next.t), next)) {
      if (next.t == end) return;
      past.push(next);
      tau *= 2;
    } else if (tau < smallest_step * std::pow(epsilon_, 3)) {
      throw NumericsError(format("the energy rises even in a step of size %g: expected it to decrease", tau));
    } else {
      tau /= 2;
    }
  }
}

}  // namespace esfem
