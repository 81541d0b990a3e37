// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "experiments/evolve/config.hpp"
#include "solver/flows/mean_curvature_flow.hpp"

namespace esfem {

/// The sets of nodal values that the runs of a configuration can start from.
std::vector<std::vector<std::string>> starts_of(const EvolveConfig& config);

/// The nodal values of the mesh file under these names, side by side (N x ..), where the run starts from
/// them; else empty: the file does not have them all, the flow does not evolve them, or they come from an
/// exact surface. Throws InputError for values that are not finite, have other than the flow's number of
/// components, and normals that do not belong to the surface.
Field start_values(const EvolveConfig& config, const std::vector<std::string>& names);

/// nu and H that a run of the mean curvature flows starts from: the mesh file's, else those of the exact
/// surface, else those of the discrete one.
MeanCurvatureFlow::State curvature_at_start(const EvolveConfig& config, const SurfaceSpace& space);

/// Throws InputError, headed by `what`, unless the surface is the unit sphere.
void require_unit_sphere(const EvolveConfig& config, const std::string& what);

/// Throws InputError, headed by `where`, when the flow starts from nodal values that the file of "initial"
/// does not have.
void require_start(const EvolveConfig& config, const std::string& where);

/// That a flow of nu and H computes them at the start from the discrete surface; "" when it does not.
std::string curvature_start_remark(const EvolveConfig& config);

/// Which nodal values of the mesh file the run starts from, and which it does not use; "" without any.
std::string start_remark(const EvolveConfig& config);

}  // namespace esfem
