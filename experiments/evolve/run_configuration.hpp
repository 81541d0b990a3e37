// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "experiments/evolve/run_flow.hpp"

namespace esfem {

/// Sees a run that is a part of something else (a cell of a sweep or a study) and its status, when its
/// outputs are written: at the end, or where it has ended early.
using SeeRun = std::function<void(const Run&, const std::string& status)>;

/// Runs a configuration, and writes its outputs; what `evolve CONFIG.json` does. description: what it was
/// read from; origin: provenance. Throws NumericsError, StoppedError or InputError when the run ends early,
/// after what has been computed is written.
///
/// The series of a run that is seen have the errors against the exact solution of its flow, where that is
/// known and the configuration has no formulas "exact"; its checkpoint, which no user has named, is not used
/// when it does not fit, and it says nothing at its end.
void run_configuration(const EvolveConfig& config, const nlohmann::json& description,
                       const nlohmann::json& origin, const SeeRun& see = {});

}  // namespace esfem
