// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linalg/subtrees.hpp"

#include <algorithm>
#include <limits>

namespace esfem {
namespace {

struct Bins {
  std::vector<int> bin;  ///< of each root
  double largest = 0;
};

/// Each root, the largest first, goes where least is to do yet.
Bins fill_bins(std::vector<int>& roots, const std::vector<double>& work, int parts) {
  std::sort(roots.begin(), roots.end(),
            [&](int f, int g) { return work[f] != work[g] ? work[f] > work[g] : f < g; });
  std::vector<double> load(parts, 0);
  Bins bins;
  for (const int root : roots) {
    const auto least = std::min_element(load.begin(), load.end());
    *least += work[root];
    bins.bin.push_back(static_cast<int>(least - load.begin()));
  }
  bins.largest = *std::max_element(load.begin(), load.end());
  return bins;
}

}  // namespace

double elimination_work(const Front& front) {
  double work = 0;
  for (int rows = front.size() - 1; rows >= front.updated(); --rows) work += 0.5 * rows * (rows + 1.0);
  return work;
}

SplitTree split_tree(const AssemblyTree& tree, int parts) {
  const int fronts = static_cast<int>(tree.fronts.size());
  std::vector<double> work(fronts, 0);  // of subtrees
  std::vector<int> roots;
  for (int f = 0; f < fronts; ++f) {
    const Front& front = tree.fronts[f];
    work[f] += elimination_work(front);
    if (front.parent == -1) {
      roots.push_back(f);
    } else {
      work[front.parent] += work[f];
    }
  }

  // The largest subtree is replaced by its children, its root goes to the top, as long as that may help:
  // until the top alone takes longer than the best that was found.
  std::vector<int> bin_of_root(fronts, -1);
  double best = std::numeric_limits<double>::infinity(), top = 0;
  while (!roots.empty() && top < best) {
    const Bins bins = fill_bins(roots, work, parts);
    if (top + bins.largest < best) {
      best = top + bins.largest;
      std::fill(bin_of_root.begin(), bin_of_root.end(), -1);
      for (std::size_t k = 0; k < roots.size(); ++k) bin_of_root[roots[k]] = bins.bin[k];
    }
    if (parts == 1) break;
    const Front& largest = tree.fronts[roots.front()];
    top += elimination_work(largest);
    roots.erase(roots.begin());
    roots.insert(roots.end(), tree.children.begin() + largest.children_begin,
                 tree.children.begin() + largest.children_end);
  }

  SplitTree split;
  split.parts.resize(parts);
  std::vector<int> bin(fronts, -1);
  for (int f = fronts - 1; f >= 0; --f) {
    const int parent = tree.fronts[f].parent;
    bin[f] = bin_of_root[f] != -1 || parent == -1 ? bin_of_root[f] : bin[parent];
  }
  for (int f = 0; f < fronts; ++f) (bin[f] == -1 ? split.top : split.parts[bin[f]]).push_back(f);
  return split;
}

}  // namespace esfem
