// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <complex>
#include <exception>
#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

#include "solver/assembly/symmetric_matrix.hpp"
#include "solver/error.hpp"
#include "solver/linalg/assembly_tree.hpp"
#include "solver/linalg/front_matrix.hpp"
#include "solver/linalg/subtrees.hpp"

namespace esfem {

/// Treatment of a pivot that is small relative to the matrix. If it is replaced by a larger one (Li and
/// Demmel, ACM Trans. Math. Softw. 29, 2003), the factors are those of a nearby matrix, with which systems
/// can be solved iteratively.
enum class SmallPivots { are_errors, are_replaced };

/// Direct solver of symmetric systems with b x b blocks of numbers T for the pairs of nodes on a pattern: L D
/// L^T by the multifrontal method (Liu, SIAM Review 34, 1992), without pivoting. T is double or
/// std::complex<double> (symmetric, not Hermitian), b is 1, 2 or 4. The symbolic phase once a pattern,
/// numbers per call.
///
/// Without pivoting L D L^T exists if no leading minor of the reordered matrix vanishes. That holds in any
/// order for positive definite matrices, for complex ones with a positive definite real part (Higham, Math.
/// Comp. 67, 1998), and for quasi-definite ones (Vanderbei, SIAM J. Optim. 5, 1995); the signs of the pivots
/// are known then.
///
/// One elimination uses thread_count() threads for subtrees; the numbers do not depend on it.
template <class T, int b = 1>
class SymmetricFactor {
 public:
  /// A number, or a b x b matrix.
  using Block = std::conditional_t<b == 1, T, Eigen::Matrix<T, b, b>>;
  /// Right-hand sides: b rows a node, node by node.
  using Right = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
  /// The sign that the pivots of each unknown of a node must have, 1 or -1; 0: any. Of no meaning for complex
  /// T.
  using Signs = std::array<int, b>;

  /// The symbolic phase. Throws NumericsError when METIS fails.
  SymmetricFactor(const SparsityPattern& pattern, const Signs& signs, SmallPivots = SmallPivots::are_errors);
  /// With a given order of elimination.
  SymmetricFactor(AssemblyTree tree, const Signs& signs, SmallPivots = SmallPivots::are_errors);

  /// Factorises the matrix whose block for the k-th entry of the pattern, nodes i >= j, is entry(k), and its
  /// transpose for j, i. Throws NumericsError with the node when a pivot has the wrong sign, has lost all
  /// digits of the diagonal, or is not finite; then there are no factors. Allocates nothing from the second
  /// call on, nor does solve.
  template <class Entry>
  void factorise(const Entry& entry) {
    factorise_fronts([&](const LoadedEntry* begin, const LoadedEntry* end, const PackedMatrix<T>& L) {
      for (const LoadedEntry* e = begin; e != end; ++e) add_block(L, *e, entry);
    });
  }

  /// From now on real factors are read in single precision, which takes half the time for one column and is
  /// enough for a preconditioner; until the next factorise(). Nothing happens to complex ones.
  void round();

  /// Solves for all columns in place. Throws InputError when the number of rows is wrong, NumericsError when
  /// there are no factors.
  void solve(Right& right) {
    require_factor(right.rows());
    solve(
        static_cast<int>(right.cols()), [&](int row, int c) { return right(row, c); },
        [&](int row, int c, const T& number) { right(row, c) = number; });
  }

  /// The same for right-hand sides read(row, column), of which each number of the solution goes to
  /// write(row, column, number).
  template <class Read, class Write>
  void solve(int columns, const Read& read, const Write& write) {
    require_factor(unknowns());
    for (int first = 0; first < columns; first += most_columns) {
      const int count = std::min(most_columns, columns - first);
      for_each_number(count, [&](T& x, int row, int c) { x = read(row, first + c); });
      solve_columns(count);
      for_each_number(count, [&](const T& x, int row, int c) { write(row, first + c, x); });
    }
  }

