// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace esfem {

/// A partition of the numbers 0 .. n - 1, at first into sets of one number each (Tarjan, J. ACM 22, 1975).
class DisjointSets {
 public:
  /// n sets.
  explicit DisjointSets(int n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }

  /// The sets of a and b become one.
  void unite(int a, int b) {
    a = least(a);
    b = least(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

  /// The set of each number. Sets are counted from 0, in the order of their least members.
  std::vector<int> numbered() {
    std::vector<int> set(parent_.size());
    int sets = 0;
    for (int i = 0; i < int(set.size()); ++i) set[i] = least(i) == i ? sets++ : set[least(i)];
    return set;
  }

  /// The number of sets.
  int count() const {
    int sets = 0;
    for (int i = 0; i < int(parent_.size()); ++i) sets += parent_[i] == i;
    return sets;
  }

 private:
  /// The least member of a number's set.
  int least(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  std::vector<int> parent_;  ///< a lesser member of the set, or the number itself
};

}  // namespace esfem
