// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/sides.hpp"

#include <algorithm>
#include <tuple>

namespace esfem {

namespace {

/// A side, and the corners of its edge.
struct SideOfEdge {
  int low, high, side;
  bool operator<(const SideOfEdge& other) const {
    return std::tie(low, high, side) < std::tie(other.low, other.high, other.side);
  }
};

}  // namespace

std::vector<int> side_twins(const Connectivity& elements) {
  std::vector<SideOfEdge> sides;
  for (int side = 0; side < 3 * elements.rows(); ++side) {
    const auto [low, high] = std::minmax({side_corner(elements, side, 0), side_corner(elements, side, 1)});
    sides.push_back({low, high, side});
  }
  std::sort(sides.begin(), sides.end());

  std::vector<int> twin(sides.size(), crowded_side);
  for (std::size_t k = 0; k < sides.size();) {
    std::size_t end = k;
    while (end < sides.size() && sides[end].low == sides[k].low && sides[end].high == sides[k].high) ++end;
    if (end == k + 1) {
      twin[sides[k].side] = open_side;
    } else if (end == k + 2) {
      twin[sides[k].side] = sides[k + 1].side;
      twin[sides[k + 1].side] = sides[k].side;
    }
    k = end;
  }
  return twin;
}

}  // namespace esfem
