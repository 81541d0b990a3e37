// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <string>

#include "experiments/evolve/config.hpp"

namespace esfem {

/// "stop" of a configuration, held against each step of a run.
class StopRule {
 public:
  /// Areas are relative to that of config.mesh, seconds are counted from here on.
  StopRule(const EvolveConfig& config, const SurfaceSpace& space);

  /// Before a step is recorded: keeps what the rate of change of u needs.
  void look_before(const RunRecorder& recorder);
  /// Why the run has come to its end with its newest step n, and that this is its first, which may say
  /// little;
  /// "" when it goes on, and at n = 0.
  std::string reason(const RunRecorder& recorder, int n) const;
  bool is_time_over() const;

 private:
  std::string reason_of_step(const RunRecorder& recorder, int n) const;
  double speed(const RunRecorder::Surface& surface) const;

  const EvolveConfig& config_;
  double area_ = 0;  ///< at the start
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  double t_before_ = 0;
  Field u_before_;
};

}  // namespace esfem
