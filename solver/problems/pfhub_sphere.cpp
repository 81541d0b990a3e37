// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/problems/pfhub_sphere.hpp"

namespace esfem {

Field pfhub_initial_values(const Field& x) {
  const auto x1 = x.col(0).array(), x2 = x.col(1).array();
  return 0.5 +
         0.01 * ((0.105 * x1).cos() * (0.11 * x2).cos() + ((0.13 * x1).cos() * (0.087 * x2).cos()).square() +
                 (0.025 * x1 - 0.15 * x2).cos() * (0.07 * x1 - 0.02 * x2).cos());
}

CahnHilliardState pfhub_state(const SurfaceSpace& space, const Field& x, const Field& c) {
  return cahn_hilliard_start(space, PfhubSphere(), PfhubSphere::epsilon, 0, x, c);
}

double pfhub_energy(const SurfaceSpace& space, const Field& x, const Field& c) {
  const auto density = [](const PointData<1>& p, Integrand<1, 0>& load) {
    load.value[0] = PfhubSphere::f(p.u[0]) + PfhubSphere::kappa / 2 * dot(p.grad[0], p.grad[0]);
  };
  Field load;
  space.assemble_load<1, 1, 0>(x, c, density, load);
  return load.sum();  // the shape functions sum to 1
}

}  // namespace esfem
