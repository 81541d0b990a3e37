// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "experiments/evolve/config.hpp"

namespace esfem {

/// The remark on the mesh of a file with elements thinner than flows allow them to become; "" for others, and
/// for a mesh without a source. Such meshes run: elements that are thin at the start are no singularity.
std::string thin_elements_remark(const Mesh& mesh, const MeshOrigin& origin);

/// evolve compares nu and H of a flow with the surface this often, and at the start and the end; a comparison
/// costs about as much as a step.
constexpr int steps_between_comparisons = 50;

/// Whether nu and H deviate from those of the surface: by more than 25% in H nu - kappa, smoothed, or in the
/// rates of area, or in the energies; 50% in these on P1 surfaces, whose kappa does not converge.
bool have_parted(const EvolveConfig& config, const RunRecorder::CurvatureComparison& found);

/// The remark that nu and H are not those of the surface, with the numbers.
std::string curvature_remark(const RunRecorder::CurvatureComparison& found, double t);

/// In its first step, however small, BGN's scheme moves nodes along the surface until they are spread evenly.
/// The remark that they have slid off its edges, with advice, when the step has removed more than 0.5% of the
/// area, and more than three times as much as mean curvature flow; "" otherwise.
std::string sliding_remark(const Series& series);

/// The message that a surface has become extinct: `end` is the time at which its area, extrapolated, is zero.
std::string extinction(double end, const Series& series);

/// Where a flow of curvature ends although its curvature has hardly grown: that the mesh may have failed, ""
/// otherwise.
std::string mesh_failure_remark(const EvolveConfig& config, const Series& series);

/// What comes before other advice when a step, one of equal ones, has changed the area by more than 20%, or
/// one is longer than a tenth of what is left of mean curvature flow at most; "" otherwise.
std::string large_step_remark(const EvolveConfig& config, const Series& series);

// Advice of the entries when a run has ended at a singularity: keys of the configuration. Flows of mean
// curvature were tested on 125 closed meshes; each of these runs with one of these flows.

const std::string even_elements = "even elements (\"remesh\" of a mesh file)";
const std::string resolving_mesh =
    "a mesh that resolves the curvature (a finer one; \"curve\", \"remesh\" of a mesh file)";
std::string linear_elements(const EvolveConfig& config);
std::string smaller_steps(const EvolveConfig& config);
std::string smaller_steps_or_even_elements(const EvolveConfig& config);

/// "reinitialise" of flows that evolve nu and H.
Key reinitialise_key();
/// "tangential" of flows whose nodes can move along the surface, too.
Key tangential_key();
/// Throws InputError for a "velocity" beside it, which then is neither of the two that this key offers.
void check_tangential(const EvolveConfig& config, const std::string& source);

}  // namespace esfem
