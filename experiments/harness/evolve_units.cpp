// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/evolve_units.hpp"

#include <algorithm>
#include <cmath>

#include "solver/assembly/size.hpp"

namespace esfem {

void move_near_origin(EvolveConfig& config) {
  if (config.surface) return;
  Field& x = config.mesh.nodes;
  config.origin = far_centre(x, characteristic_length(config.mesh));
  x.rowwise() -= config.origin.transpose();
  config.disturbance_origin = centroid(config.mesh);
}

void scale_defaults(const JsonReader& reader, EvolveConfig& config) {
  const double L = characteristic_length(config.mesh);
  const auto is_default = [&](const char* object, const char* key) {
    return !reader.has(object) || !reader.object(object).contains(key);
  };
  EvolveConfig::Coupled& coupled = config.coupled;
  if (is_default("parameters", "alpha")) coupled.parameters.alpha *= L * L;
  if (is_default("parameters", "gamma")) coupled.kinetics.gamma /= L * L;
  if (is_default("parameters", "delta")) coupled.kinetics.delta /= L;
  if (is_default("parameters", "epsilon")) config.cahn_hilliard.epsilon *= L;
  if (!config.adaptive) return;
  AdaptiveSteps& grid = *config.adaptive;
  if (is_default("adaptive", "first_step")) {
    const bool fourth_order = config.flow == "willmore" || config.flow == "surface_diffusion";
    const int power = fourth_order ? 4 : config.flow == "cahn_hilliard" ? 3 : 2;
    grid.first_step *= std::pow(L, power);
    if (grid.end_time > 0)
      grid.first_step = std::clamp(grid.first_step, 1e-12 * grid.end_time, 0.1 * grid.end_time);
    if (grid.largest_step > 0) grid.first_step = std::min(grid.first_step, grid.largest_step);
  }
  check_steps(grid);
}

}  // namespace esfem
