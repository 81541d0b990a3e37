// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "experiments/evolve/config.hpp"

namespace esfem {

/// What to tell about the mesh of a file when it has elements thinner than flows let elements become; "" for
/// others, and for a mesh without a source. Such meshes run: what is thin at the start is no singularity.
std::string thin_elements_remark(const Mesh& mesh, const MeshOrigin& origin);

/// evolve looks this often, and at the start and the end, whether nu and H of a flow
/// are still the surface's: a look costs about as much as a step.
constexpr int steps_between_comparisons = 50;

/// Whether nu and H are no longer those of the surface: beyond 25% in H nu - kappa, smoothed, or in the rates
/// of area, or in the energies; 50% in these on P1 surfaces, whose kappa does not converge.
bool have_parted(const EvolveConfig& config, const RunRecorder::CurvatureComparison& found);

/// That nu and H are not those of the surface, with the numbers.
std::string curvature_remark(const RunRecorder::CurvatureComparison& found, double t);

/// In its first step, however small, BGN's scheme moves nodes along the surface until they are spread evenly.
/// That they have slid off its edges meanwhile is said, with what to try, when the step has taken more than
/// 0.5% of the area, and more than three times what mean curvature flow takes; "" otherwise.
std::string sliding_remark(const Series& series);

/// That a surface has shrunk to nothing: `end` is the time at which its area, extrapolated, is zero.
std::string extinction(double end, const Series& series);

// What entries say of what to try when a run has ended at a singularity: keys of the configuration. Of 125
// closed meshes that flows of mean curvature were tried on, each runs with one of these flows.

const std::string even_elements = "even elements (\"remesh\" of a mesh file)";
const std::string resolving_mesh =
    "a mesh that resolves the curvature (a finer one; \"curve\", \"remesh\" of a mesh file)";
std::string linear_elements(const EvolveConfig& config);
std::string smaller_steps(const EvolveConfig& config);
std::string smaller_steps_or_even_elements(const EvolveConfig& config);

/// "reinitialise" of flows that evolve nu and H.
Key reinitialise_key();

}  // namespace esfem
