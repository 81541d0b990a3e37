// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "experiments/evolve/mesh.hpp"

namespace esfem {

/// What "initial" of a configuration names: the surface, nodal values and time that an earlier run has left.
struct Initial {
  std::string file;
  std::string flow;         ///< of the earlier run; "": the file does not say it
  EvolveMesh surface;       ///< with a history: that at the start of the earlier run, without nodal values
  std::optional<double> t;  ///< none: the file does not say it
  /// The states from which the earlier run goes on bit for bit (history.hpp); null: only the newest is known.
  nlohmann::json history;
  /// "surface" and "bdf" of the earlier run, where its history is used and the configuration lacks them.
  nlohmann::json taken_over = nlohmann::json::object();
};

/// Reads it; nothing without this key, nor when it has formulas (formulas.hpp) beside "mesh". The file is a
/// nodal output of evolve (.json), whose history is used if it was made with the same flow, surface, variant,
/// parameters, quadrature, tau and bdf, or any file that read_mesh takes. Throws InputError for a file that
/// is none of these or has another degree, and for a "surface" beside it that is not that of its history.
std::optional<Initial> read_initial(const nlohmann::json& description, const std::string& source);

/// Surface, nodal values and time of a nodal output of evolve. Throws InputError for what is none.
ReadMesh read_nodal_output(const std::string& file);

/// Gives the configuration the times and the history. Its mesh is there already.
void take_initial(Initial initial, EvolveConfig& config);

}  // namespace esfem
