// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linalg/block_solver.hpp"

#include <zmumps_c.h>

#include <cmath>
#include <complex>
#include <vector>

#include "solver/error.hpp"
#include "solver/linalg/thread_limit.hpp"

namespace esfem {

namespace {

using Complex = std::complex<double>;

// MUMPS's own words: jobs, symmetry, the communicator of its sequential library.
enum Job { initialise = -1, terminate = -2, analyse = 1, factorise_numbers = 2, solve_system = 3 };
const int general_symmetric = 2, sequential_communicator = -987654;
const int singular = -10;

ZMUMPS_COMPLEX* as_mumps(Complex* values) {
  return reinterpret_cast<ZMUMPS_COMPLEX*>(values);
}

}  // namespace

struct BlockSolver::Mumps {
  std::shared_ptr<const SparsityPattern> pattern;
  std::vector<int> row, column;  ///< of the entries, counted from 1
  Eigen::VectorXcd matrix;
  Eigen::MatrixXcd y;
  double alpha = 0, kappa = 0;
  bool factorised = false;
  ZMUMPS_STRUC_C instance = {};

  explicit Mumps(std::shared_ptr<const SparsityPattern> shared);
  ~Mumps() { call(terminate); }

  int call(Job job) {
    instance.job = job;
    zmumps_c(&instance);
    return instance.infog[0];
  }

  /// Control parameter `number` as MUMPS's manual counts them.
  int& control(int number) { return instance.icntl[number - 1]; }
};

BlockSolver::Mumps::Mumps(std::shared_ptr<const SparsityPattern> shared) : pattern(std::move(shared)) {
  for (int j = 0; j < pattern->size; ++j) {
    for (int k = pattern->column_start[j]; k < pattern->column_start[j + 1]; ++k) {
      row.push_back(pattern->row[k] + 1);
      column.push_back(j + 1);
    }
  }
  matrix.setZero(pattern->entry_count());
  instance.sym = general_symmetric;
  instance.par = 1;
  instance.comm_fortran = sequential_communicator;
  call(initialise);
  for (const int stream : {1, 2, 3}) control(stream) = -1;
  control(4) = 0;        // prints nothing
  control(6) = 0;        // no permutation by values: the analysis sees the pattern alone
  control(7) = 5;        // METIS: what SCOTCH orders depends on what it ordered before in the process
  control(8) = 0;        // no scaling
  control(12) = 1;       // no 2 x 2 pivots in the ordering
  control(14) = 30;      // percent of spare memory
  instance.cntl[0] = 0;  // no pivoting: see the class
  instance.n = pattern->size;
  instance.nnz = pattern->entry_count();
  instance.irn = row.data();
  instance.jcn = column.data();
  instance.a = as_mumps(matrix.data());
}

BlockSolver::BlockSolver(std::shared_ptr<const SparsityPattern> pattern) {
  const ThreadLimit one_thread;
  mumps_ = std::make_unique<Mumps>(std::move(pattern));
  if (const int status = mumps_->call(analyse); status < 0) {
    throw NumericsError(format("symbolic analysis of a block system of %d nodes failed (MUMPS status %d)",
                               mumps_->pattern->size, status));
  }
}

BlockSolver::~BlockSolver() = default;

void BlockSolver::factorise(double alpha, double beta, double gamma, const SymmetricMatrix& M,
                            const SymmetricMatrix& A) {
  const ThreadLimit one_thread;
  Mumps& m = *mumps_;
  if (!(alpha > 0 && beta > 0 && gamma > 0)) {
    throw InputError(
        format("block system: found the factors %g, %g, %g; expected positive ones", alpha, beta, gamma));
  }
  if (M.pattern != m.pattern || A.pattern != m.pattern)
    throw InputError("block system: matrix is not on the pattern that was analysed");
  m.alpha = alpha;
  m.kappa = std::sqrt(gamma / (alpha * beta));
  m.matrix.real() = M.values;
  m.matrix.imag() = m.kappa * beta * A.values;
  if (!std::isfinite(M.values.sum() + A.values.sum()))
    throw NumericsError("matrix to factorise is not finite");
  m.factorised = false;
  if (const int status = m.call(factorise_numbers); status < 0) {
    throw NumericsError(status == singular
                            ? "block system is singular"
                            : format("factorisation of a block system failed (MUMPS status %d)", status));
  }
  m.factorised = true;
}

void BlockSolver::solve(Field& r_to_u, Field& s_to_w) {
  const ThreadLimit one_thread;
  Mumps& m = *mumps_;
  if (r_to_u.rows() != m.pattern->size || s_to_w.rows() != m.pattern->size ||
      r_to_u.cols() != s_to_w.cols()) {
    throw InputError(
        format("right-hand sides of a block system are %td x %td and %td x %td, expected %d rows and "
               "the same number of columns",
               r_to_u.rows(), r_to_u.cols(), s_to_w.rows(), s_to_w.cols(), m.pattern->size));
  }
  if (!m.factorised) throw NumericsError("nothing is factorised to solve with");
  m.y.resize(r_to_u.rows(), r_to_u.cols());
  m.y.real() = m.kappa * r_to_u;
  m.y.imag() = s_to_w;
  m.instance.rhs = as_mumps(m.y.data());
  m.instance.nrhs = static_cast<int>(m.y.cols());
  m.instance.lrhs = static_cast<int>(m.y.rows());
  m.control(27) = m.instance.nrhs;  // all columns at once
  if (const int status = m.call(solve_system); status < 0)
    throw NumericsError(format("solution of a block system failed (MUMPS status %d)", status));
  r_to_u = m.y.real() / (m.kappa * m.alpha);
  s_to_w = m.y.imag();
}

}  // namespace esfem
