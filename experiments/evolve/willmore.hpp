// SPDX-License-Identifier: GPL-3.0-or-later
// The entry of a flow by kll21 (3.4)-(3.5), with a law of its own.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "experiments/evolve/entry.hpp"
#include "solver/flows/willmore_flow.hpp"

namespace esfem {

/// What distinguishes one of these flows from another.
struct WillmoreProblem {
  WillmoreLaw law;
  AreaAndVolume prescribed = {};
};

/// Defaults of "variant".
struct WillmoreDefaults {
  nlohmann::json project = true;
  nlohmann::json theta = nullptr;  ///< null: on with a "surface"
  nlohmann::json relaxation = 0;   ///< null: 100 (4 pi/area)², or 0.2/tau, the smaller one
};

/// Warns once where equal steps are beyond stable_willmore_step.
void look_at_steps(const Run& run, const WillmoreFlow::State& state);

/// Everything but name, help, and parameters. Runs start from nu and H, with starts_from_V also from V, z.
Entry willmore_entry(const std::function<WillmoreProblem(const Run&)>& problem, bool starts_from_V = true,
                     const WillmoreDefaults& defaults = {});

}  // namespace esfem
