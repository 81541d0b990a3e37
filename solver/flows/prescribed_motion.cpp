// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/prescribed_motion.hpp"

#include <cmath>

#include "solver/error.hpp"

namespace esfem {

Velocity normal_velocity(std::function<void(const Vec3&, double, double&, Vec3&)> level_set) {
  return [level_set = std::move(level_set)](const Vec3& x, double t) -> Vec3 {
    double d_t = 0;
    Vec3 gradient;
    level_set(x, t, d_t, gradient);
    return -d_t / gradient.squaredNorm() * gradient;
  };
}

MovingNodes::MovingNodes(Velocity velocity, Field x0, double tau)
    : velocity_(std::move(velocity)), x0_(std::move(x0)), tau_(tau), past_{x0_} {
  if (!(tau > 0))
    throw InputError(format("motion of the nodes: found step size %g, expected a positive one", tau));
}

void MovingNodes::advance() {
  const double t = newest_ * tau_, half = tau_ / 2;
  Field next = past_.front();
  for (int j = 0; j < next.rows(); ++j) {
    const Vec3 x = next.row(j);
    const Vec3 k1 = velocity_(x, t);
    const Vec3 k2 = velocity_(x + half * k1, t + half);
    const Vec3 k3 = velocity_(x + half * k2, t + half);
    const Vec3 k4 = velocity_(x + tau_ * k3, t + tau_);
    next.row(j) = x + tau_ / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  past_.push_front(std::move(next));
  if (past_.size() > kept) past_.pop_back();
  ++newest_;
}

const Field& MovingNodes::at(double t) {
  const int n = static_cast<int>(std::lround(t / tau_));
  if (n < 0 || std::abs(n * tau_ - t) > 1e-9 * std::max(tau_, std::abs(t)))
    throw InputError(format("motion of the nodes: found t = %.17g, expected a multiple of %g", t, tau_));
  if (newest_ - n >= static_cast<int>(past_.size())) {
    past_ = {x0_};
    newest_ = 0;
  }
  while (newest_ < n) advance();
  return past_[newest_ - n];
}

}  // namespace esfem
