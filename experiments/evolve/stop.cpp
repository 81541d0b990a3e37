// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/stop.hpp"

#include <cmath>

#include "solver/error.hpp"

namespace esfem {

StopRule::StopRule(const EvolveConfig& config, const SurfaceSpace& space) : config_(config) {
  if (config.stop.area) area_ = space.area(config.mesh.nodes);
}

namespace {

/// u, or u1, u2, ..
Field concentrations(const RunRecorder::Surface& surface) {
  Field all(surface.x.rows(), 0);
  for (const NodalField& field : surface.fields) {
    if (field.name[0] != 'u') continue;
    all.conservativeResize(Eigen::NoChange, all.cols() + 1);
    all.rightCols(1) = field.values;
  }
  return all;
}

}  // namespace

void StopRule::look_before(const RunRecorder& recorder) {
  if (!config_.stop.speed || !has_given_motion(config_) || recorder.empty()) return;
  t_before_ = recorder.newest().t;
  u_before_ = concentrations(recorder.newest());
}

/// The largest |v| in the nodes; where the motion is given the largest change of u per time.
double StopRule::speed(const RunRecorder::Surface& surface) const {
  if (has_given_motion(config_))
    return (concentrations(surface) - u_before_).cwiseAbs().maxCoeff() / (surface.t - t_before_);
  return find(surface.fields, "v")->rowwise().norm().maxCoeff();
}

std::string StopRule::reason(const RunRecorder& recorder, int n) const {
  const std::string reason = reason_of_step(recorder, n);
  return !reason.empty() && n == 1 ? "in the first step: " + reason : reason;
}

std::string StopRule::reason_of_step(const RunRecorder& recorder, int n) const {
  const auto& stop = config_.stop;
  if (n == 0) return "";
  const std::string at = format("at t = %g (step %d)", recorder.newest().t, n);
  if (stop.speed)
    if (const double found = speed(recorder.newest()); found < *stop.speed)
      return format("stationary: the largest %s in the nodes is %.3g, less than %g, ",
                    has_given_motion(config_) ? "|du/dt|" : "|v|", found, *stop.speed) +
             at;
  if (stop.energy_rate) {
    const std::vector<double>&t = recorder.series().at("t"), &E = recorder.series().at(config_.entry->energy);
    const std::size_t last = t.size() - 1;
    const double rate = (E[last] - E[last - 1]) / (t[last] - t[last - 1]);
    if (std::abs(rate) < *stop.energy_rate)
      return format("stationary: the %s changes by %.3g per time, less than %g, ",
                    config_.entry->energy.c_str(), rate, *stop.energy_rate) +
             at;
  }
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
