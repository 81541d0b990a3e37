// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "solver/types.hpp"

namespace esfem {

/// Sparsity of the matrices of one mesh: lower triangle with diagonal, compressed columns, rows ascending.
struct SparsityPattern {
  int size = 0;
  std::vector<int> column_start;  ///< size + 1
  std::vector<int> row;
};

/// Symmetric N x N matrix on a fixed pattern; only the lower triangle is stored.
struct SymmetricMatrix {
  std::shared_ptr<const SparsityPattern> pattern;
  Eigen::VectorXd values;  ///< one per entry of pattern->row

  /// out = (this) u for N x c nodal values; out is resized if needed, no other allocation.
  void multiply(const Field& u, Field& out) const;
  Field operator*(const Field& u) const;
  /// trace(eᵀ (this) e), the square of the papers' norms (7.1)-(7.3) of kll19, summed over components.
  double energy(const Field& e) const;
};

}  // namespace esfem
