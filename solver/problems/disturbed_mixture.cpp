// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/problems/disturbed_mixture.hpp"

#include "solver/problems/plane_waves.hpp"

namespace esfem {

CahnHilliardState disturbed_mixture(const SurfaceSpace& space, const Field& x, double epsilon, double mean,
                                    double disturbance, unsigned seed, const Vec3& origin) {
  std::mt19937 engine(seed);
  const Field waves = plane_waves(x, origin, space.length(), engine);
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  const Field M_one = M * Field::Ones(x.rows(), 1);
  const double mean_of_waves = waves.cwiseProduct(M_one).sum() / M_one.sum();
  const Field u = mean + disturbance * (waves.array() - mean_of_waves);
  return cahn_hilliard_start(space, DoubleWell(), epsilon, 0, x, u);
}

}  // namespace esfem
