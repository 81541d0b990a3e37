// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/refinement.hpp"

#include <cmath>

#include "solver/error.hpp"
#include "solver/tables/json_reader.hpp"

namespace esfem {
namespace {

using nlohmann::json;

void refine_mesh(json& configuration, int level, const std::string& source) {
  const JsonReader reader(configuration, source);
  if (!reader.has("mesh"))
    throw InputError(source +
                     ": found initial with a file, which cannot be refined; expected mesh, or --levels 0");
  const JsonReader mesh(reader.object("mesh"), source + ": mesh");
  const double factor = std::ldexp(1.0, -level);
  json finer = reader.object("mesh");
  const auto halve = [&](const char* key) { finer[key] = factor * mesh.number(key); };
  if (mesh.has("edge_length")) {
    halve("edge_length");
    if (mesh.has("grading")) halve("grading");
  } else if (mesh.has("subdivisions")) {
    finer["subdivisions"] = mesh.integer("subdivisions") + level;
  } else if (mesh.has("remesh")) {
    halve("remesh");
  } else if (mesh.has("refine")) {
    finer["refine"] = mesh.integer("refine") + level;
  } else {
    throw InputError(
        mesh.where() +
        ": a file is refined only if it says how; expected \"refine\": 0, each level cuts its triangles "
        "into four (with \"curve\": true on the smooth surface, else on the elements of the file), or "
        "\"remesh\": an edge length that each level halves");
  }
  configuration["mesh"] = std::move(finer);
}

void refine_steps(json& configuration, int step, const std::string& source) {
  const JsonReader reader(configuration, source);
  if (reader.has("adaptive"))
    throw InputError(source + ": found adaptive; expected tau and steps, which are refined, or --steps 0");
  const int factor = 1 << step;
  const double steps = double(factor) * reader.integer_within("steps", 0, 0, 100000000);
  if (steps > 100000000)
    throw InputError(source + format(": %g steps with --steps %d, expected at most 1e8", steps, step));
  configuration["tau"] = reader.number("tau") / factor;
  configuration["steps"] = static_cast<int>(steps);
  if (reader.has("output") && reader.object("output").contains("every")) {
    const JsonReader output(reader.object("output"), source + ": output");
    configuration["output"]["every"] = factor * output.integer("every");
  }
}

}  // namespace

json refined_configuration(json configuration, int level, int step, const std::string& source) {
  if (level > 0) refine_mesh(configuration, level, source);
  if (step > 0) refine_steps(configuration, step, source);
  return configuration;
}

}  // namespace esfem
