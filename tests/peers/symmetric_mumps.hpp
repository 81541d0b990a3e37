// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "solver/error.hpp"
#include "tests/peers/thread_limit.hpp"

namespace esfem {

/// L D L^T of a symmetric matrix by MUMPS: Instance and program are its ZMUMPS_STRUC_C and zmumps_c for
/// complex numbers, DMUMPS_STRUC_C and dmumps_c for real ones.
template <class Scalar, class Instance, void (*program)(Instance*)>
class SymmetricMumps {
 public:
  enum Pivoting { none, by_threshold };

  /// The entries of the lower triangle, of which the k-th is in row[k] and column[k], and the unknowns in the
  /// order of elimination; all counted from 0. system: its name in messages. Analyses the pattern; throws
  /// NumericsError when that fails.
  SymmetricMumps(std::string system, std::vector<int> row, std::vector<int> column,
                 const std::vector<int>& ordering, Pivoting pivoting)
      : system_(std::move(system)),
        row_(std::move(row)),
        column_(std::move(column)),
        rank_(ordering.size()),
        values_(row_.size()) {
    for (int& i : row_) ++i;  // MUMPS counts from 1
    for (int& j : column_) ++j;
    for (std::size_t k = 0; k < ordering.size(); ++k) rank_[ordering[k]] = static_cast<int>(k) + 1;
    instance_.sym = 2;
    instance_.par = 1;
    instance_.comm_fortran = -987654;  // of the sequential library
    call(initialise);
    for (const int stream : {1, 2, 3}) control(stream) = -1;
    control(4) = 0;         // prints nothing
    control(6) = 0;         // no permutation by values: the analysis sees the pattern alone
    control(7) = 1;         // the order is given: SCOTCH, MUMPS's choice, differs from process to process
    control(8) = 0;         // no scaling
    control(12) = 1;        // no 2 x 2 pivots in the ordering
    control(14) = 50;       // percent of spare memory
    instance_.keep[0] = 8;  // pivots of a front, at least: 5, the default, takes a tenth longer
    if (pivoting == none) instance_.cntl[0] = 0;
    instance_.n = static_cast<int>(rank_.size());
    instance_.nnz = static_cast<decltype(instance_.nnz)>(row_.size());
    instance_.irn = row_.data();
    instance_.jcn = column_.data();
    instance_.perm_in = rank_.data();
    instance_.a = as_mumps(values_.data());
    const int status = call(analyse);
    if (status < 0) {
      call(terminate);
      throw failed("symbolic analysis", status);
    }
  }
  ~SymmetricMumps() { call(terminate); }
  SymmetricMumps(const SymmetricMumps&) = delete;
  SymmetricMumps& operator=(const SymmetricMumps&) = delete;

  /// The numbers of the entries, to be filled in before factorise().
  Scalar* values() { return values_.data(); }

  /// Throws NumericsError when the matrix is singular, or needs more memory than there is.
  void factorise() {
    factorised_ = false;
    const int singular = -10, too_little_memory = -9, most_memory = 10000;
    int status = call(factorise_numbers);
    while (status == too_little_memory && control(14) < most_memory) {  // pivots were put off
      control(14) *= 4;
      status = call(factorise_numbers);
    }
    if (status == singular) throw NumericsError(system_ + " is singular");
    if (status < 0) throw failed("factorisation", status);
    factorised_ = true;
  }

  /// Solves for all columns of the right-hand sides at once, in place. Throws NumericsError when nothing is
  /// factorised.
  void solve(Scalar* right, int columns) {
    if (!factorised_) throw NumericsError("no factors to solve with: call factorise() before solve()");
    instance_.rhs = as_mumps(right);
    instance_.nrhs = columns;
    instance_.lrhs = instance_.n;
    control(27) = columns;
    const int status = call(solve_system);
    if (status < 0) throw failed("solution", status);
  }

 private:
  enum Job { initialise = -1, terminate = -2, analyse = 1, factorise_numbers = 2, solve_system = 3 };

  int call(Job job) {
    const ThreadLimit one_thread;
    instance_.job = job;
    program(&instance_);
    return instance_.infog[0];
  }

  /// Control parameter `number` as MUMPS's manual counts them.
  int& control(int number) { return instance_.icntl[number - 1]; }

  static auto as_mumps(Scalar* numbers) { return reinterpret_cast<decltype(Instance::a)>(numbers); }

  NumericsError failed(const char* what, int status) const {
    return NumericsError(format("%s of a %s of %d unknowns failed (MUMPS status %d)", what, system_.c_str(),
                                instance_.n, status));
  }

  std::string system_;
  std::vector<int> row_, column_;  ///< counted from 1
  std::vector<int> rank_;          ///< of the unknowns in the elimination, counted from 1
  std::vector<Scalar> values_;
  bool factorised_ = false;
  Instance instance_ = {};
};

}  // namespace esfem
