// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "solver/types.hpp"

namespace esfem {

/// Sparsity of the matrices of one mesh: lower triangle with diagonal, compressed columns, rows ascending.
struct SparsityPattern {
  int size = 0;                   ///< rows, and columns: the nodes of the mesh
  std::vector<int> column_start;  ///< size + 1
  std::vector<int> row;           ///< row of each entry, column by column

  /// The number of stored entries, those of the diagonal included.
  int entry_count() const { return static_cast<int>(row.size()); }
  /// Position in `row` of the entry (i, j) or, above the diagonal, of (j, i), which must be in the pattern.
  int entry(int i, int j) const;
};

/// All pairs of nodes that share an element.
SparsityPattern element_pattern(const Connectivity& elements, int nodes);

/// Symmetric N x N matrix on a fixed pattern; only the lower triangle is stored.
struct SymmetricMatrix {
  std::shared_ptr<const SparsityPattern> pattern;  ///< shared by all matrices of a space
  Eigen::VectorXd values;                          ///< one per entry of pattern->row

  /// out = (this) u for N x c nodal values; out is resized if needed, no other allocation. out must not be u.
  void multiply(const Field& u, Field& out) const;
  /// (this) u for N x c nodal values; allocates the result.
  Field operator*(const Field& u) const;
  /// trace(eᵀ (this) e), the square of the papers' norms (7.1)-(7.3) of kll19, summed over components.
  double energy(const Field& e) const;
  /// Sum of the diagonal.
  double trace() const;
};

}  // namespace esfem
