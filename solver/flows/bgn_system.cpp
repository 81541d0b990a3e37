// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/bgn_system.hpp"

#include <algorithm>

namespace esfem {

BgnSystem::BgnSystem(const SurfaceSpace& space)
    : length_(space.length()),
      M_(space.matrix()),
      A_(M_),
      N_{M_, M_, M_},
      factor_(*space.pattern(), {-1, -1, -1, 1}),
      solution_(4 * space.dofs(), 1) {}

void BgnSystem::assemble(const SurfaceSpace& space, const Field& x) {
  space.assemble(x, M_, A_);
  const auto normal = [](const PointData<0>& p, Pack* weight) { std::copy_n(p.normal, 3, weight); };
  space.assemble_weighted_masses<0>(x, x, normal, N_);
}

// The unknowns are L H and dx/L, the lines are divided by L³ and L: numbers without units.
void BgnSystem::solve(const SymmetricMatrix& S, const Field& r, const Field& x, Field& H, Field& dx) {
  const double L = length_, per_L2 = 1 / (L * L), per_L4 = per_L2 * per_L2;
  factor_.factorise([&](int k) {
    Eigen::Matrix4d block =
        Eigen::Vector4d(-A_.values[k], -A_.values[k], -A_.values[k], per_L4 * S.values[k]).asDiagonal();
    for (int a = 0; a < 3; ++a) block(a, 3) = block(3, a) = per_L2 * N_[a].values[k];
    return block;
  });
  A_.multiply(x, Ax_);
  for (int j = 0; j < x.rows(); ++j)
    solution_.middleRows<4>(4 * j) << Ax_.row(j).transpose() / L, r(j) * per_L2 / L;
  factor_.solve(solution_);
  H.resize(x.rows(), 1);
  dx.resize(x.rows(), 3);
  for (int j = 0; j < x.rows(); ++j) {
    H(j, 0) = solution_(4 * j + 3) / L;
    dx.row(j) = L * solution_.middleRows<3>(4 * j).transpose();
  }
}

}  // namespace esfem
