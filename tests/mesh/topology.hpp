// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <set>
#include <utility>

#include "solver/mesh/mesh.hpp"

namespace esfem {

/// Volume inside the corner triangles, negative when they point inward.
inline double enclosed_volume(const Mesh& mesh) {
  double volume = 0;
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    const Vec3 a = mesh.nodes.row(mesh.elements(e, 0)), b = mesh.nodes.row(mesh.elements(e, 1)),
               c = mesh.nodes.row(mesh.elements(e, 2));
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

/// Every directed edge occurs once and so does its reverse.
inline bool closed_and_oriented(const Mesh& mesh) {
  std::set<std::pair<int, int>> edges;
  for (int e = 0; e < mesh.elements.rows(); ++e)
    for (int i = 0; i < 3; ++i)
      if (!edges.insert({mesh.elements(e, i), mesh.elements(e, (i + 1) % 3)}).second) return false;
  for (const auto& [a, b] : edges)
    if (!edges.count({b, a})) return false;
  return true;
}

}  // namespace esfem
