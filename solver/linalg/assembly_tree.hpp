// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/assembly/symmetric_matrix.hpp"

namespace esfem {

/// A step of the multifrontal method (Liu, SIAM Review 34, 1992): a dense symmetric matrix of the columns
/// that it eliminates and of all rows below them in L. Counts and places are in nodes.
struct Front {
  int first, columns;        ///< eliminates the columns first .. first + columns of L
  int rows_begin, rows_end;  ///< in AssemblyTree::rows: its rows further below, those of its update matrix
  int entries_begin, entries_end;    ///< in AssemblyTree::entries: what of the matrix is loaded into it
  int children_begin, children_end;  ///< in AssemblyTree::children
  int parent;                        ///< -1 for roots

  int updated() const { return rows_end - rows_begin; }
  int size() const { return columns + updated(); }
};

/// Where an entry of the matrix goes in its front.
struct FrontEntry {
  int entry;        ///< of the SparsityPattern
  int row, column;  ///< in the front, row >= column
  bool transposed;  ///< the order of elimination exchanges row and column
};

/// The symbolic phase: an order of elimination and the fronts, children before parents, in postorder.
struct AssemblyTree {
  std::vector<int> ordering;  ///< the k-th node to eliminate, which is column k of L
  std::vector<Front> fronts;
  std::vector<int> rows;      ///< of update matrices, as columns of L, ascending in each front
  std::vector<int> position;  ///< of each of them in the parent's front
  std::vector<FrontEntry> entries;
  std::vector<int> children;  ///< fronts
};

/// Orders by METIS, finds the supernodes and merges small ones with their parents.
AssemblyTree assembly_tree(const SparsityPattern& pattern);
/// The same in a given order, up to the postordering of the tree.
AssemblyTree assembly_tree(const SparsityPattern& pattern, const std::vector<int>& ordering);

}  // namespace esfem
