// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/species_diffusion.hpp"

#include <algorithm>
#include <cmath>

#include "solver/error.hpp"

namespace esfem {

SpeciesDiffusion::SpeciesDiffusion(const std::vector<double>& diffusion)
    : species_(static_cast<int>(diffusion.size())) {
  for (int l = 0; l < species_; ++l) {
    const double D = diffusion[l];
    if (!(D >= 0) || !std::isfinite(D))
      throw InputError(
          format("diffusion coefficient %g of species %d: expected a number that is not negative", D, l + 1));
    auto group = std::find_if(groups_.begin(), groups_.end(),
                              [D](const EqualDiffusion& candidate) { return candidate.D == D; });
    if (group == groups_.end()) group = groups_.insert(group, {D, {}, {}});
    group->species.push_back(l);
  }
}

void SpeciesDiffusion::solve(SpdSolver& spd, double a, const SymmetricMatrix& M, const SymmetricMatrix& A,
                             Field& b) {
  for (EqualDiffusion& group : groups_) {
    group.u.resize(b.rows(), group.species.size());
    for (std::size_t c = 0; c < group.species.size(); ++c) group.u.col(c) = b.col(group.species[c]);
    spd.factorise(a, M, group.D, A);
    spd.solve(group.u);
    for (std::size_t c = 0; c < group.species.size(); ++c) b.col(group.species[c]) = group.u.col(c);
  }
}

}  // namespace esfem
