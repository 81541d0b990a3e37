// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/problems/tumour_growth.hpp"

#include "solver/error.hpp"
#include "solver/problems/plane_waves.hpp"

namespace esfem {

TumourGrowth::TumourGrowth(const Kinetics& kinetics) : kinetics_(kinetics) {
  const auto& [a, b, gamma, delta] = kinetics;
  if (!(a > 0 && b > 0 && gamma > 0 && delta > 0)) {
    throw InputError(
        format("tumour growth: found a = %g, b = %g, gamma = %g, delta = %g; expected positive numbers", a, b,
               gamma, delta));
  }
}

Eigen::RowVector2d TumourGrowth::steady_state(const Kinetics& kinetics) {
  const double u1 = kinetics.a + kinetics.b;
  return {u1, kinetics.b / (u1 * u1)};
}

CoupledDiffusionParameters tumour_growth_parameters() {
  CoupledDiffusionParameters parameters;
  parameters.alpha = 1;
  parameters.beta = 0.01;
  parameters.diffusion = {1, 10};
  return parameters;
}

CoupledDiffusionState tumour_growth_state(const SurfaceSpace& space, const Field& x,
                                          const TumourGrowth::Kinetics& kinetics, double disturbance,
                                          unsigned seed, const Vec3& origin) {
  std::mt19937 engine(seed);
  const Eigen::RowVector2d steady = TumourGrowth::steady_state(kinetics);
  Field u = steady.replicate(x.rows(), 1);
  for (int l = 0; l < 2; ++l)
    u.col(l) += disturbance * steady[l] * plane_waves(x, origin, space.length(), engine);
  return coupled_diffusion_state(space, 0, x, Field::Zero(x.rows(), 3), u);
}

}  // namespace esfem
