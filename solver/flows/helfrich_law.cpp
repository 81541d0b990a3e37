// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/helfrich_law.hpp"

namespace esfem {

double helfrich_energy(const SurfaceSpace& space, const Field& x, const Field& H, const Field& H_0) {
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  return 0.5 * M.energy(H - H_0);
}

}  // namespace esfem
