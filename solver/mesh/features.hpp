// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/mesh/mesh.hpp"

namespace esfem {

/// Largest angle between the normals of two triangles, in degrees, across which a surface counts as smooth.
constexpr double default_feature_angle = 40;

/// A closed triangulation cut open along its sharp edges; sides are numbered as in sides.hpp.
struct Features {
  std::vector<int> twin;    ///< the other side of each side
  std::vector<bool> sharp;  ///< whether the normals on both sides differ by more than the angle

  /// The sector of its first corner that a side belongs to, a number from 0 on: triangles around a corner are
  /// in one sector when they are neighbours across edges that are not sharp.
  std::vector<int> sector;
  int sectors = 0;      ///< how many there are, at least one a corner
  int sharp_edges = 0;  ///< of two sharp sides each

  /// The sharp side that continues a sharp one at its end, if exactly two sharp edges meet there and turn by
  /// no more than the angle. -1: none, the feature ends or has a corner there.
  std::vector<int> next_sharp;
};

/// Of a closed mesh of degree 1. Throws InputError unless 0 < angle <= 180.
Features find_features(const Mesh& mesh, double angle);

/// The same surface with other sharp edges, which turn by no more than `angle` where they continue.
Features features_along(const Mesh& mesh, const std::vector<int>& twin, const std::vector<bool>& sharp,
                        double angle);

}  // namespace esfem
