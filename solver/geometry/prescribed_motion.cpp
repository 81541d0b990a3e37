// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/geometry/prescribed_motion.hpp"

#include <algorithm>
#include <cmath>

#include "solver/error.hpp"

namespace esfem {

Velocity normal_velocity(std::function<void(const Vec3&, double, double&, Vec3&)> level_set) {
  return [level_set = std::move(level_set)](double t, const Field& x, Field& v) {
    v.resize(x.rows(), 3);
    double d_t = 0;
    Vec3 gradient;
    for (int j = 0; j < x.rows(); ++j) {
      level_set(x.row(j), t, d_t, gradient);
      v.row(j) = -d_t / gradient.squaredNorm() * gradient;
    }
  };
}

MovingNodes::MovingNodes(Velocity velocity, Field x0, double tau, int kept)
    : velocity_(std::move(velocity)), x0_(std::move(x0)), tau_(tau), kept_(kept), past_{x0_} {
  if (!(tau > 0))
    throw InputError(format("motion of the nodes: found step size %g, expected a positive one", tau));
}

void MovingNodes::advance() {
  const double t = newest_ * tau_, half = tau_ / 2;
  const Field& x = past_.front();
  velocity_(t, x, k_[0]);
  stage_ = x + half * k_[0];
  velocity_(t + half, stage_, k_[1]);
  stage_ = x + half * k_[1];
  velocity_(t + half, stage_, k_[2]);
  stage_ = x + tau_ * k_[2];
  velocity_(t + tau_, stage_, k_[3]);
  stage_ = x + tau_ / 6 * (k_[0] + 2 * k_[1] + 2 * k_[2] + k_[3]);
  if (kept_ != all && static_cast<int>(past_.size()) == kept_) {
    std::rotate(past_.begin(), past_.end() - 1, past_.end());
    past_.front().swap(stage_);
  } else {
    past_.push_front(stage_);
  }
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
