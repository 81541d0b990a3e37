// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas of a configuration.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/evolve/config.hpp"
#include "solver/formulas/formula.hpp"
#include "solver/geometry/prescribed_motion.hpp"
#include "solver/tables/json_reader.hpp"

namespace esfem {

/// The formula under a key: text, or a number. Throws InputError, headed by the reader's `where` and the key.
Formula formula_in(const JsonReader& reader, const std::string& key, const FormulaNames& names);
/// Those of an array. Throws InputError for an empty one.
std::vector<Formula> formulas_in(const JsonReader& reader, const std::string& key, const FormulaNames& names);

/// The parameters and the definitions, as names of formulas.
FormulaNames names_of(const EvolveConfig& config);

/// "initial": values of these fields at t = 0.
FormulaKey initial_key(const std::vector<std::string>& names);
/// JSON Schema of a formula, and of "exact" and "definitions", which any flow takes.
nlohmann::json formula_schema();
nlohmann::json exact_schema();
nlohmann::json definitions_schema();
/// "velocity": a prescribed motion.
FormulaKey velocity_key();

/// Evaluates the formulas of "initial" in the nodes: they are among the configuration's nodal values, in
/// place of those of the mesh file. Throws InputError for sets of names from which the flow does not start.
void take_initial_values(EvolveConfig& config);

/// Nodal values of the fields with these names by the formulas of "exact", a column each; none unless all of
/// them have one.
std::function<Field(const Field& x, double t)> exact_values(const EvolveConfig& config,
                                                            const std::vector<std::string>& names);

/// The velocity that is given under a key; none: the surface is at rest. The space must outlive it, and
/// serves for the normals of one along these; without a space the formulas are only read.
Velocity prescribed_velocity(const EvolveConfig& config, const SurfaceSpace* space,
                             const std::string& key = "velocity");
/// The positions of the nodes that have it, for a run with these steps. Configuration and space must outlive
/// them.
NodalMotion prescribed_motion(const EvolveConfig& config, const SurfaceSpace& space,
                              const UniformSteps& steps);

/// The paragraph of --help.
std::string formulas_help();

}  // namespace esfem
