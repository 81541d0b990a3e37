// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/linalg/packed_matrix.hpp"

namespace esfem {

/// A front (AssemblyTree) with its numbers: m rows, of which the first n are eliminated. L: m x n, first the
/// lower part of the matrix, then of L, with zeros above the diagonal; U: the lower triangle of the update
/// matrix, whose rows n .. m are numbered as in the front and whose columns from 0.
template <class T>
struct FrontMatrix {
  int n;              ///< columns that are eliminated
  int m;              ///< rows of the front, n <= m
  PackedMatrix<T> L;  ///< m x n
  PackedMatrix<T> U;  ///< (m - n) x (m - n)
};

}  // namespace esfem
