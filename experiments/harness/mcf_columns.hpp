// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/flows/discrete_curvature.hpp"
#include "solver/flows/mean_curvature_flow.hpp"

namespace esfem {

/// x, v, nu, H side by side (N x 10), the columns of the error tables of mean curvature flow. (5.1) of kll19
/// computes all four.
inline Field mcf_columns(const MeanCurvatureFlow::State& state, DiscreteCurvature&) {
  return table_columns(state);
}

/// Dziuk's scheme and BGN's have x and v; nu and H are those of the discrete surface.
template <class State>
Field mcf_columns(const State& state, DiscreteCurvature& curvature) {
  curvature.compute(state.x);
  Field all(state.x.rows(), 10);
  all << state.x, state.v, curvature.nu(), curvature.H();
  return all;
}

}  // namespace esfem
