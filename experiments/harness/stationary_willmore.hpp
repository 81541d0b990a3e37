// SPDX-License-Identifier: GPL-3.0-or-later
// Willmore flow of stationary surfaces: common parts of the experiments of kll21 §7.1.
#pragma once

#include <functional>
#include <string>

#include "solver/flows/willmore_flow.hpp"
#include "solver/mesh/mesh.hpp"
#include "solver/problems/exact_evolution.hpp"
#include "solver/tables/table.hpp"
#include "solver/time/integrate.hpp"

namespace esfem {

/// What --projection of the experiments says: none | projected | coefficients. Throws std::out_of_range.
WillmoreFlow::Variant::Projection projection_of(const std::string& name);

/// How a stationary surface is held still by the discrete flow.
struct StationaryWillmore {
  WillmoreFlow::Variant variant;
  bool theta = false;  ///< with the correction (3.7)
  UniformSteps grid;
};

using WillmoreObserver = std::function<void(const WillmoreFlow::State&)>;

/// Runs from exact values of x, nu, H, V and z, observes each state (unless `observe` is empty), and fills in
/// the row: errors of x, nu and H and their series; nodal errors of v, V and z; those of V and z as (3.5b)
/// gives them at the start, "V_initial" and "z_initial", also in the dual norm of §5.4, "nodal_dual"; the
/// values of `record_energies`, and the error of the energy, "energy", "excess"; "end_time",
/// the time of the last state; the status of a run that ends at a singularity. A NumericsError passes
/// through.
void run_stationary_willmore(const SurfaceSpace& space, const Mesh& mesh, const ExactEvolution& exact,
                             const StationaryWillmore& setting, double exact_energy,
                             const WillmoreObserver& observe, Row& row);

/// Fills in the values "willmore_energy", 1/2 int H_h² over the discrete surface, "willmore_excess", the same
/// minus the exact energy, and "kappa_energy", 1/2 int |kappa|² with kappa = M^-1 A x.
void record_energies(const SurfaceSpace& space, const WillmoreFlow::State& state, double exact_energy,
                     Row& row);

}  // namespace esfem
