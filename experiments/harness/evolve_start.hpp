// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/harness/evolve_config.hpp"
#include "solver/flows/cahn_hilliard.hpp"

namespace esfem {

/// The nodal values of the mesh file under these names, side by side (N x ..), where the run starts from
/// them; else empty: the file does not have them all, the flow does not evolve them, or they come from an
/// exact surface. Throws InputError for values that are not finite, have other than the flow's number of
/// components, and normals that do not belong to the surface.
Field start_values(const EvolveConfig& config, const std::vector<std::string>& names);

/// The initial states whose nodal values the mesh file has; none where it does not have them all, see
/// start_values. t = 0. Where V and z (w of phase separation, v of the tumour) are missing they are those
/// that belong to the others (0).
std::optional<MeanCurvatureFlow::State> mean_curvature_state_in_file(const EvolveConfig& config);
std::optional<WillmoreStart> willmore_start_in_file(const EvolveConfig& config, const SurfaceSpace& space);
std::optional<CahnHilliardState> mixture_in_file(const EvolveConfig& config, const SurfaceSpace& space);
std::optional<CoupledDiffusionState> tumour_in_file(const EvolveConfig& config, const SurfaceSpace& space);

/// Which nodal values of the mesh file the run starts from, and which it does not use; "" without any.
std::string start_remark(const EvolveConfig& config);

}  // namespace esfem
