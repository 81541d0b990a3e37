// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "solver/flows/linearised_cahn_hilliard.hpp"

namespace esfem {

/// Phase separation of a mixture on a stationary surface: the fully implicit Cahn-Hilliard scheme with the
/// double-well potential, for steps of any size. The equation is a gradient flow of the Ginzburg-Landau
/// energy, but a step with tau > 4 epsilon³ or so has several solutions, some of them with a higher energy
/// (for example the uniform state). So a step in which the energy rises, or in which Newton's method does not
/// converge, is replaced by backward Euler steps, as large as possible: their size is halved until the energy
/// decreases, and doubled after each step.
class PhaseSeparation {
 public:
  /// The type of the states.
  using State = CahnHilliardState;

  /// x: nodes at rest. The space must outlive the flow. Throws InputError unless epsilon > 0.
  PhaseSeparation(const SurfaceSpace& space, Field x, double epsilon);
  PhaseSeparation(const PhaseSeparation&) = delete;
  PhaseSeparation& operator=(const PhaseSeparation&) = delete;

  /// One step with BDF of order q, or its replacement: fills all fields of next, whose energy is at most that
  /// of the newest state. Throws NumericsError when the energy rises even in the smallest step.
  void step(const BdfStep<State>& step, State& next);

  /// The number of steps that have been replaced.
  int replaced_steps() const { return replaced_steps_; }

  /// For checkpoints: replaced_steps().
  nlohmann::json progress() const { return replaced_steps_; }
  /// Restores what progress() of an earlier run has returned.
  void resume(const nlohmann::json& saved) { replaced_steps_ = saved.get<int>(); }

 private:
  bool energy_falls(const BdfStep<State>& step, State& next);
  void take_small_steps(const State& start, State& next);

  const SurfaceSpace& space_;
  Field x_;
  double epsilon_;
  LinearisedCahnHilliard<DoubleWell> flow_;
  int replaced_steps_ = 0;
};

}  // namespace esfem
