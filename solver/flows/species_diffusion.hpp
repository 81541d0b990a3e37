// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/linalg/spd_solver.hpp"
#include "solver/types.hpp"

namespace esfem {

/// The systems (a M + D_l A) u_l = b_l of several species; those of one diffusion coefficient share a
/// factorisation and a solve.
class SpeciesDiffusion {
 public:
  /// One coefficient for each species. Throws InputError when one is negative; 0: the species reacts only.
  explicit SpeciesDiffusion(const std::vector<double>& diffusion);

  /// How many there are.
  int species() const { return species_; }
  /// Replaces b (N x species) by u.
  void solve(SpdSolver& spd, double a, const SymmetricMatrix& M, const SymmetricMatrix& A, Field& b);

 private:
  struct EqualDiffusion {
    double D;
    std::vector<int> species;
    Field u;
  };

  int species_;
  std::vector<EqualDiffusion> groups_;
};

}  // namespace esfem