  /// Bytes of the factor, of the update matrices and of the work space.
  std::ptrdiff_t memory() const;

 private:
  /// An entry of the pattern and where it begins in the columns of its front.
  struct LoadedEntry {
    int entry;  ///< its complement when the block is transposed
    int place;
  };
  using Load =
      std::function<void(const LoadedEntry* begin, const LoadedEntry* end, const PackedMatrix<T>& L)>;

  /// Where the numbers of a front are.
  struct Place {
    std::ptrdiff_t panel;   ///< in panels_
    std::ptrdiff_t update;  ///< in stack_
    int stride, first_updated;
  };

  /// What a thread works with.
  struct Workspace {
    Eigen::VectorXd scaled;  ///< ScaledRows
    Eigen::VectorXd right;   ///< right-hand sides in a front
    std::exception_ptr error;
  };

  template <class Entry>
  static void add_block(const PackedMatrix<T>& L, const LoadedEntry& e, const Entry& entry) {
    if constexpr (b == 1) {
      L.add_at(e.place, entry(e.entry));
    } else {
      const bool transposed = e.entry < 0;
      const Block block = entry(transposed ? ~e.entry : e.entry);
      for (int j = 0; j < b; ++j)
        for (int i = 0; i < b; ++i)
          L.add_at(e.place + PackedMatrix<T>::planes * j * L.stride + i,
                   transposed ? block(j, i) : block(i, j));
    }
  }

  /// Right-hand sides that are solved together.
  static constexpr int most_columns = 4;

  /// Calls visit(number of x_, row, column) in the order of elimination.
  template <class Visit>
  void for_each_number(int columns, const Visit& visit) {
    T* x = x_.data();
    for (const int node : tree_.ordering)
      for (int a = 0; a < b; ++a)
        for (int c = 0; c < columns; ++c) visit(*x++, b * node + a, c);
  }

  int unknowns() const { return b * static_cast<int>(tree_.ordering.size()); }
  void place_fronts();
  void place_entries();
  FrontMatrix<T> front_matrix(int f);
  enum Direction { upwards, downwards };
  template <class Work>
  void for_each_front(Direction direction, const Work& work);

  void factorise_fronts(const Load& load);
  void factorise_front(int f, const Load& load, Workspace& workspace);
  enum Destination { to_L, to_U };
  void extend_add(int child, const FrontMatrix<T>& parent, Destination destination);
  double scale_of_row(const PackedMatrix<T>& L, int row) const;
  NumericsError bad_pivot(int unknown, const T& pivot) const;

  void require_factor(Eigen::Index rows) const;
  void solve_columns(int columns);
  template <class Use>
  void with_L(int f, const FrontMatrix<T>& matrix, const Use& use) const;
  template <int columns>
  void solve_columns();
  template <int columns>
  void solve_forward(int f, Workspace& workspace);
  template <int columns>
  void solve_backward(int f, Workspace& workspace);

  AssemblyTree tree_;
  SplitTree split_;
  Signs signs_;
  SmallPivots small_pivots_;
  std::vector<Place> places_;
  std::vector<LoadedEntry> loads_;     ///< those of AssemblyTree::entries
  std::vector<Workspace> workspaces_;  ///< one a part; the first one is also the top's
  std::ptrdiff_t panels_size_ = 0, stack_size_ = 0;
  Eigen::VectorXd panels_;  ///< L of all fronts
  Eigen::VectorXf rounded_;
  Eigen::VectorXd stack_;  ///< update matrices
  Eigen::VectorXd scale_;  ///< of each row of the matrix
  Eigen::Matrix<T, Eigen::Dynamic, 1> inverse_pivots_;
  Eigen::Matrix<T, Eigen::Dynamic, 1> x_;  ///< right-hand sides in the order of elimination, row by row
  Eigen::Matrix<T, Eigen::Dynamic, 1>
      updates_;  ///< what fronts pass to their parents, like AssemblyTree::rows
  bool factorised_ = false, is_rounded_ = false;
};

}  // namespace esfem
