// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/small_steps.hpp"

#include <algorithm>

#include "solver/analysis/errors.hpp"

namespace esfem {

LargestDifferences::LargestDifferences(const SurfaceSpace& space,
                                       std::vector<ExactEvolution::Quantity> quantities)
    : space_(space), quantities_(std::move(quantities)), M_(space.matrix()), A_(space.matrix()) {}

void LargestDifferences::add(const Field& x, const Field& difference) {
  space_.assemble(x, M_, A_);
  const SquaredNorms norms = nodal_norms(M_, A_, difference);
  int column = 0;
  for (const auto& [quantity, components] : quantities_) {
    // Round-off can make a vanishing eᵀAe negative.
    const double L2 = std::max(0.0, norms.L2.segment(column, components).sum());
    const double H1_semi = std::max(0.0, norms.H1_semi.segment(column, components).sum());
    std::map<std::string, double>& largest = errors_[quantity];
    const auto raise = [](double& most, double squared) { most = std::max(most, std::sqrt(squared)); };
    raise(largest["nodal_L2"], L2);
    raise(largest["nodal_H1"], L2 + H1_semi);
    raise(largest["nodal_H1_semi"], H1_semi);
    column += components;
  }
}

}  // namespace esfem
