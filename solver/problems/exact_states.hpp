// SPDX-License-Identifier: GPL-3.0-or-later
// Starting values of flows of mean curvature from exact solutions.
#pragma once

#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/generalised_mean_curvature_flow.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/problems/exact_evolution.hpp"

namespace esfem {

/// The state whose nodal values are an exact solution's with quantities nu and H, in the nodes that start at
/// x0.
MeanCurvatureFlow::State exact_mean_curvature_state(const ExactEvolution& exact, const Field& x0, double t);

/// The state whose nodal values are an exact solution's, in the nodes that start at x0.
DziukFlow::State exact_dziuk_state(const ExactEvolution& exact, const Field& x0, double t);

/// The state whose nodal values are an exact solution's with quantities v, nu and V, in the nodes that start
/// at x0.
GeneralisedMeanCurvatureFlow::State exact_generalised_mean_curvature_state(const ExactEvolution& exact,
                                                                           const Field& x0, double t);

}  // namespace esfem
