// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/exact.hpp"

#include <utility>
#include <vector>

#include "experiments/evolve/formulas.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/error.hpp"
#include "solver/problems/formula_data.hpp"
#include "solver/problems/formula_evolution.hpp"

namespace esfem {

ExactFormulas::ExactFormulas(const EvolveConfig& config, const SurfaceSpace& space)
    : space_(space),
      where_(config.source + ": exact"),
      x0_(config.mesh.nodes),
      M_(space.matrix()),
      A_(space.matrix()) {
  if (!config.formulas.contains("exact")) return;
  const nlohmann::json& given = config.formulas.at("exact");
  const JsonReader reader(given, where_);
  const FormulaNames names = names_in_space_time(names_of(config));
  std::vector<std::pair<ExactEvolution::Quantity, std::vector<Formula>>> quantities;
  std::vector<Formula> in_nodes;
  for (const auto& item : given.items()) {
    const std::string& name = item.key();
    if (name == "level_set") continue;
    const std::vector<Formula> formulas = item.value().is_array()
                                              ? formulas_in(reader, name, names)
                                              : std::vector<Formula>{formula_in(reader, name, names)};
    quantities.push_back({{name, static_cast<int>(formulas.size())}, formulas});
    exact_.quantities.push_back(quantities.back().first);
    if (name != "x")
      in_nodes.insert(in_nodes.end(), formulas.begin(), formulas.end());
    else if (formulas.size() == 3)
      exact_.trajectories = [compiled = CompiledFormulas(formulas)](const Field& x0, double t) {
        return esfem::nodal_values(compiled, x0, t);
      };
    else
      throw InputError(where_ + format(": x: found %zu formulas; expected 3", formulas.size()));
  }
  nodal_ = CompiledFormulas(in_nodes);
  exact_.fields = formula_fields(quantities);
  quantities_.emplace(space, exact_.quantities);
  find_exact_surface(config);
}

void ExactFormulas::find_exact_surface(const EvolveConfig& config) {
  const FormulaNames names = names_in_space_time(names_of(config));
  const auto take = [&](const char* key) {
    if (!config.formulas.contains(key)) return false;
    const nlohmann::json& given = config.formulas.at(key);
    if (!given.is_object() || !given.contains("level_set")) return false;
    const JsonReader reader(given, config.source + ": " + key);
    exact_.surface = formula_level_set(formula_in(reader, "level_set", names), space_.length());
    return true;
  };
  if (take("exact") || take("velocity")) {
    largest_distance_ = mesh_quality(space_.elements(), x0_).h;
    const double start = config.adaptive ? config.adaptive->start_time : config.grid.start_time;
    if (config.formulas.at("exact").contains("level_set"))
      compare_with_nodes(exact_.surface(start), config.mesh, start, where_);
    return;
  }
  if (is_at_rest(config) && config.surface)
    exact_.surface = [surface = *config.surface](double) { return surface; };
}

void ExactFormulas::warn_of_distance(double t, const Field& x) {
  if (!largest_distance_) return;
  const double h = *largest_distance_;
  const Distance found = farthest_from(exact_.surface(t), x);
  if (found.value <= h) return;
  largest_distance_.reset();
  warn(where_ + format(": at t = %g the nodes have left the exact surface: ", t) + distance_text(found, h) +
       ", and lifted errors mean little");
}

Field ExactFormulas::columns(const Field& x, const NodalFields& fields) const {
  Field result(x.rows(), exact_.components());
  int column = 0;
  for (const auto& [name, components] : exact_.quantities) {
    const Field* values = name == "x" ? &x : find(fields, name);
    if (!values) {
      std::string known = "x";
      for (const NodalField& field : fields) known += ", " + field.name;
      throw InputError(where_ + ": found " + name + "; expected level_set or one of " + known);
    }
    if (values->cols() != components)
      throw InputError(where_ + format(": %s has %td components; found %d formulas", name.c_str(),
                                       values->cols(), components));
    result.middleCols(column, components) = *values;
    column += components;
  }
  return result;
}

void ExactFormulas::record(double t, const Field& x, const NodalFields& fields, Series& series) {
  const Field w = columns(x, fields);
  warn_of_distance(t, x);
  const Field x_star = exact_.trajectories ? exact_.trajectories(x0_, t) : x;
  Field e = w;
  if (nodal_.count() > 0) {
    const Field values = esfem::nodal_values(nodal_, x_star, t);
    int from = 0, to = 0;
    for (const auto& [name, components] : exact_.quantities) {
      if (name != "x") {
        e.middleCols(to, components) -= values.middleCols(from, components);
        from += components;
      }
      to += components;
    }
  }
  if (exact_.trajectories) e.middleCols(exact_.column("x"), 3) -= x_star;

  const auto note = [&](const std::string& quantity, const std::string& norm, double error) {
    series[quantity + "_" + norm].push_back(error);
  };
  Errors maxima;
  space_.assemble(x_star, M_, A_);
  raise_maxima(*quantities_, "nodal", nodal_norms(M_, A_, e), maxima, note);
  if (exact_.surface)
    raise_maxima(*quantities_, "lifted", lifted_errors(space_, x_star, exact_, t, w), maxima, note);
  else
    raise_maxima(*quantities_, "unlifted", unlifted_errors(space_, x_star, exact_, t, w), maxima, note);
}

}  // namespace esfem
