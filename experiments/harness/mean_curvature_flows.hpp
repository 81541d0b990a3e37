// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

#include "solver/flows/bgn_flow.hpp"
#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/problems/exact_states.hpp"

namespace esfem {

/// Calls run(flow, exact_state) with the scheme for mean curvature flow that `evolve` calls by this name, and
/// its states of an exact solution in the nodes that start at x0. That of BGN starts from the nodes alone.
template <class Run>
void with_mean_curvature_flow(const std::string& name, const SurfaceSpace& space, const ExactEvolution& exact,
                              const Field& x0, const Run& run) {
  if (name == "mean_curvature")
    return run(MeanCurvatureFlow(space, {}),
               [&](double t) { return exact_mean_curvature_state(exact, x0, t); });
  if (name == "dziuk")
    return run(DziukFlow(space), [&](double t) { return exact_dziuk_state(exact, x0, t); });
  if (name == "bgn") return run(BgnFlow(space), [&](double) { return bgn_state_on(space, x0); });
  throw std::logic_error("no scheme for mean curvature flow is called " + name);
}

}  // namespace esfem
