// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/stop.hpp"

#include "solver/error.hpp"

namespace esfem {

StopRule::StopRule(const EvolveConfig& config, const SurfaceSpace& space) : config_(config) {
  if (config.stop.area) area_ = space.area(config.mesh.nodes);
}

void StopRule::look_before(const RunRecorder& recorder) {
  if (!config_.stop.speed || !config_.entry->has_given_motion || recorder.empty()) return;
  t_before_ = recorder.newest().t;
  u_before_ = *find(recorder.newest().fields, "u");
}

/// The largest |v| in the nodes; where the motion is given the largest change of u per time.
double StopRule::speed(const RunRecorder::Surface& surface) const {
  if (config_.entry->has_given_motion)
    return (*find(surface.fields, "u") - u_before_).cwiseAbs().maxCoeff() / (surface.t - t_before_);
  return find(surface.fields, "v")->rowwise().norm().maxCoeff();
}

std::string StopRule::reason(const RunRecorder& recorder, int n) const {
  const auto& stop = config_.stop;
  if (n == 0) return "";
  const std::string at = format("at t = %g (step %d)", recorder.newest().t, n);
  if (stop.speed)
    if (const double found = speed(recorder.newest()); found < *stop.speed)
      return format("stationary: the largest %s in the nodes is %.3g, less than %g, ",
                    config_.entry->has_given_motion ? "|du/dt|" : "|v|", found, *stop.speed) +
             at;
  if (stop.area) {
    const double ratio = recorder.series().at("area").back() / area_;
    if (*stop.area < 1 ? ratio <= *stop.area : ratio >= *stop.area)
      return format("area: %.6g times that at the start, %g asked for, ", ratio, *stop.area) + at;
  }
  return "";
}

bool StopRule::is_time_over() const {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started_;
  return config_.stop.seconds && elapsed.count() >= *config_.stop.seconds;
}

}  // namespace esfem
