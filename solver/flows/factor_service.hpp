// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

namespace esfem {

/// How long the factors of an earlier step's matrix serve the iterations of later steps.
///
/// With c the cost of a factorisation in iterations and m_j the iterations of step j, a factorisation that
/// serves n steps costs (c + m_1 + .. + m_n) / n a step. That is minimal when a new factorisation is made as
/// soon as m_n exceeds this mean, or after 50 steps. The decision depends on counts alone, not on clocks.
class FactorService {
 public:
  /// `cost`: iterations that take as long as a factorisation.
  explicit FactorService(double cost) : cost_(cost) {}

  /// Is a factorisation due before the next step? At first it is.
  bool is_over() const;
  /// There are new factors.
  void start();
  /// There are none any more: a factorisation begins, which may fail.
  void end() { serves_ = false; }
  /// Are there factors?
  bool serves() const { return serves_; }
  /// They have served a step with so many iterations.
  void add_step(int iterations);

  /// {"steps", "iterations", "newest_iterations"}, for checkpoints.
  nlohmann::json progress() const;
  /// Resumes from there, when there are factors.
  void resume(const nlohmann::json& saved);

 private:
  double cost_;
  bool serves_ = false;
  int steps_ = 0;              ///< that the factors have served
  int iterations_ = 0;         ///< of all these steps
  int newest_iterations_ = 0;  ///< of the last step
};

}  // namespace esfem
