// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/peers/cholmod_solver.hpp"

#include <cholmod.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/error.hpp"
#include "tests/peers/thread_limit.hpp"

namespace esfem {
namespace {

/// The pattern as CHOLMOD sees it: a symmetric matrix without values, which CHOLMOD only reads and which must
/// outlive the result.
cholmod_sparse cholmod_pattern(const SparsityPattern& pattern) {
  cholmod_sparse lower = {};
  lower.nrow = lower.ncol = pattern.size;
  lower.nzmax = pattern.row.size();
  lower.p = const_cast<int*>(pattern.column_start.data());
  lower.i = const_cast<int*>(pattern.row.data());
  lower.stype = -1;
  lower.itype = CHOLMOD_INT;
  lower.xtype = CHOLMOD_PATTERN;
  lower.dtype = CHOLMOD_DOUBLE;
  lower.sorted = lower.packed = true;
  return lower;
}

}  // namespace

struct CholmodSolver::Cholmod {
  std::shared_ptr<const SparsityPattern> pattern;
  cholmod_common common;
  cholmod_factor* factor = nullptr;
  cholmod_sparse* permuted =
      nullptr;                ///< lower triangle of P(aM + bA)Pᵀ, which the numeric factorisation reads
  std::vector<int> position;  ///< where an entry of the pattern goes in it
  bool factorised = false;
  cholmod_dense *solution = nullptr, *work_y = nullptr, *work_e = nullptr;

  explicit Cholmod(std::shared_ptr<const SparsityPattern> shared);
  ~Cholmod();
  void analyse();
  void permute();
};

CholmodSolver::Cholmod::Cholmod(std::shared_ptr<const SparsityPattern> shared) : pattern(std::move(shared)) {
  cholmod_start(&common);
  common.print = 0;
  common.error_handler = nullptr;
  common.supernodal = CHOLMOD_SUPERNODAL;
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_NESDIS;
  common.postorder = true;
  // Larger relaxed supernodes than CHOLMOD's 4, 16, 48: fewer and larger BLAS calls for surface meshes.
  common.nrelax[0] = 16;
  common.nrelax[1] = 64;
  common.nrelax[2] = 192;
}

CholmodSolver::Cholmod::~Cholmod() {
  cholmod_free_factor(&factor, &common);
  cholmod_free_sparse(&permuted, &common);
  cholmod_free_dense(&solution, &common);
  cholmod_free_dense(&work_y, &common);
  cholmod_free_dense(&work_e, &common);
  cholmod_finish(&common);
}

void CholmodSolver::Cholmod::analyse() {
  cholmod_sparse lower = cholmod_pattern(*pattern);
  factor = cholmod_analyze(&lower, &common);
  if (!factor)
    throw NumericsError(format("symbolic Cholesky analysis of %d unknowns failed (CHOLMOD status %d)",
                               pattern->size, common.status));
}

void CholmodSolver::Cholmod::permute() {
  const int n = pattern->size;
  permuted = cholmod_allocate_sparse(n, n, pattern->row.size(), false, true, -1, CHOLMOD_REAL, &common);
  if (!permuted) throw NumericsError("out of memory in the symbolic Cholesky analysis");
  const int* old_of_new = static_cast<int*>(factor->Perm);
  std::vector<int> new_of_old(n);
  for (int j = 0; j < n; ++j) new_of_old[old_of_new[j]] = j;

  int* start = static_cast<int*>(permuted->p);
  int* row = static_cast<int*>(permuted->i);
  std::fill(start, start + n + 1, 0);
  auto each_entry = [&](auto visit) {
    for (int j = 0; j < n; ++j)
      for (int k = pattern->column_start[j]; k < pattern->column_start[j + 1]; ++k) {
        const auto [column, below] = std::minmax(new_of_old[j], new_of_old[pattern->row[k]]);
        visit(k, column, below);
      }
  };
  each_entry([&](int, int column, int) { ++start[column + 1]; });
  for (int j = 0; j < n; ++j) start[j + 1] += start[j];
  std::vector<int> next(start, start + n);
  position.resize(pattern->row.size());
  each_entry([&](int k, int column, int below) {
    position[k] = next[column]++;
    row[position[k]] = below;
  });
}

CholmodSolver::CholmodSolver(std::shared_ptr<const SparsityPattern> pattern)
    : cholmod_(std::make_unique<Cholmod>(std::move(pattern))) {
  const ThreadLimit one_thread;
  cholmod_->analyse();
  cholmod_->permute();
}

CholmodSolver::~CholmodSolver() = default;

std::size_t CholmodSolver::memory() const {
  return cholmod_->common.memory_inuse;
}

void CholmodSolver::factorise(double a, const SymmetricMatrix& M, double b, const SymmetricMatrix& A) {
  const ThreadLimit one_thread;
  Cholmod& c = *cholmod_;
  double* values = static_cast<double*>(c.permuted->x);
  double sum = 0;
  for (std::size_t k = 0; k < c.position.size(); ++k) {
    const double value = a * M.values[k] + b * A.values[k];
    values[c.position[k]] = value;
    sum += value;
  }
  if (!std::isfinite(sum)) throw NumericsError("matrix to factorise is not finite");

  c.factorised = false;
  double shift[2] = {0, 0};
  c.common.status = CHOLMOD_OK;
  cholmod_super_numeric(c.permuted, nullptr, shift, c.factor, &c.common);
  if (c.common.status == CHOLMOD_NOT_POSDEF || c.factor->minor < c.factor->n)
    throw NumericsError(format("matrix is not positive definite at column %d of %d",
                               static_cast<int*>(c.factor->Perm)[c.factor->minor], c.pattern->size));
  if (c.common.status != CHOLMOD_OK)
    throw NumericsError(format("Cholesky factorisation failed (CHOLMOD status %d)", c.common.status));
  c.factorised = true;
}

void CholmodSolver::solve(Field& rhs) {
  const ThreadLimit one_thread;
  Cholmod& c = *cholmod_;
  if (rhs.rows() != c.pattern->size)
    throw InputError(
        format("right-hand side has %d rows, expected %d", static_cast<int>(rhs.rows()), c.pattern->size));
  if (!c.factorised) throw NumericsError("no factors to solve with: call factorise() before solve()");
  cholmod_dense right = {};
  right.nrow = right.d = rhs.rows();
  right.ncol = rhs.cols();
  right.nzmax = rhs.size();
  right.x = rhs.data();
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  if (!cholmod_solve2(CHOLMOD_A, c.factor, &right, nullptr, &c.solution, nullptr, &c.work_y, &c.work_e,
                      &c.common))
    throw NumericsError(format("Cholesky solve failed (CHOLMOD status %d)", c.common.status));
  rhs = Eigen::Map<const Field>(static_cast<double*>(c.solution->x), rhs.rows(), rhs.cols());
}

}  // namespace esfem
