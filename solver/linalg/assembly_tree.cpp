// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linalg/assembly_tree.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "solver/linalg/elimination_tree.hpp"
#include "solver/linalg/metis_ordering.hpp"

namespace esfem {
namespace {

/// Columns of L with one structure, which a front eliminates together.
struct Supernode {
  std::vector<int> columns;
  int updated;   ///< rows below its last column
  int parent;    ///< -1 for roots
  double zeros;  ///< entries that are stored although they vanish
  bool merged;   ///< into its parent

  double size() const { return columns.size(); }
  double entries() const { return size() * (0.5 * (size() + 1) + updated); }
};

/// Maximal runs of columns, each the parent of the one before, in which nothing but the diagonal is lost from
/// column to column.
std::vector<Supernode> fundamental_supernodes(const EliminationTree& tree) {
  std::vector<Supernode> supernodes;
  const int n = static_cast<int>(tree.parent.size());
  std::vector<int> owner(n);
  for (int j = 0; j < n; ++j) {
    if (j == 0 || tree.parent[j - 1] != j || tree.below[j - 1] != tree.below[j] + 1)
      supernodes.push_back({{}, 0, -1, 0, false});
    supernodes.back().columns.push_back(j);
    supernodes.back().updated = tree.below[j];
    owner[j] = static_cast<int>(supernodes.size()) - 1;
  }
  for (Supernode& supernode : supernodes) {
    const int parent = tree.parent[supernode.columns.back()];
    if (parent != -1) supernode.parent = owner[parent];
  }
  return supernodes;
}

/// How much of a merged front may be zeros. Few large fronts are faster than many small ones until their
/// zeros cost more than they save; measured on meshes of 2,500 to 164,000 nodes.
bool is_worth_merging(const Supernode& child, const Supernode& parent, double zeros) {
  const double columns = child.size() + parent.size();
  const double entries = columns * (0.5 * (columns + 1) + parent.updated);
  const double allowed = columns <= 16 ? 0.4 : columns <= 48 ? 0.1 : 0.02;
  return zeros <= allowed * entries;
}

/// Relaxed supernodes: merges children into their parents, from the leaves on. A child's update rows are rows
/// of its parent's front, so that each of its columns gets the rest of them as zeros.
void amalgamate(std::vector<Supernode>& supernodes) {
  std::vector<std::vector<int>> children(supernodes.size());
  for (std::size_t s = 0; s < supernodes.size(); ++s) {
    Supernode& parent = supernodes[s];
    std::vector<int> kept;
    for (const int c : children[s]) {
      Supernode& child = supernodes[c];
      const double missing = parent.size() + parent.updated - child.updated;
      const double zeros = parent.zeros + child.zeros + child.size() * missing;
      if (!is_worth_merging(child, parent, zeros)) continue;
      parent.columns.insert(parent.columns.end(), child.columns.begin(), child.columns.end());
      parent.zeros = zeros;
      child.merged = true;
    }
    std::sort(parent.columns.begin(), parent.columns.end());
    if (parent.parent != -1) children[parent.parent].push_back(static_cast<int>(s));
  }
  for (Supernode& supernode : supernodes)
    while (supernode.parent != -1 && supernodes[supernode.parent].merged)
      supernode.parent = supernodes[supernode.parent].parent;
}

/// Numbers the columns anew, front by front in postorder: first, columns and parent of the fronts.
void number_fronts(const std::vector<Supernode>& supernodes, AssemblyTree& tree) {
  std::vector<int> kept, place(supernodes.size(), -1), parent;
  for (std::size_t s = 0; s < supernodes.size(); ++s) {
    if (supernodes[s].merged) continue;
    place[s] = static_cast<int>(kept.size());
    kept.push_back(static_cast<int>(s));
  }
  for (const int s : kept) parent.push_back(supernodes[s].parent == -1 ? -1 : place[supernodes[s].parent]);

  const std::vector<int> order = postorder(parent), rank = ranks(order), old = tree.ordering;
  int first = 0;
  for (const int k : order) {
    const std::vector<int>& columns = supernodes[kept[k]].columns;
    const int size = static_cast<int>(columns.size());
    for (int j = 0; j < size; ++j) tree.ordering[first + j] = old[columns[j]];
    tree.fronts.push_back({first, size, 0, 0, 0, 0, 0, 0, parent[k] == -1 ? -1 : rank[parent[k]]});
    first += size;
  }
}

void find_children(AssemblyTree& tree) {
  std::vector<std::vector<int>> children(tree.fronts.size());
  for (std::size_t f = 0; f < tree.fronts.size(); ++f) {
    Front& front = tree.fronts[f];
    front.children_begin = static_cast<int>(tree.children.size());
    tree.children.insert(tree.children.end(), children[f].begin(), children[f].end());
    front.children_end = static_cast<int>(tree.children.size());
    if (front.parent != -1) children[front.parent].push_back(static_cast<int>(f));
  }
}

/// The symbolic factorisation: the rows of a front are those of the matrix in its columns and its children's.
void find_rows(const SparsityPattern& pattern, AssemblyTree& tree) {
  const std::vector<int> rank = ranks(tree.ordering);
  std::vector<std::vector<int>> below(pattern.size);  // rows of the matrix, by column
  for (int j = 0; j < pattern.size; ++j)
    for (int k = pattern.column_start[j] + 1; k < pattern.column_start[j + 1]; ++k) {
      const auto [column, row] = std::minmax(rank[j], rank[pattern.row[k]]);
      below[column].push_back(row);
    }
  std::vector<int> seen_by(pattern.size, -1);
  for (std::size_t f = 0; f < tree.fronts.size(); ++f) {
    Front& front = tree.fronts[f];
    const int end = front.first + front.columns;
    front.rows_begin = static_cast<int>(tree.rows.size());
    const auto add = [&](int row) {
      if (row < end || seen_by[row] == static_cast<int>(f)) return;
      seen_by[row] = static_cast<int>(f);
      tree.rows.push_back(row);
    };
    for (int j = front.first; j < end; ++j)
      for (const int row : below[j]) add(row);
    for (int c = front.children_begin; c < front.children_end; ++c) {
      const Front& child = tree.fronts[tree.children[c]];
      for (int r = child.rows_begin; r < child.rows_end; ++r) add(tree.rows[r]);
    }
    front.rows_end = static_cast<int>(tree.rows.size());
    std::sort(tree.rows.begin() + front.rows_begin, tree.rows.end());
  }
}

/// The place of a row of L in a front that has it.
int place_in(const AssemblyTree& tree, const Front& front, int row) {
  if (row < front.first + front.columns) return row - front.first;
  const auto begin = tree.rows.begin() + front.rows_begin, end = tree.rows.begin() + front.rows_end;
  return front.columns + static_cast<int>(std::lower_bound(begin, end, row) - begin);
}

void find_positions(AssemblyTree& tree) {
  tree.position.reserve(tree.rows.size());
  for (const Front& front : tree.fronts)
    for (int r = front.rows_begin; r < front.rows_end; ++r)
      tree.position.push_back(place_in(tree, tree.fronts[front.parent], tree.rows[r]));
}

void find_entries(const SparsityPattern& pattern, AssemblyTree& tree) {
  const std::vector<int> rank = ranks(tree.ordering);
  std::vector<int> owner(pattern.size);
  for (std::size_t f = 0; f < tree.fronts.size(); ++f)
    std::fill_n(owner.begin() + tree.fronts[f].first, tree.fronts[f].columns, static_cast<int>(f));
  std::vector<std::vector<FrontEntry>> entries(tree.fronts.size());
  for (int j = 0; j < pattern.size; ++j)
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
      const int i = pattern.row[k];
      const auto [column, row] = std::minmax(rank[i], rank[j]);
      const int f = owner[column];
      const Front& front = tree.fronts[f];
      entries[f].push_back({k, place_in(tree, front, row), column - front.first, rank[i] < rank[j]});
    }
  tree.entries.reserve(pattern.entry_count());
  for (std::size_t f = 0; f < tree.fronts.size(); ++f) {
    tree.fronts[f].entries_begin = static_cast<int>(tree.entries.size());
    tree.entries.insert(tree.entries.end(), entries[f].begin(), entries[f].end());
    tree.fronts[f].entries_end = static_cast<int>(tree.entries.size());
  }
}

}  // namespace

AssemblyTree assembly_tree(const SparsityPattern& pattern, const std::vector<int>& ordering) {
  AssemblyTree tree;
  for (const int k : postorder(elimination_tree(pattern, ordering).parent))
    tree.ordering.push_back(ordering[k]);
  std::vector<Supernode> supernodes = fundamental_supernodes(elimination_tree(pattern, tree.ordering));
  amalgamate(supernodes);
  number_fronts(supernodes, tree);
  find_children(tree);
  find_rows(pattern, tree);
  find_positions(tree);
  find_entries(pattern, tree);
  return tree;
}

AssemblyTree assembly_tree(const SparsityPattern& pattern) {
  return assembly_tree(pattern, metis_ordering(pattern));
}

}  // namespace esfem
