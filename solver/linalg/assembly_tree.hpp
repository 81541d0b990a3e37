// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/assembly/symmetric_matrix.hpp"

namespace esfem {

/// A step of the multifrontal method (Liu, SIAM Review 34, 1992): a dense symmetric matrix of the columns
/// that it eliminates and of all rows below them in L. Counts and places are in nodes.
struct Front {
  int first;    ///< column of L, the first that it eliminates
  int columns;  ///< how many it eliminates

  /// Range in AssemblyTree::rows: its rows further below, those of its update matrix.
  /// @{
  int rows_begin, rows_end;
  /// @}

  /// Range in AssemblyTree::entries: what of the matrix is loaded into it.
  /// @{
  int entries_begin, entries_end;
  /// @}

  /// Range in AssemblyTree::children.
  /// @{
  int children_begin, children_end;
  /// @}

  int parent;  ///< -1 for roots

  /// The size of the update matrix.
  int updated() const { return rows_end - rows_begin; }
  /// The size of the whole front.
  int size() const { return columns + updated(); }
};

/// Where an entry of the matrix goes in its front.
struct FrontEntry {
  int entry;        ///< of the SparsityPattern
  int row;          ///< in the front, >= column
  int column;       ///< in the front
  bool transposed;  ///< the order of elimination exchanges row and column
};

/// The symbolic phase: an order of elimination and the fronts, children before parents, in postorder.
struct AssemblyTree {
  std::vector<int> ordering;        ///< the k-th node to eliminate, which is column k of L
  std::vector<Front> fronts;        ///< in postorder: parents have larger numbers
  std::vector<int> rows;            ///< of update matrices, as columns of L, ascending in each front
  std::vector<int> position;        ///< of each of them in the parent's front
  std::vector<FrontEntry> entries;  ///< front by front; each of the pattern once
  std::vector<int> children;        ///< fronts
};

/// Orders by METIS, finds the supernodes and merges small ones with their parents.
AssemblyTree assembly_tree(const SparsityPattern& pattern);
/// The same in a given order, up to the postordering of the tree.
AssemblyTree assembly_tree(const SparsityPattern& pattern, const std::vector<int>& ordering);

}  // namespace esfem
