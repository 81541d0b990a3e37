// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <functional>

#include "solver/types.hpp"

namespace esfem {

/// Velocities v at time t in the points x of a surface (N x 3 each; v comes with any size).
using Velocity = std::function<void(double t, const Field& x, Field& v)>;

/// Positions of the nodes at a time.
using NodalMotion = std::function<const Field&(double t)>;

/// v = V nu of the level set {d(x, t) = 0}, V = -d_t/|grad d| (bk22 §9): the velocity -d_t grad d/|grad d|².
/// The functor d returns the time derivative and the gradient in space in its last arguments.
Velocity normal_velocity(std::function<void(const Vec3& x, double t, double& d_t, Vec3& gradient)> level_set);

/// Nodes that follow a given velocity: positions at the times n tau by one step of the classical Runge-Kutta
/// method of order 4 each (bk22 §9).
class MovingNodes {
 public:
  /// How many of the newest positions are kept: all of them serve all runs on one mesh.
  /// @{
  static constexpr int newest_few = 8, all = -1;
  /// @}

  /// Throws InputError unless tau is positive.
  MovingNodes(Velocity velocity, Field x0, double tau, int kept = newest_few);

  /// The positions at a time, which must be a multiple of tau (InputError). Positions that are not kept are
  /// recomputed from the start.
  const Field& at(double t);

 private:
  void advance();

  Velocity velocity_;
  Field x0_;
  double tau_;
  int kept_;
  int newest_ = 0;          ///< step of the newest positions
  std::deque<Field> past_;  ///< newest first
  Field stage_, k_[4];      ///< work space
};

}  // namespace esfem
