// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/assembly/symmetric_matrix.hpp"

namespace esfem {

/// The elimination tree of a symmetric pattern in a given order. Columns are numbered by their place in the
/// order.
struct EliminationTree {
  std::vector<int> parent;  ///< first row below the diagonal of L in each column; -1 for roots
  std::vector<int> below;   ///< number of rows below the diagonal of L in each column
};

/// Liu's algorithm 4.2 (SIAM J. Matrix Anal. Appl. 11, 1990). ordering: the k-th node to eliminate is
/// ordering[k].
EliminationTree elimination_tree(const SparsityPattern& pattern, const std::vector<int>& ordering);

/// The nodes of a forest such that each subtree is contiguous and ends with its root; children in ascending
/// order.
std::vector<int> postorder(const std::vector<int>& parent);

/// The inverse of an ordering: rank[ordering[k]] = k.
std::vector<int> ranks(const std::vector<int>& ordering);

}  // namespace esfem
