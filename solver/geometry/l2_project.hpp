// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/linalg/spd_solver.hpp"

namespace esfem {

/// The L2 projection onto S_h[x]: M(x)^-1 times a load, int f phi_j (N x c). Costs a symbolic phase: for a
/// projection in each step keep an SpdSolver.
inline Field l2_project(const SymmetricMatrix& M, Field load) {
  SpdSolver spd(M.pattern);
  spd.factorise(1.0, M, 0.0, M);
  spd.solve(load);
  return load;
}

}  // namespace esfem
