// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/flows/generalised_mean_curvature_flow.hpp"
#include "solver/problems/exact_evolution.hpp"

namespace esfem {

/// A sphere under v = -V(H) nu: R' = -V(2/R), so that R^(k+1) = R_0^(k+1) -+ (k+1) 2^k t for k > 0 (-) and k
/// < 0
/// (+), and R = R_0 exp(t/2) for k = -1. It exists until it is a point (k > 0), or unbounded (k < -1).
/// Quantities x, v, nu, V.
ExactEvolution power_law_sphere(double initial_radius, const PowerLaw& law);

}  // namespace esfem
