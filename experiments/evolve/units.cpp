// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/units.hpp"

#include <algorithm>
#include <cmath>

#include "solver/assembly/size.hpp"

namespace esfem {

void move_near_origin(EvolveConfig& config) {
  if (config.surface) return;
  Field& x = config.mesh.nodes;
  // Formulas are functions of the file's own coordinates.
  if (config.formulas.empty()) config.origin = far_centre(x, characteristic_length(config.mesh));
  x.rowwise() -= config.origin.transpose();
  config.disturbance_origin = centroid(config.mesh);
  if (config.history.is_object())  // its positions have been moved already
    for (int l = 0; l < 3; ++l) config.origin[l] += config.history.at("origin").at(l).get<double>();
}

void scale_defaults(const JsonReader& reader, EvolveConfig& config) {
  const double L = characteristic_length(config.mesh);
  config.variant.scale_defaults(L);
  config.parameters.scale_defaults(L);
  if (!config.adaptive) return;
  AdaptiveSteps& grid = *config.adaptive;
  if (!reader.object("adaptive").contains("first_step")) {
    grid.first_step *= std::pow(L, config.entry->time_power);
    if (const double span = grid.end_time - grid.start_time; span > 0)
      grid.first_step =
          std::clamp(grid.first_step, 1e-12 * grid.end_time, std::max(1e-12 * grid.end_time, 0.1 * span));
    if (grid.largest_step > 0) grid.first_step = std::min(grid.first_step, grid.largest_step);
  }
  headed(reader.where() + ": adaptive", [&] { check_steps(grid); });
}

}  // namespace esfem
