// SPDX-License-Identifier: GPL-3.0-or-later
// The entry of a flow by kll21 (3.4)-(3.5), with a law of its own.
#pragma once

#include <functional>

#include "experiments/evolve/entry.hpp"
#include "solver/flows/willmore_flow.hpp"

namespace esfem {

/// What distinguishes one of these flows from another.
struct WillmoreProblem {
  WillmoreLaw law;
  AreaAndVolume prescribed = {};
};

/// Everything but name, help, and parameters. Runs start from nu and H, with starts_from_V also from V, z.
Entry willmore_entry(const std::function<WillmoreProblem(const Run&)>& problem, bool starts_from_V = true);

}  // namespace esfem
