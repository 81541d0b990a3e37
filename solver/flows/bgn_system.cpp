// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/bgn_system.hpp"

namespace esfem {

BgnSystem::BgnSystem(const SurfaceSpace& space)
    : length_(space.length()),
      M_(space.matrix()),
      A_(M_),
      N_{M_, M_, M_},
      lu_(*space.pattern(), {{0, 1, 2, 3}, {0, 1}, {0, 2}, {0, 3}}),
      right_(4 * space.dofs()),
      solution_(4 * space.dofs()) {}

void BgnSystem::assemble(const SurfaceSpace& space, const Field& x) {
  space.assemble(x, M_, A_);
  for (int a = 0; a < 3; ++a) {
    const auto normal = [a](const PointData<0>& p) { return p.normal[a]; };
    space.assemble_weighted_mass<0>(x, x, normal, N_[a]);
  }
}

// The unknowns are L H and dx/L, the lines are divided by L³ and L: numbers without units.
void BgnSystem::solve(const SymmetricMatrix& S, const Field& r, const Field& x, Field& H, Field& dx) {
  const double L = length_, per_L2 = 1 / (L * L), per_L4 = per_L2 * per_L2;
  lu_.factorise([&](int k, bool, int a, int b) {
    if (a == 0 && b == 0) return per_L4 * S.values[k];
    if (a == 0 || b == 0) return per_L2 * N_[a + b - 1].values[k];
    return -A_.values[k];
  });
  A_.multiply(x, Ax_);
  for (int j = 0; j < x.rows(); ++j)
    right_.segment<4>(4 * j) << r(j) * per_L2 / L, Ax_.row(j).transpose() / L;
  lu_.solve(right_, solution_);
  H.resize(x.rows(), 1);
  dx.resize(x.rows(), 3);
  for (int j = 0; j < x.rows(); ++j) {
    H(j, 0) = solution_[4 * j] / L;
    dx.row(j) = L * solution_.segment<3>(4 * j + 1);
  }
}

}  // namespace esfem
