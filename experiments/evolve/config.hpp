// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>

#include "experiments/evolve/entry.hpp"
#include "solver/analysis/run_recorder.hpp"
#include "solver/fe/quadrature.hpp"
#include "solver/mesh/mesh.hpp"
#include "solver/mesh/origin.hpp"
#include "solver/surfaces/surface.hpp"
#include "solver/time/steps.hpp"

namespace esfem {

/// The contents of a CONFIG.json of `evolve`, with the defaults filled in.
struct EvolveConfig {
  const Entry* entry = nullptr;            ///< of flow and problem
  std::optional<Surface> surface;          ///< the exact initial surface, where one is given
  Mesh mesh;                               ///< P_k; on the surface, where there is one
  Vec3 origin = Vec3::Zero();              ///< of the mesh's coordinates in those of its file
  Vec3 disturbance_origin = Vec3::Zero();  ///< of the waves that disturb initial values
  std::vector<std::string> mesh_remarks;   ///< what was changed or chosen when the mesh was made
  NodalFields fields;                      ///< nodal values of the mesh file; nan where it has none
  std::vector<long> node_numbers;          ///< the file's own, of the first nodes; empty: 1, 2, ..
  MeshOrigin mesh_origin;                  ///< names elements as the mesh file does; no source: generated
  UniformSteps grid;
  bool start_given = false;               ///< whether grid.start comes from the file
  std::optional<AdaptiveSteps> adaptive;  ///< instead of `grid`, where the file asks for it
  Quadrature rule;
  Settings variant, parameters;
  std::string initial_file, initial_flow;  ///< of "initial"; empty: the run starts from "mesh"
  nlohmann::json history;  ///< of initial_file (history.hpp), from which the run goes on; null: none
  struct {
    std::optional<double> speed, energy_rate, seconds, area;  ///< see StopRule
  } stop;
  nlohmann::json formulas = nlohmann::json::object();  ///< what is given under the entry's formula keys
  std::set<std::string> initial;                       ///< names in `fields` that "initial" gives
  std::string source;                                  ///< the file, for messages
  std::string nodal = "-", series;  ///< output files; "-" is standard output, empty: not wanted
  bool nodal_has_history = false;
  std::string checkpoint;  ///< a file from which a stopped run resumes; empty: not wanted
  SnapshotPlan snapshots;
  struct {
    std::optional<double> curvature_size, radius_ratio, normal_length;  ///< instead of the defaults
  } limits;                                                             ///< see RegularityLimits
};

/// Whether u alone evolves: the surface moves as given or is at rest.
bool has_given_motion(const EvolveConfig& config);
bool is_at_rest(const EvolveConfig& config);

/// Reads a configuration and makes its mesh. Paths in it are relative to the working directory. Throws
/// InputError, which names `source` and the key, for unknown keys (listing the known ones) and values of the
/// wrong type or range.
EvolveConfig evolve_config(const nlohmann::json& json, const std::string& source);

/// The same without the mesh and what depends on it.
EvolveConfig checked_keys(const nlohmann::json& json, const std::string& source);

/// The keys with their defaults as JSON Schema (draft 2020-12), by which editors complete and check a
/// configuration.
nlohmann::json evolve_schema();

}  // namespace esfem
