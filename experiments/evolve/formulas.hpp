// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas of a configuration.
#pragma once

#include <functional>
#include <set>
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

/// The same with the numbers alone that the configuration gives, without defaults, which have units of a
/// surface.
FormulaNames given_names(const EvolveConfig& config);
/// The names in all texts of a JSON value, and of all formulas.
std::set<std::string> names_in(const nlohmann::json& value);
std::set<std::string> names_in_formulas(const EvolveConfig& config);

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
/// How far the farthest of some points is from a level set, |d|/|grad d|, and where it is.
struct Distance {
  double value;
  Vec3 at;
};
Distance farthest_from(const Surface& surface, const Field& x);
/// "the farthest, at (x, y, z), is at a distance of about ..", compared with the longest edge h.
std::string distance_text(const Distance& farthest, double h);
/// Warns, and beyond the longest edge throws InputError, when the nodes are not on a level set that is given
/// for them at this time.
void compare_with_nodes(const Surface& surface, const Mesh& mesh, double t, const std::string& where);

/// The positions of the nodes that have it, for a run with these steps. Configuration and space must outlive
/// them.
NodalMotion prescribed_motion(const EvolveConfig& config, const SurfaceSpace& space,
                              const UniformSteps& steps);

/// The paragraph of --help.
std::string formulas_help();

}  // namespace esfem
