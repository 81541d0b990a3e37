// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/UmfPackSupport>
#include <vector>

#include "solver/assembly/symmetric_matrix.hpp"

namespace esfem {

/// LU factorisation (UMFPACK) of systems with c unknowns and c equations a node: a c x c block for each pair
/// of nodes of a pattern, in both triangles. Entry (a, b) of the block of nodes i, j is in row c i + a and
/// column c j + b. Symbolic analysis once, numbers per call.
class NodeBlockLu {
 public:
  /// For each column of a block, the rows that can be non-zero, ascending.
  using BlockRows = std::vector<std::vector<int>>;

  /// Throws NumericsError when the symbolic analysis fails.
  NodeBlockLu(const SparsityPattern& pattern, const BlockRows& rows);

  /// Factorises the matrix whose block of nodes i, j has the entries entry(k, above, a, b): k is where the
  /// pattern has (i, j), or (j, i) when the block is above the diagonal, i < j. Throws NumericsError when the
  /// matrix is singular or not finite.
  template <class Entry>
  void factorise(const Entry& entry) {
    double* value = matrix_.valuePtr();
    for (std::size_t j = 0; j + 1 < neighbour_start_.size(); ++j)
      for (std::size_t b = 0; b < rows_.size(); ++b)
        for (int n = neighbour_start_[j]; n < neighbour_start_[j + 1]; ++n)
          for (int a : rows_[b]) *value++ = entry(neighbours_[n].entry, neighbours_[n].above, a, b);
    factorise();
  }

  /// `solution` has its size already.
  void solve(const Eigen::VectorXd& right, Eigen::VectorXd& solution);

 private:
  struct Neighbour {
    int node, entry;
    bool above;
  };

  void find_pattern(const SparsityPattern& pattern);
  void factorise();

  BlockRows rows_;
  std::vector<int> neighbour_start_;   ///< compressed columns of the whole pattern, of both triangles
  std::vector<Neighbour> neighbours_;  ///< of each node ascending, itself among them
  Eigen::SparseMatrix<double> matrix_;
  Eigen::UmfPackLU<Eigen::SparseMatrix<double>> lu_;
};

}  // namespace esfem
