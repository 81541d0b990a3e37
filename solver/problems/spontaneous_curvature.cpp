// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/problems/spontaneous_curvature.hpp"

#include <array>
#include <string>
#include <vector>

namespace esfem {

WillmoreLaw helfrich_law(const Formula& H_0) {
  const std::string axes[] = {"x", "y", "z"};
  std::vector<Formula> formulas = {H_0};
  for (const std::string& axis : axes) formulas.push_back(H_0.derivative(axis));
  for (int i = 0; i < 3; ++i)
    for (int l = 0; l < 3; ++l) formulas.push_back(formulas[1 + i].derivative(axes[l]));
  return [compiled = CompiledFormulas(formulas)](const WillmorePoint& at, Pack& Q) {
    const Pack in[] = {at.x[0], at.x[1], at.x[2], pack(at.t)};
    std::array<Pack, 13> values;  // H_0, its gradient, its second derivatives
    compiled.evaluate(in, values.data());
    const Pack gradient[3] = {values[1], values[2], values[3]};
    const Pack along_nu = dot(at.nu, gradient), difference = at.H - values[0];
    Pack surface_laplacian = -at.H * along_nu;
    for (int i = 0; i < 3; ++i) {
      surface_laplacian += values[4 + 4 * i];
      for (int l = 0; l < 3; ++l) surface_laplacian -= at.nu[i] * values[4 + 3 * i + l] * at.nu[l];
    }
    Q = difference * (at.A_squared - 0.5 * at.H * difference + along_nu) - surface_laplacian;
  };
}

}  // namespace esfem
