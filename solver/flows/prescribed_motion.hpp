// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <functional>

#include "solver/types.hpp"

namespace esfem {

/// A velocity in space, by which nodes are moved.
using Velocity = std::function<Vec3(const Vec3& x, double t)>;

/// v = V nu of the level set {d(x, t) = 0}, V = -d_t/|grad d| (bk22 §9): the velocity -d_t grad d/|grad d|².
/// The functor d returns the time derivative and the gradient in space in its last arguments.
Velocity normal_velocity(std::function<void(const Vec3& x, double t, double& d_t, Vec3& gradient)> level_set);

/// Nodes that follow a given velocity: positions at the times n tau by one step of the classical Runge-Kutta
/// method of order 4 each (bk22 §9).
class MovingNodes {
 public:
  MovingNodes(Velocity velocity, Field x0, double tau);

  /// The positions at a time, which must be a multiple of tau (InputError). Times of the newest few steps are
  /// kept; earlier ones are computed anew from the start.
  const Field& at(double t);

 private:
  void advance();

  static constexpr int kept = 8;
  Velocity velocity_;
  Field x0_;
  double tau_;
  int newest_ = 0;          ///< step of the newest positions
  std::deque<Field> past_;  ///< newest first
};

}  // namespace esfem
