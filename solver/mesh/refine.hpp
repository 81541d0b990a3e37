// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/mesh/mesh.hpp"

namespace esfem {

/// A mesh whose elements are cut into 4^times, and where its nodes lie in that which was refined.
struct RefinedMesh {
  Mesh mesh;                                       ///< of the same degree
  std::vector<int> element;                        ///< of the coarse mesh, for each node
  Eigen::Matrix<double, Eigen::Dynamic, 2> place;  ///< reference coordinates in it
};

/// Cuts every element into four, `times` times, on its own P_k map: the refined surface is the same but for
/// round-off. The corners come first, in their order.
RefinedMesh refine(const Mesh& mesh, int times);

/// Nodal values (N x m) on the coarse mesh as nodal values on the refined one.
Field refined_values(const Mesh& mesh, const Field& values, const RefinedMesh& refined);

}  // namespace esfem
