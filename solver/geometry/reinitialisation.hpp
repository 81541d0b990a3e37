// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <utility>

#include "solver/geometry/discrete_curvature.hpp"
#include "solver/time/history.hpp"

namespace esfem {

/// Recomputes nu and H from the surface for a flow that evolves them: they deviate from the surface where the
/// mesh does not resolve its curvature (creases, noise).
///
/// A step of BDF q sees u = (nu, H) of q states. If only the newest were replaced, by a jump d, the
/// derivative of u in the next step would be wrong by d/tau, whatever tau is. So the states of the history
/// are replaced with it, each by that of its own surface: as x is smooth in time, these are the values of one
/// function of time, u(x(t)), and the next step is consistent of order q.
///
/// Fields says where nu and H are in a State, and computes the other fields that follow from them:
///   nu(State&) -> N x 3, H(State&) -> N x 1, both writable, and complete(State&).
template <class State, class Fields>
class Reinitialisation {
 public:
  /// tolerance: of DiscreteCurvature::distance; 0: nothing is ever replaced. The space must outlive the
  /// object.
  Reinitialisation(const SurfaceSpace& space, double tolerance, Fields fields)
      : tolerance_(tolerance), fields_(std::move(fields)) {
    if (tolerance > 0) curvature_ = std::make_unique<DiscreteCurvature>(space);
  }

  /// Replaces nu and H of a state when they deviate from the surface.
  void apply(State& state) {
    if (curvature_ && has_parted(state)) replace(state);
  }

  /// The same for the newest state, and then for those before it.
  void apply(History<State>& past, State& newest) {
    if (!curvature_ || !has_parted(newest)) return;
    replace(newest);
    for (int j = 0; j < past.size(); ++j) replace(past.back(j));
  }

 private:
  bool has_parted(State& state) {
    curvature_->compute(state.x);
    return curvature_->distance(fields_.nu(state), fields_.H(state)) > tolerance_;
  }

  void replace(State& state) {
    curvature_->compute(state.x);
    fields_.nu(state) = curvature_->nu();
    fields_.H(state) = curvature_->H();
    fields_.complete(state);
  }

  double tolerance_;
  Fields fields_;
  std::unique_ptr<DiscreteCurvature> curvature_;
};

}  // namespace esfem
