// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/extrapolation.hpp"

#include <algorithm>
#include <cmath>

#include "solver/flows/willmore_terms.hpp"

namespace esfem {

double largest_extrapolated_step(int order, double a) {
  double delta = 0;
  for (int j = 1; j <= order; ++j) delta += std::ldexp(1.0, j) / j;
  return 4 * delta / std::pow((std::ldexp(1.0, order) - 1) * a, 2);
}

double stable_willmore_step(int order, double A_squared) {
  const double factors[] = {2.5, 2.5, 3, 5, 20};
  return largest_extrapolated_step(order, A_squared) / factors[order - 1];
}

double largest_weingarten_squared(const SurfaceSpace& space, const Field& x, const Field& u) {
  double largest = 0;
  const auto look = [&largest](const PointData<4>& p, Integrand<1, 0>& load) {
    const Pack A_squared = willmore_point(p).A_squared;
    for (int i = 0; i < pack_size; ++i) largest = std::max(largest, A_squared[i]);
    load.value[0] = Pack{};
  };
  Field load;
  space.assemble_load<4, 1, 0>(x, u, look, load);
  return largest;
}

}  // namespace esfem
