// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "solver/tables/table.hpp"

namespace esfem {

/// Path of the running executable.
std::string executable_path();

/// Identifies a build of this program: a checksum of the executable.
nlohmann::json build_identity();

/// Where the numbers come from: {"version", "git", "dirty", "compiler", "flags", "cpu", "threads", "date"
/// (UTC, ISO 8601), "command"}. The data of the build are read from provenance.json beside the executable,
/// which every build renews: if the commit were compiled in, each one would relink every executable and
/// outdate every result. "unknown" without that file.
nlohmann::json provenance(int argc, char** argv);

/// The provenance of a table collected from cells: date and command are those of `own`; of everything else
/// the value that all cells share, or the list of the different ones.
nlohmann::json collected_provenance(const std::vector<nlohmann::json>& cells, nlohmann::json own);

}  // namespace esfem
