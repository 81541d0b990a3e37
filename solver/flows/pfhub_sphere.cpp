// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/pfhub_sphere.hpp"

#include <cmath>

namespace esfem {

double pfhub_initial_value(const Vec3& x) {
  const double wave = std::cos(0.13 * x[0]) * std::cos(0.087 * x[1]);
  return 0.5 + 0.01 * (std::cos(0.105 * x[0]) * std::cos(0.11 * x[1]) + wave * wave +
                       std::cos(0.025 * x[0] - 0.15 * x[1]) * std::cos(0.07 * x[0] - 0.02 * x[1]));
}

CahnHilliardState pfhub_state(const SurfaceSpace& space, const Field& x) {
  Field c(x.rows(), 1);
  for (int j = 0; j < x.rows(); ++j) c(j) = pfhub_initial_value(x.row(j));
  Field w = cahn_hilliard_w(space, x, c, PfhubSphere::epsilon, load_of_g(space, PfhubSphere(), 0, x, c));
  return cahn_hilliard_state(space, 0, x, std::move(c), std::move(w));
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
