// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linalg/elimination_tree.hpp"

#include <algorithm>
#include <numeric>

namespace esfem {
namespace {

/// For each row of the reordered matrix its columns left of the diagonal, compressed.
struct StrictLowerRows {
  std::vector<int> start, column;
};

StrictLowerRows strict_lower_rows(const SparsityPattern& pattern, const std::vector<int>& rank) {
  StrictLowerRows rows;
  rows.start.assign(pattern.size + 1, 0);
  const auto for_each_entry = [&](auto visit) {
    for (int j = 0; j < pattern.size; ++j)
      for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k)
        if (pattern.row[k] != j)
          visit(std::max(rank[pattern.row[k]], rank[j]), std::min(rank[pattern.row[k]], rank[j]));
  };
  for_each_entry([&](int row, int) { ++rows.start[row + 1]; });
  std::partial_sum(rows.start.begin(), rows.start.end(), rows.start.begin());
  rows.column.resize(rows.start.back());
  std::vector<int> next(rows.start.begin(), rows.start.end() - 1);
  for_each_entry([&](int row, int column) { rows.column[next[row]++] = column; });
  return rows;
}

}  // namespace

std::vector<int> ranks(const std::vector<int>& ordering) {
  std::vector<int> rank(ordering.size());
  for (std::size_t k = 0; k < ordering.size(); ++k) rank[ordering[k]] = static_cast<int>(k);
  return rank;
}

EliminationTree elimination_tree(const SparsityPattern& pattern, const std::vector<int>& ordering) {
  const int n = pattern.size;
  const StrictLowerRows rows = strict_lower_rows(pattern, ranks(ordering));
  EliminationTree tree{std::vector<int>(n, -1), std::vector<int>(n, 0)};
  std::vector<int> ancestor(n, -1), visited(n, -1);
  for (int i = 0; i < n; ++i) {
    for (int k = rows.start[i]; k < rows.start[i + 1]; ++k) {
      for (int j = rows.column[k], next; j != -1 && j < i; j = next) {
        next = ancestor[j];
        ancestor[j] = i;  // the path to the root is compressed
        if (next == -1) tree.parent[j] = i;
      }
    }
  }
  // Row i of L is the part of the tree between its columns in the matrix and i.
  for (int i = 0; i < n; ++i) {
    visited[i] = i;
    for (int k = rows.start[i]; k < rows.start[i + 1]; ++k)
      for (int j = rows.column[k]; visited[j] != i; j = tree.parent[j]) {
        visited[j] = i;
        ++tree.below[j];
      }
  }
  return tree;
}

std::vector<int> postorder(const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  // Linked lists of children; filled backwards, so that they ascend.
  std::vector<int> first_child(n + 1, -1), sibling(n, -1);
  for (int j = n - 1; j >= 0; --j) {
    int& first = first_child[parent[j] == -1 ? n : parent[j]];
    sibling[j] = first;
    first = j;
  }
  std::vector<int> order, path;
  order.reserve(n);
  for (int root = first_child[n]; root != -1; root = sibling[root]) {
    path.push_back(root);
    while (!path.empty()) {
      const int j = path.back(), child = first_child[j];
      if (child != -1) {
        first_child[j] = sibling[child];
        path.push_back(child);
      } else {
        order.push_back(j);
        path.pop_back();
      }
    }
  }
  return order;
}

}  // namespace esfem
