// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "solver/linalg/front_matrix.hpp"

namespace esfem {

/// Columns that are eliminated together, and whose numbers stay in registers then.
constexpr int block_columns = pack_size < 4 ? 4 : pack_size;

/// A tile of a product, tile_packs * pack_size rows by tile_columns columns, is summed up in registers: 24 of
/// the 32 that AVX-512 has, 12 of 16 with AVX.
/// @{
template <class T>
constexpr int tile_packs = PackedMatrix<T>::planes == 1 ? 3 : 2;
template <class T>
constexpr int tile_columns = PackedMatrix<T>::planes == 1 || pack_size == 2 ? pack_size : pack_size / 2;
/// @}

/// Columns of L whose product is subtracted from the rest of a front at once: they fit into the cache.
constexpr int panel_columns = 64;

/// The rows of L D that a panel's elimination needs again, in groups of pack_size rows: of each group, column
/// by column, one Pack of real parts and, with complex numbers, one of imaginary parts.
template <class T>
struct ScaledRows {
  static constexpr int planes = PackedMatrix<T>::planes;  ///< doubles of a number T: 1, or 2 of a complex one
  double* data;                                           ///< not owned; as many doubles as `size` says

  /// Where the row begins in the column of the panel.
  double* at(int row, int column) const {
    return data + (std::ptrdiff_t{row / pack_size} * panel_columns + column) * planes * pack_size +
           row % pack_size;
  }
  /// How many doubles so many rows, a multiple of pack_size, take up.
  static constexpr std::ptrdiff_t size(int rows) { return std::ptrdiff_t{rows} * panel_columns * planes; }
};

/// What a product is subtracted from.
enum class From { matrix, zero };

/// c -= a b^T, or c = -a b^T, for a tile of packs * pack_size rows and `columns` columns: a has `depth`
/// columns, b is in ScaledRows.
template <class T, int packs, int columns>
void subtract_tile(From from, const double* a, int a_stride, const double* b, int depth, double* c,
                   int c_stride) {
  using Matrix = PackedMatrix<T>;
  typename Matrix::Packed sum[columns][packs] = {};
  for (int p = 0; p < depth; ++p) {
    typename Matrix::Packed rows[packs];
    for (int i = 0; i < packs; ++i) rows[i] = Matrix::load(a + i * pack_size, a_stride);
    for (int j = 0; j < columns; ++j)
      for (int i = 0; i < packs; ++i) subtract_product(sum[j][i], rows[i], Matrix::scalar(b + j, pack_size));
    a += Matrix::planes * a_stride;
    b += Matrix::planes * pack_size;
  }
  for (int j = 0; j < columns; ++j, c += Matrix::planes * c_stride)
    for (int i = 0; i < packs; ++i) {
      if (from == From::matrix) sum[j][i] = sum_of(sum[j][i], Matrix::load(c + i * pack_size, c_stride));
      Matrix::store(c + i * pack_size, c_stride, sum[j][i]);
    }
}

/// @cond

/// subtract_tile for all sizes, entry (packs - 1) * tile_columns + columns - 1.
template <class T>
using Tile = void (*)(From, const double*, int, const double*, int, double*, int);
template <class T, int... k>
constexpr std::array<Tile<T>, sizeof...(k)> tiles(std::integer_sequence<int, k...>) {
  return {subtract_tile<T, k / tile_columns<T> + 1, k % tile_columns<T> + 1>...};
}
template <class T>
constexpr auto tile_of_size = tiles<T>(std::make_integer_sequence<int, tile_packs<T> * tile_columns<T>>());

/// @endcond

/// Subtracts L D L^T of the columns p_begin .. p_end of a front from its columns begin .. end, from their
/// diagonal down. All of these are in L, or all of them in U. scaled: from p_begin on.
template <class T>
void subtract_outer_product(const FrontMatrix<T>& front, const ScaledRows<T>& scaled, int p_begin, int p_end,
                            int begin, int end, From from) {
  const PackedMatrix<T>& to = begin < front.n ? front.L : front.U;
  const int first_column = begin < front.n ? 0 : front.n;
  for (int j = begin, next; j < end; j = next) {
    next = std::min(j / tile_columns<T> * tile_columns<T> + tile_columns<T>, end);
    for (int row = j / pack_size * pack_size; row < front.L.stride; row += tile_packs<T> * pack_size) {
      const int packs = std::min(tile_packs<T>, (front.L.stride - row) / pack_size);
      tile_of_size<T>[(packs - 1) * tile_columns<T> + next - j - 1](
          from, front.L.column(p_begin) + row, front.L.stride, scaled.at(j, 0), p_end - p_begin,
          to.column(j - first_column) + row, to.stride);
    }
  }
}

/// L and D^-1 of a small dense block, in place: the strict lower triangle becomes L. Returns the first pivot
/// that is not accepted, or `size`.
template <class T, class Accept>
int factorise_block(T (&block)[block_columns][block_columns], int size, T* inverse_pivots,
                    const Accept& accept) {
  for (int k = 0; k < size; ++k) {
    if (!accept(k, block[k][k])) return k;
    const T inverse = inverse_pivots[k] = 1.0 / block[k][k];
    T column[block_columns];
    for (int i = k + 1; i < size; ++i) {
      column[i] = block[i][k];
      block[i][k] = product(column[i], inverse);
    }
    for (int j = k + 1; j < size; ++j)
      for (int i = j; i < size; ++i) block[i][j] -= product(block[i][k], column[j]);
  }
  return size;
}

/// The rows of L below a factorised block, from those of the matrix: L D L_block^T = matrix. L D goes to
/// `scaled`.
template <class T, int size>
void solve_block_rows(const T (&block)[block_columns][block_columns], const T* inverse_pivots, double* rows,
                      int stride, int packs, double* scaled) {
  using Matrix = PackedMatrix<T>;
  const std::ptrdiff_t step = std::ptrdiff_t{Matrix::planes} * stride;
  for (int i = 0; i < packs; ++i, rows += pack_size, scaled += ScaledRows<T>::size(pack_size)) {
    typename Matrix::Packed x[size];
    for (int j = 0; j < size; ++j) x[j] = Matrix::load(rows + j * step, stride);
    for (int j = 0; j < size; ++j) {
      for (int k = j + 1; k < size; ++k) subtract_product(x[k], x[j], block[k][j]);
      Matrix::store(rows + j * step, stride, product(x[j], inverse_pivots[j]));
      Matrix::store(scaled + j * Matrix::planes * pack_size, pack_size, x[j]);
    }
  }
}

/// @cond

/// solve_block_rows for all sizes, entry size - 1.
template <class T>
using BlockRows = void (*)(const T (&)[block_columns][block_columns], const T*, double*, int, int, double*);
template <class T, int... k>
constexpr std::array<BlockRows<T>, sizeof...(k)> block_rows(std::integer_sequence<int, k...>) {
  return {solve_block_rows<T, k + 1>...};
}
template <class T>
constexpr auto block_rows_of_size = block_rows<T>(std::make_integer_sequence<int, block_columns>());

/// @endcond

/// Eliminates the columns begin .. begin + size of a front, to which everything before has been applied, and
/// leaves zeros above their diagonal. They are the columns from `place` on of the panel. Returns the first
/// pivot that is not accepted, or begin + size.
template <class T, class Accept>
int eliminate_block(const FrontMatrix<T>& front, int begin, int size, T* inverse_pivots,
                    const ScaledRows<T>& scaled, int place, const Accept& accept) {
  T block[block_columns][block_columns];
  for (int j = 0; j < size; ++j)
    for (int i = j; i < size; ++i) block[i][j] = front.L.get(begin + i, begin + j);
  const int done = factorise_block(block, size, inverse_pivots + begin,
                                   [&](int k, T& pivot) { return accept(begin + k, pivot); });
  if (done < size) return begin + done;
  const int stride = front.L.stride;
  block_rows_of_size<T>[size - 1](block, inverse_pivots + begin, front.L.column(begin) + begin, stride,
                                  (stride - begin) / pack_size, scaled.at(begin, place));
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < j; ++i) front.L.set(begin + i, begin + j, T{});
  return begin + size;
}

/// Eliminates the first n columns of a front, panel by panel: L, the inverse pivots D^-1, and U = -L D L^T of
/// its other rows. accept(k, pivot) says whether a pivot is good, and may replace it. Returns the first one
/// that is not, or n.
template <class T, class Accept>
int eliminate(const FrontMatrix<T>& front, T* inverse_pivots, const ScaledRows<T>& scaled,
              const Accept& accept) {
  for (int panel = 0, panel_end; panel < front.n; panel = panel_end) {
    panel_end = std::min(panel + panel_columns, front.n);
    for (int j = panel, next; j < panel_end; j = next) {
      next = std::min(j + block_columns, panel_end);
      if (j > panel) subtract_outer_product(front, scaled, panel, j, j, next, From::matrix);
      const int done = eliminate_block(front, j, next - j, inverse_pivots, scaled, j - panel, accept);
      if (done < next) return done;
    }
    subtract_outer_product(front, scaled, panel, panel_end, panel_end, front.n, From::matrix);
    subtract_outer_product(front, scaled, panel, panel_end, front.n, front.m,
                           panel == 0 ? From::zero : From::matrix);
  }
  return front.n;
}

}  // namespace esfem
