// SPDX-License-Identifier: GPL-3.0-or-later
// Runs from a nearly round unit sphere, of which the theory knows how fast it becomes round.
#pragma once

#include "solver/flows/willmore_flow.hpp"
#include "solver/tables/table.hpp"
#include "solver/time/steps.hpp"

namespace esfem {

/// Mean curvature flow by (5.1) from nodes x0 on nearly_round_sphere(): the amplitude of the mode l = 2 as
/// series "t", "amplitude", and its last value over the first one as the value "amplitude_left".
void measure_mean_curvature_decay(const SurfaceSpace& space, const Field& x0, const UniformSteps& steps,
                                  Row& row);

/// Willmore flow or surface diffusion of it: the same series, and the value "decay_rate", behind the initial
/// layer, from t = 0.01 on.
void measure_willmore_decay(const SurfaceSpace& space, const Field& x0, const WillmoreFlow::Variant& variant,
                            bool theta, const UniformSteps& steps, Row& row);

}  // namespace esfem
