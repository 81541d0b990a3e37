// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/types.hpp"

namespace esfem {

// Side 3 e + i of element e goes from its corner i to its corner i + 1.

/// The first corner of a side (i = 0) or the second (i = 1).
inline int side_corner(const Connectivity& elements, int side, int i) {
  return elements(side / 3, (side + i) % 3);
}
/// The side before this one in the same element, and the one after it.
/// @{
inline int side_before(int side) {
  return side / 3 * 3 + (side + 2) % 3;
}
inline int side_after(int side) {
  return side / 3 * 3 + (side + 1) % 3;
}
/// @}

/// What stands in the place of a twin: no other element has the edge, or two or more others have.
/// @{
constexpr int open_side = -1, crowded_side = -2;
/// @}

/// The other side of each side: of the other element with the same edge, in whichever direction.
std::vector<int> side_twins(const Connectivity& elements);

}  // namespace esfem
