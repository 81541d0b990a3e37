// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linalg/symmetric_block_solver.hpp"

#include <dmumps_c.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/error.hpp"
#include "solver/linalg/metis_ordering.hpp"
#include "solver/linalg/thread_limit.hpp"

namespace esfem {

namespace {

// MUMPS's own words: jobs, symmetry, the communicator of its sequential library.
enum Job { initialise = -1, terminate = -2, analyse = 1, factorise_numbers = 2, solve_system = 3 };
const int general_symmetric = 2, sequential_communicator = -987654;
const int singular = -10;

}  // namespace

struct SymmetricBlockSolver::Mumps {
  std::shared_ptr<const SparsityPattern> pattern;
  std::vector<int> row, column;  ///< of the entries, counted from 1, in the order of `values`
  std::vector<int> rank;         ///< of the unknowns in the elimination, counted from 1
  Eigen::VectorXd values, y;
  bool factorised = false;
  DMUMPS_STRUC_C instance = {};

  explicit Mumps(std::shared_ptr<const SparsityPattern> shared);
  ~Mumps() { call(terminate); }

  int call(Job job) {
    instance.job = job;
    dmumps_c(&instance);
    return instance.infog[0];
  }

  /// Control parameter `number` as MUMPS's manual counts them.
  int& control(int number) { return instance.icntl[number - 1]; }

  /// Calls visit(k, i, j) for each entry of the pattern, the k-th, in row i and column j.
  template <class Visit>
  void for_each_entry(const Visit& visit) const {
    for (int j = 0; j < pattern->size; ++j)
      for (int k = pattern->column_start[j]; k < pattern->column_start[j + 1]; ++k)
        visit(k, pattern->row[k], j);
  }
};

SymmetricBlockSolver::Mumps::Mumps(std::shared_ptr<const SparsityPattern> shared)
    : pattern(std::move(shared)) {
  // Unknowns 2i+1 and 2i+2 are u and w of node i.
  const auto add = [&](int i, int j) {
    row.push_back(std::max(i, j));
    column.push_back(std::min(i, j));
  };
  for_each_entry([&](int, int i, int j) {
    add(2 * i + 1, 2 * j + 1);
    add(2 * i + 2, 2 * j + 2);
    add(2 * i + 2, 2 * j + 1);
    if (i != j) add(2 * i + 1, 2 * j + 2);
  });
  const std::vector<int> ordering = metis_ordering(*pattern);
  rank.resize(2 * pattern->size);
  for (int k = 0; k < pattern->size; ++k) {
    rank[2 * ordering[k]] = 2 * k + 1;
    rank[2 * ordering[k] + 1] = 2 * k + 2;
  }
  values.setZero(row.size());
  y.setZero(2 * pattern->size);
  instance.sym = general_symmetric;
  instance.par = 1;
  instance.comm_fortran = sequential_communicator;
  call(initialise);
  for (const int stream : {1, 2, 3}) control(stream) = -1;
  control(4) = 0;    // prints nothing
  control(6) = 0;    // no permutation by values: the analysis sees the pattern alone
  control(7) = 1;    // the order is given: MUMPS's own choice differs from process to process
  control(8) = 0;    // no scaling
  control(12) = 1;   // no 2 x 2 pivots in the ordering
  control(14) = 50;  // percent of spare memory
  instance.n = 2 * pattern->size;
  instance.nnz = static_cast<MUMPS_INT8>(row.size());
  instance.irn = row.data();
  instance.jcn = column.data();
  instance.perm_in = rank.data();
  instance.a = values.data();
  instance.rhs = y.data();
  instance.nrhs = 1;
  instance.lrhs = instance.n;
}

SymmetricBlockSolver::SymmetricBlockSolver(std::shared_ptr<const SparsityPattern> pattern) {
  const ThreadLimit one_thread;
  mumps_ = std::make_unique<Mumps>(std::move(pattern));
  if (const int status = mumps_->call(analyse); status < 0) {
    throw NumericsError(
        format("symbolic analysis of a symmetric block system of %d nodes failed (MUMPS status %d)",
               mumps_->pattern->size, status));
  }
}

SymmetricBlockSolver::~SymmetricBlockSolver() = default;

void SymmetricBlockSolver::factorise(const SymmetricMatrix& P, const SymmetricMatrix& Q,
                                     const SymmetricMatrix& R) {
  const ThreadLimit one_thread;
  Mumps& m = *mumps_;
  if (P.pattern != m.pattern || Q.pattern != m.pattern || R.pattern != m.pattern)
    throw InputError("symmetric block system: matrix is not on the pattern that was analysed");
  if (!std::isfinite(P.values.sum() + Q.values.sum() + R.values.sum()))
    throw NumericsError("matrix to factorise is not finite");
  double* value = m.values.data();
  m.for_each_entry([&](int k, int i, int j) {
    *value++ = P.values[k];
    *value++ = R.values[k];
    *value++ = Q.values[k];
    if (i != j) *value++ = Q.values[k];
  });
  m.factorised = false;
  if (const int status = m.call(factorise_numbers); status < 0) {
    throw NumericsError(
        status == singular
            ? "symmetric block system is singular"
            : format("factorisation of a symmetric block system failed (MUMPS status %d)", status));
  }
  m.factorised = true;
}

void SymmetricBlockSolver::solve(Field& r_to_u, Field& s_to_w) {
  const ThreadLimit one_thread;
  Mumps& m = *mumps_;
  const int n = m.pattern->size;
  if (r_to_u.rows() != n || s_to_w.rows() != n || r_to_u.cols() != 1 || s_to_w.cols() != 1) {
    throw InputError(
        format("right-hand sides of a symmetric block system are %td x %td and %td x %td, expected %d x 1",
               r_to_u.rows(), r_to_u.cols(), s_to_w.rows(), s_to_w.cols(), n));
  }
  if (!m.factorised) throw NumericsError("nothing is factorised to solve with");
  for (int i = 0; i < n; ++i) {
    m.y[2 * i] = r_to_u(i);
    m.y[2 * i + 1] = s_to_w(i);
  }
  if (const int status = m.call(solve_system); status < 0)
    throw NumericsError(format("solution of a symmetric block system failed (MUMPS status %d)", status));
  for (int i = 0; i < n; ++i) {
    r_to_u(i) = m.y[2 * i];
    s_to_w(i) = m.y[2 * i + 1];
  }
}

}  // namespace esfem
