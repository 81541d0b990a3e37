// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linalg/metis_ordering.hpp"

#include <metis.h>

#include <numeric>

#include "solver/error.hpp"

namespace esfem {

std::vector<int> metis_ordering(const SparsityPattern& pattern) {
  std::vector<int> ordering(pattern.size);
  std::iota(ordering.begin(), ordering.end(), 0);
  if (pattern.entry_count() == pattern.size) return ordering;  // METIS fails on a graph without edges

  std::vector<idx_t> start(pattern.size + 1, 0);
  const auto for_each_edge = [&](auto visit) {
    for (int j = 0; j < pattern.size; ++j)
      for (int k = pattern.column_start[j] + 1; k < pattern.column_start[j + 1]; ++k)
        visit(pattern.row[k], j);
  };
  for_each_edge([&](int i, int j) { ++start[i + 1], ++start[j + 1]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<idx_t> neighbour(start.back()), next(start.begin(), start.end() - 1);
  for_each_edge([&](int i, int j) {
    neighbour[next[i]++] = j;
    neighbour[next[j]++] = i;
  });

  idx_t size = pattern.size;
  std::vector<idx_t> rank(pattern.size);
  const int status =
      METIS_NodeND(&size, start.data(), neighbour.data(), nullptr, nullptr, ordering.data(), rank.data());
  if (status != METIS_OK)
    throw NumericsError(format("ordering of %d unknowns failed (METIS status %d)", pattern.size, status));
  return ordering;
}

}  // namespace esfem
