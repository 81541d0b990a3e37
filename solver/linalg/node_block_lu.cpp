// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linalg/node_block_lu.hpp"

#include <algorithm>

#include "solver/error.hpp"

// Present when UMFPACK's BLAS is OpenBLAS, which starts threads by default.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));

namespace esfem {

NodeBlockLu::NodeBlockLu(const SparsityPattern& pattern, const BlockRows& rows) : rows_(rows) {
  if (openblas_set_num_threads) openblas_set_num_threads(1);
  find_pattern(pattern);
  lu_.umfpackControl()[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
  lu_.umfpackControl()[UMFPACK_ORDERING] = UMFPACK_ORDERING_METIS;
  lu_.analyzePattern(matrix_);
  if (lu_.info() != Eigen::Success) {
    throw NumericsError(
        format("symbolic LU analysis of %d unknowns failed", static_cast<int>(matrix_.rows())));
  }
}

void NodeBlockLu::find_pattern(const SparsityPattern& pattern) {
  std::vector<std::vector<Neighbour>> neighbours(pattern.size);
  for (int j = 0; j < pattern.size; ++j) {
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
      const int i = pattern.row[k];
      neighbours[j].push_back({i, k, false});
      if (i != j) neighbours[i].push_back({j, k, true});
    }
  }
  const int size = static_cast<int>(rows_.size());
  neighbour_start_ = {0};
  std::vector<int> column_start = {0}, row;
  for (std::vector<Neighbour>& column : neighbours) {
    std::sort(column.begin(), column.end(),
              [](const Neighbour& some, const Neighbour& other) { return some.node < other.node; });
    neighbours_.insert(neighbours_.end(), column.begin(), column.end());
    neighbour_start_.push_back(neighbours_.size());
    for (const std::vector<int>& block_rows : rows_) {
      for (const Neighbour& neighbour : column)
        for (int a : block_rows) row.push_back(size * neighbour.node + a);
      column_start.push_back(row.size());
    }
  }
  const std::vector<double> values(row.size(), 1.0);
  const int unknowns = size * pattern.size;
  matrix_ = Eigen::Map<const Eigen::SparseMatrix<double>>(unknowns, unknowns, row.size(), column_start.data(),
                                                          row.data(), values.data());
}

void NodeBlockLu::factorise() {
  lu_.factorize(matrix_);
  if (lu_.info() != Eigen::Success) {
    throw NumericsError(format("LU factorisation of %d unknowns failed (UMFPACK status %d)",
                               static_cast<int>(matrix_.rows()), lu_.umfpackFactorizeReturncode()));
  }
}

void NodeBlockLu::solve(const Eigen::VectorXd& right, Eigen::VectorXd& solution) {
  solution = lu_.solve(right);
}

}  // namespace esfem
