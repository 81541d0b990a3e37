// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/factor_service.hpp"

namespace esfem {
namespace {

/// Steps after which newer factors may take fewer iterations although the old ones take no more than at
/// first, because the guesses have become better.
constexpr int longest_service = 50;

}  // namespace

bool FactorService::is_over() const {
  return !serves_ || steps_ == longest_service || newest_iterations_ * steps_ > cost_ + iterations_;
}

void FactorService::start() {
  *this = FactorService(cost_);
  serves_ = true;
}

void FactorService::add_step(int iterations) {
  newest_iterations_ = iterations;
  iterations_ += iterations;
  ++steps_;
}

nlohmann::json FactorService::progress() const {
  return {{"steps", steps_}, {"iterations", iterations_}, {"newest_iterations", newest_iterations_}};
}

void FactorService::resume(const nlohmann::json& saved) {
  steps_ = saved.at("steps").get<int>();
  iterations_ = saved.at("iterations").get<int>();
  newest_iterations_ = saved.at("newest_iterations").get<int>();
}

}  // namespace esfem
