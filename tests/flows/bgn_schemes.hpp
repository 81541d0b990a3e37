// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ostream>

#include "solver/fe/quadrature.hpp"

namespace esfem {

/// The discretisations in space of Barrett, Garcke and Nürnberg's schemes: as in their papers (P1 with the
/// rule of the vertices), and P1 and P2 with consistent mass matrices.
struct BgnScheme {
  const char* name;
  int degree;
  Quadrature rule;
};
inline std::ostream& operator<<(std::ostream& out, const BgnScheme& scheme) {
  return out << scheme.name;
}
inline const BgnScheme lumped = {"LumpedP1", 1, vertex_quadrature()},
                       consistent = {"P1", 1, default_quadrature(1)},
                       quadratic = {"P2", 2, default_quadrature(2)};

}  // namespace esfem
