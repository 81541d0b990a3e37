// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/problems/power_law_sphere.hpp"

#include <cmath>

#include "solver/error.hpp"
#include "solver/problems/exact_evolution.hpp"

namespace esfem {

ExactEvolution power_law_sphere(double initial_radius, const PowerLaw& law) {
  const double k = law.power();
  const auto radius = [=](double t) {
    if (k == -1) return initial_radius * std::exp(t / 2);
    const double rate = (k > 0 ? -1 : 1) * (k + 1) * std::pow(2, k);
    const double power = std::pow(initial_radius, k + 1) + rate * t;
    if (!(power > 0))
      throw InputError(format("the sphere of radius %g has ceased to exist at t = %g", initial_radius, t));
    return std::pow(power, 1 / (k + 1));
  };
  const auto V = [law](double R) { return law.V(2 / R); };
  return round_sphere(
      radius, [V](double R) { return -V(R); }, "V", V);
}

}  // namespace esfem
