// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/linalg/assembly_tree.hpp"

namespace esfem {

/// Fronts that can be eliminated in parallel: those of a part depend on no other part; `top` depends on all
/// parts.
struct SplitTree {
  std::vector<std::vector<int>> parts;  ///< in postorder; whole subtrees
  std::vector<int> top;                 ///< in postorder
};

/// Splits the tree into `parts` parts of about the same work; one part is the whole tree.
SplitTree split_tree(const AssemblyTree& tree, int parts);

/// Multiplications of the elimination of a front, in node blocks.
double elimination_work(const Front& front);

}  // namespace esfem
