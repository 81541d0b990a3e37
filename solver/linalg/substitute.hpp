// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "solver/linalg/eliminate_front.hpp"

namespace esfem {

/// Columns of L whose products with right-hand sides are summed up in registers together.
template <class T>
constexpr int dot_columns = pack_size == 8 && PackedMatrix<T>::planes == 1 ? 4 : 2;

/// Forward substitution in a front, for `columns` right-hand sides y (as many rows as L has): the first n
/// rows become L_n^-1 y, L times them is subtracted from the others. L: PackedMatrix<T> or RoundedMatrix.
template <class T, int columns, class Factor>
void substitute_forward(int n, const Factor& L, const PackedMatrix<T>& y) {
  using Matrix = PackedMatrix<T>;
  for (int begin = 0; begin < n; begin += block_columns) {
    const int size = std::min(block_columns, n - begin);
    typename Matrix::FourNumbers x[block_columns] = {};
    for (int k = 0; k < size; ++k) {
      for (int c = 0; c < columns; ++c) set_lane(x[k], c, y.get(begin + k, c));
      for (int i = 0; i < k; ++i) subtract_product(x[k], x[i], L.get(begin + k, begin + i));
    }
    for (int row = begin; row < L.stride; row += pack_size) {
      typename Matrix::Packed sum[columns];
      for (int c = 0; c < columns; ++c) sum[c] = y.load(row, c);
      for (int k = 0; k < size; ++k) {
        const typename Matrix::Packed l = L.load(row, begin + k);
        __builtin_prefetch(L.column(begin + k + block_columns) + row);
        for (int c = 0; c < columns; ++c) subtract_product(sum[c], l, lane(x[k], c));
      }
      for (int c = 0; c < columns; ++c) y.store(row, c, sum[c]);
    }
    for (int k = 0; k < size; ++k)
      for (int c = 0; c < columns; ++c) y.set(begin + k, c, lane(x[k], c));
  }
}

/// x -= (L^T y) of `size` columns of L from `column` on and their rows from `row` on.
template <class T, int columns, int size, class Factor>
void subtract_dots(const Factor& L, int row, int column, const PackedMatrix<T>& y,
                   typename PackedMatrix<T>::FourNumbers* x) {
  using Packed = typename PackedMatrix<T>::Packed;
  Packed sum[size][columns] = {};
  for (; row < L.stride; row += pack_size) {
    Packed right[columns];
    for (int c = 0; c < columns; ++c) right[c] = y.load(row, c);
    for (int k = 0; k < size; ++k) {
      const Packed l = L.load(row, column + k);
      __builtin_prefetch(L.column(column + k - block_columns) + row);
      for (int c = 0; c < columns; ++c) subtract_product(sum[k][c], l, right[c]);
    }
  }
  for (int k = 0; k < size; ++k)
    for (int c = 0; c < columns; ++c) set_lane(x[k], c, lane(x[k], c) + lane_sum(sum[k][c]));
}

/// Backward substitution in a front: the first n rows of y become L_n^-T (y_n - L_rest^T y_rest), the others
/// stay.
template <class T, int columns, class Factor>
void substitute_backward(int n, const Factor& L, const PackedMatrix<T>& y) {
  const int last = (n - 1) / block_columns * block_columns;
  for (int begin = last; begin >= 0; begin -= block_columns) {
    const int size = std::min(block_columns, n - begin);
    typename PackedMatrix<T>::FourNumbers x[block_columns] = {};
    for (int k = 0; k < size; ++k)
      for (int c = 0; c < columns; ++c) {
        set_lane(x[k], c, y.get(begin + k, c));
        y.set(begin + k, c, T{});  // the products below are those of the rows after the block
      }
    int k = 0;
    for (; k + dot_columns<T> <= size; k += dot_columns<T>)
      subtract_dots<T, columns, dot_columns<T>>(L, begin, begin + k, y, x + k);
    for (; k < size; ++k) subtract_dots<T, columns, 1>(L, begin, begin + k, y, x + k);
    for (k = size - 1; k >= 0; --k) {
      for (int i = k + 1; i < size; ++i) subtract_product(x[k], x[i], L.get(begin + i, begin + k));
      for (int c = 0; c < columns; ++c) y.set(begin + k, c, lane(x[k], c));
    }
  }
}

}  // namespace esfem
