// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linalg/symmetric_factor.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <thread>
#include <utility>

#include "solver/error.hpp"
#include "solver/linalg/substitute.hpp"
#include "solver/thread_count.hpp"

namespace esfem {
namespace {

/// Multiplications below which threads cost more than they save: half a millisecond.
constexpr double least_parallel_work = 1e7;

double size_of(double number) {
  return std::abs(number);
}
double size_of(const std::complex<double>& number) {
  return std::abs(number.real()) + std::abs(number.imag());
}

/// Relative to the matrix: pivots that have lost all digits, and what replaces a small one.
constexpr double least_pivot = 64 * std::numeric_limits<double>::epsilon(), replacement = 1e-8;

bool has_wrong_sign(double pivot, int sign) {
  return sign * pivot < 0;
}
bool has_wrong_sign(const std::complex<double>&, int) {
  return false;
}

int useful_parts(const AssemblyTree& tree, double multiplications_of_a_block) {
  double work = 0;
  for (const Front& front : tree.fronts) work += multiplications_of_a_block * elimination_work(front);
  return work < least_parallel_work ? 1 : thread_count();
}

/// Rows that a column of a front has room for: Packs, and in large fronts an odd number of them, so that a
/// row of L does not fall into one set of the cache.
int padded(int rows) {
  int packs = (rows + pack_size - 1) / pack_size;
  if (packs > 8 && packs % 2 == 0) ++packs;
  return packs * pack_size;
}

}  // namespace

template <class T, int b>
SymmetricFactor<T, b>::SymmetricFactor(const SparsityPattern& pattern, const Signs& signs,
                                       SmallPivots small_pivots)
    : SymmetricFactor(assembly_tree(pattern), signs, small_pivots) {}

template <class T, int b>
SymmetricFactor<T, b>::SymmetricFactor(AssemblyTree tree, const Signs& signs, SmallPivots small_pivots)
    : tree_(std::move(tree)),
      split_(split_tree(tree_, useful_parts(tree_, b * b * b))),
      signs_(signs),
      small_pivots_(small_pivots),
      places_(tree_.fronts.size()),
      workspaces_(split_.parts.size()),
      scale_(unknowns()),
      inverse_pivots_(unknowns()),
      x_(most_columns * unknowns()),
      updates_(most_columns * b * tree_.rows.size()) {
  place_fronts();
  place_entries();
}

// A front's update matrix is needed until its parent is assembled, and its siblings come in between. So those
// at odd and at even depth are on two stacks: when the parent's is put on one, its children's lie on top of
// the other, and go. Each part of the tree has two stacks of its own.
template <class T, int b>
void SymmetricFactor<T, b>::place_fronts() {
  const std::ptrdiff_t planes = PackedMatrix<T>::planes;
  std::vector<int> depth(tree_.fronts.size(), 0);
  for (std::size_t f = depth.size(); f-- > 0;)
    if (tree_.fronts[f].parent != -1) depth[f] = 1 + depth[tree_.fronts[f].parent];

  int largest = 0;
  const auto place_part = [&](const std::vector<int>& part) {
    std::ptrdiff_t top[2] = {0, 0}, height[2] = {0, 0};
    for (const int f : part) {
      const Front& front = tree_.fronts[f];
      Place& place = places_[f];
      const int n = b * front.columns, m = b * front.size(), parity = depth[f] % 2;
      place.stride = padded(m);
      place.first_updated = n / pack_size * pack_size;
      place.panel = panels_size_;
      const std::ptrdiff_t size = planes * place.stride * n;
      if (size > std::numeric_limits<int>::max())
        throw NumericsError(
            format("factorisation of %d unknowns: %d of them form one dense block, which is too large",
                   unknowns(), m));
      panels_size_ += size;
      place.update = top[parity];
      top[parity] += planes * (place.stride - place.first_updated) * (m - n);
      height[parity] = std::max(height[parity], top[parity]);
      for (int c = front.children_begin; c < front.children_end; ++c) {
        const int child = tree_.children[c];
        if (std::binary_search(part.begin(), part.end(), child))
          top[1 - parity] = std::min(top[1 - parity], places_[child].update);
      }
      largest = std::max(largest, place.stride);
    }
    for (const int f : part) places_[f].update += stack_size_ + (depth[f] % 2 == 1 ? height[0] : 0);
    stack_size_ += height[0] + height[1];
  };
  for (const std::vector<int>& part : split_.parts) place_part(part);
  place_part(split_.top);
  for (Workspace& workspace : workspaces_) {
    workspace.scaled.resize(ScaledRows<T>::size(largest));
    workspace.right.resize(most_columns * planes * largest);
  }
}

template <class T, int b>
void SymmetricFactor<T, b>::place_entries() {
  loads_.reserve(tree_.entries.size());
  for (std::size_t f = 0; f < tree_.fronts.size(); ++f) {
    const int step = PackedMatrix<T>::planes * places_[f].stride;
    for (int e = tree_.fronts[f].entries_begin; e < tree_.fronts[f].entries_end; ++e) {
      const FrontEntry& entry = tree_.entries[e];
      const int number = b > 1 && entry.transposed ? ~entry.entry : entry.entry;
      loads_.push_back({number, b * (entry.row + step * entry.column)});
    }
  }
  tree_.entries = {};
}

template <class T, int b>
std::ptrdiff_t SymmetricFactor<T, b>::memory() const {
  std::ptrdiff_t numbers = panels_size_ + stack_size_;
  for (const Workspace& workspace : workspaces_) numbers += workspace.scaled.size() + workspace.right.size();
  return sizeof(double) * numbers + sizeof(float) * rounded_.size() +
         sizeof(T) * (x_.size() + updates_.size());
}

template <class T, int b>
FrontMatrix<T> SymmetricFactor<T, b>::front_matrix(int f) {
  const Front& front = tree_.fronts[f];
  const Place& place = places_[f];
  return {b * front.columns,
          b * front.size(),
          {panels_.data() + place.panel, place.stride, 0},
          {stack_.data() + place.update, place.stride - place.first_updated, place.first_updated}};
}

/// Calls work(front, workspace) for all fronts, children first or parents first; the parts in threads. An
/// exception ends its part; that of the first part is thrown.
template <class T, int b>
template <class Work>
void SymmetricFactor<T, b>::for_each_front(Direction direction, const Work& work) {
  const auto walk = [&](const std::vector<int>& part, Workspace& workspace) {
    if (direction == upwards) {
      for (auto f = part.begin(); f != part.end(); ++f) work(*f, workspace);
    } else {
      for (auto f = part.rbegin(); f != part.rend(); ++f) work(*f, workspace);
    }
  };
  const auto walk_part = [&](std::size_t p) {
    workspaces_[p].error = nullptr;
    try {
      walk(split_.parts[p], workspaces_[p]);
    } catch (...) {
      workspaces_[p].error = std::current_exception();
    }
  };
  if (direction == downwards) walk(split_.top, workspaces_[0]);
  std::vector<std::thread> threads;
  for (std::size_t p = 1; p < split_.parts.size(); ++p) threads.emplace_back(walk_part, p);
  walk_part(0);
  for (std::thread& thread : threads) thread.join();
  for (const Workspace& workspace : workspaces_)
    if (workspace.error) std::rethrow_exception(workspace.error);
  if (direction == upwards) walk(split_.top, workspaces_[0]);
}

template <class T, int b>
void SymmetricFactor<T, b>::factorise_fronts(const Load& load) {
  factorised_ = is_rounded_ = false;
  panels_.resize(panels_size_);
  stack_.resize(stack_size_);
  for_each_front(upwards, [&](int f, Workspace& workspace) { factorise_front(f, load, workspace); });
  factorised_ = true;
}

// Update matrices of children go to L before the elimination, and to U after it, which is then not to be
// cleared.
template <class T, int b>
void SymmetricFactor<T, b>::factorise_front(int f, const Load& load, Workspace& workspace) {
  const Front& front = tree_.fronts[f];
  const FrontMatrix<T> matrix = front_matrix(f);
  const int first = b * front.first;
  std::fill_n(matrix.L.data, std::ptrdiff_t{PackedMatrix<T>::planes} * matrix.L.stride * matrix.n, 0.0);
  load(loads_.data() + front.entries_begin, loads_.data() + front.entries_end, matrix.L);
  for (int j = 0; j < matrix.n; ++j) scale_[first + j] = scale_of_row(matrix.L, j);
  for (int c = front.children_begin; c < front.children_end; ++c) extend_add(tree_.children[c], matrix, to_L);
  T wrong = {};
  const auto accept = [&](int k, T& pivot) {
    const double scale = scale_[first + k], size = size_of(pivot);
    if (!std::isfinite(size) || has_wrong_sign(pivot, signs_[k % b]) || size <= least_pivot * scale) {
      wrong = pivot;
      if (small_pivots_ == SmallPivots::are_errors || !std::isfinite(size)) return false;
    }
    if (small_pivots_ == SmallPivots::are_replaced && size < replacement * scale)
      pivot = has_wrong_sign(pivot, 1) ? -replacement * scale : replacement * scale;
    return scale > 0;
  };
  const int done =
      eliminate(matrix, inverse_pivots_.data() + first, ScaledRows<T>{workspace.scaled.data()}, accept);
  if (done < matrix.n) throw bad_pivot(first + done, wrong);
  for (int c = front.children_begin; c < front.children_end; ++c) extend_add(tree_.children[c], matrix, to_U);
}

/// The scale of a pivot: the diagonal of the matrix; where it may vanish, the largest entry of the
/// row that is in the block of its node.
template <class T, int b>
double SymmetricFactor<T, b>::scale_of_row(const PackedMatrix<T>& L, int row) const {
  if (small_pivots_ == SmallPivots::are_errors) return size_of(L.get(row, row));
  const int begin = row / b * b;
  double size = 0;
  for (int j = begin; j < begin + b; ++j)
    size = std::max(size, size_of(L.get(std::max(row, j), std::min(row, j))));
  return size;
}

template <class T, int b>
NumericsError SymmetricFactor<T, b>::bad_pivot(int unknown, const T& pivot) const {
  const int node = tree_.ordering[unknown / b] + 1;
  if (!std::isfinite(size_of(pivot)))
    return NumericsError(format("matrix to factorise is not finite at node %d (counted from 1)", node));
  const bool positive_definite = b == 1 && std::is_same_v<T, double> && signs_[0] == 1;
  return NumericsError(
      format("matrix is %s: pivot %g, where the matrix has %g, at node %d of %d (counted from 1)",
             positive_definite ? "not positive definite" : "singular", std::real(pivot), scale_[unknown],
             node, static_cast<int>(tree_.ordering.size())));
}

template <class T, int b>
void SymmetricFactor<T, b>::extend_add(int child, const FrontMatrix<T>& parent, Destination destination) {
  const Front& front = tree_.fronts[child];
  const PackedMatrix<T> from = front_matrix(child).U;
  const int* position = tree_.position.data() + front.rows_begin;
  const int rows = front.updated(), eliminated = b * front.columns;
  const int rows_in_L =
      static_cast<int>(std::lower_bound(position, position + rows, parent.n / b) - position);
  const PackedMatrix<T>& to = destination == to_L ? parent.L : parent.U;
  const int begin = destination == to_L ? 0 : rows_in_L, end = destination == to_L ? rows_in_L : rows;
  const int first_column = destination == to_L ? 0 : parent.n;
  for (int j = begin; j < end; ++j)
    for (int jb = 0; jb < b; ++jb) {
      const double* source = from.column(b * j + jb) + eliminated;
      double* target = to.column(b * position[j] + jb - first_column);
      for (int plane = 0; plane < PackedMatrix<T>::planes;
           ++plane, source += from.stride, target += to.stride)
        for (int i = j; i < rows; ++i)
          for (int ib = 0; ib < b; ++ib) target[b * position[i] + ib] += source[b * i + ib];
    }
}

template <class T, int b>
void SymmetricFactor<T, b>::require_factor(Eigen::Index rows) const {
  if (rows != unknowns())
    throw InputError(format("right-hand side has %td rows, expected %d", rows, unknowns()));
  if (!factorised_) throw NumericsError("no factors to solve with: call factorise() before solve()");
}

template <class T, int b>
void SymmetricFactor<T, b>::solve_columns(int columns) {
  switch (columns) {
  case 1:
    return solve_columns<1>();
  case 2:
    return solve_columns<2>();
  case 3:
    return solve_columns<3>();
  case 4:
    return solve_columns<4>();
  }
}

template <class T, int b>
template <int columns>
void SymmetricFactor<T, b>::solve_columns() {
  for_each_front(upwards, [&](int f, Workspace& workspace) { solve_forward<columns>(f, workspace); });
  for_each_front(downwards, [&](int f, Workspace& workspace) { solve_backward<columns>(f, workspace); });
}

template <class T, int b>
void SymmetricFactor<T, b>::round() {
  require_factor(unknowns());
  if constexpr (std::is_same_v<T, double>) {
    rounded_ = panels_.template cast<float>();
    is_rounded_ = true;
  }
}

/// use(L of a front), with the numbers as they are or rounded.
template <class T, int b>
template <class Use>
void SymmetricFactor<T, b>::with_L(int f, const FrontMatrix<T>& matrix, const Use& use) const {
  if constexpr (std::is_same_v<T, double>)
    if (is_rounded_) return use(RoundedMatrix{rounded_.data() + places_[f].panel, matrix.L.stride});
  use(matrix.L);
}

/// y = L^-1 x for the rows that the front eliminates, then D^-1 y; what their elimination adds to its other
/// rows goes to the parent, as update matrices do.
template <class T, int b>
template <int columns>
void SymmetricFactor<T, b>::solve_forward(int f, Workspace& workspace) {
  const Front& front = tree_.fronts[f];
  const FrontMatrix<T> matrix = front_matrix(f);
  const PackedMatrix<T> y{workspace.right.data(), matrix.L.stride, 0};
  T* x = x_.data() + std::ptrdiff_t{columns} * b * front.first;
  for (int c = 0; c < columns; ++c) {
    for (int i = 0; i < matrix.n; ++i) y.set(i, c, x[i * columns + c]);
    for (int i = matrix.n; i < matrix.L.stride; ++i) y.set(i, c, T{});
  }
  for (int k = front.children_begin; k < front.children_end; ++k) {
    const Front& child = tree_.fronts[tree_.children[k]];
    const T* update = updates_.data() + std::ptrdiff_t{columns} * b * child.rows_begin;
    for (int r = child.rows_begin; r < child.rows_end; ++r)
      for (int a = 0; a < b; ++a)
        for (int c = 0; c < columns; ++c) y.add(b * tree_.position[r] + a, c, *update++);
  }
  with_L(f, matrix, [&](const auto& L) { substitute_forward<T, columns>(matrix.n, L, y); });
  const T* inverse_pivots = inverse_pivots_.data() + b * front.first;
  for (int i = 0; i < matrix.n; ++i)
    for (int c = 0; c < columns; ++c) x[i * columns + c] = product(y.get(i, c), inverse_pivots[i]);
  T* update = updates_.data() + std::ptrdiff_t{columns} * b * front.rows_begin;
  for (int i = matrix.n; i < matrix.m; ++i)
    for (int c = 0; c < columns; ++c) *update++ = y.get(i, c);
}

/// x = L^-T y for the rows that the front eliminates, from the rows that its ancestors have found.
template <class T, int b>
template <int columns>
void SymmetricFactor<T, b>::solve_backward(int f, Workspace& workspace) {
  const Front& front = tree_.fronts[f];
  const FrontMatrix<T> matrix = front_matrix(f);
  const PackedMatrix<T> y{workspace.right.data(), matrix.L.stride, 0};
  T* x = x_.data() + std::ptrdiff_t{columns} * b * front.first;
  for (int i = 0; i < matrix.n; ++i)
    for (int c = 0; c < columns; ++c) y.set(i, c, x[i * columns + c]);
  for (int r = 0; r < front.updated(); ++r) {
    const T* found = x_.data() + std::ptrdiff_t{columns} * b * tree_.rows[front.rows_begin + r];
    for (int a = 0; a < b; ++a)
      for (int c = 0; c < columns; ++c) y.set(matrix.n + b * r + a, c, *found++);
  }
  for (int c = 0; c < columns; ++c)
    for (int i = matrix.m; i < matrix.L.stride; ++i) y.set(i, c, T{});
  with_L(f, matrix, [&](const auto& L) { substitute_backward<T, columns>(matrix.n, L, y); });
  for (int i = 0; i < matrix.n; ++i)
    for (int c = 0; c < columns; ++c) x[i * columns + c] = y.get(i, c);
}

template class SymmetricFactor<double>;
template class SymmetricFactor<double, 2>;
template class SymmetricFactor<double, 4>;
template class SymmetricFactor<std::complex<double>>;

}  // namespace esfem
