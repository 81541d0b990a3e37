// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linalg/block_solver.hpp"

#include <zmumps_c.h>

#include <cmath>
#include <complex>
#include <vector>

#include "solver/error.hpp"
#include "solver/linalg/metis_ordering.hpp"
#include "solver/linalg/symmetric_mumps.hpp"

namespace esfem {

using ComplexMumps = SymmetricMumps<std::complex<double>, ZMUMPS_STRUC_C, zmumps_c>;

namespace {

/// The column of each entry.
std::vector<int> columns(const SparsityPattern& pattern) {
  std::vector<int> column;
  for (int j = 0; j < pattern.size; ++j)
    column.insert(column.end(), pattern.column_start[j + 1] - pattern.column_start[j], j);
  return column;
}

}  // namespace

struct BlockSolver::Factor {
  std::shared_ptr<const SparsityPattern> pattern;
  ComplexMumps mumps;
  Eigen::MatrixXcd y;
  double alpha = 0, kappa = 0;

  explicit Factor(std::shared_ptr<const SparsityPattern> shared)
      : pattern(std::move(shared)),
        mumps("block system", pattern->row, columns(*pattern), metis_ordering(*pattern), ComplexMumps::none) {
  }
};

BlockSolver::BlockSolver(std::shared_ptr<const SparsityPattern> pattern)
    : factor_(std::make_unique<Factor>(std::move(pattern))) {}

BlockSolver::~BlockSolver() = default;

void BlockSolver::factorise(double alpha, double beta, double gamma, const SymmetricMatrix& M,
                            const SymmetricMatrix& A) {
  Factor& f = *factor_;
  if (!(alpha > 0 && beta > 0 && gamma > 0)) {
    throw InputError(
        format("block system: found the factors %g, %g, %g; expected positive ones", alpha, beta, gamma));
  }
  if (M.pattern != f.pattern || A.pattern != f.pattern)
    throw InputError("block system: matrix is not on the pattern that was analysed");
  if (!std::isfinite(M.values.sum() + A.values.sum()))
    throw NumericsError("matrix to factorise is not finite");
  f.alpha = alpha;
  f.kappa = std::sqrt(gamma / (alpha * beta));
  Eigen::Map<Eigen::VectorXcd> values(f.mumps.values(), M.values.size());
  values.real() = M.values;
  values.imag() = f.kappa * beta * A.values;
  f.mumps.factorise();
}

void BlockSolver::solve(Field& r_to_u, Field& s_to_w) {
  Factor& f = *factor_;
  if (r_to_u.rows() != f.pattern->size || s_to_w.rows() != f.pattern->size ||
      r_to_u.cols() != s_to_w.cols()) {
    throw InputError(
        format("right-hand sides of a block system are %td x %td and %td x %td, expected %d rows and "
               "the same number of columns",
               r_to_u.rows(), r_to_u.cols(), s_to_w.rows(), s_to_w.cols(), f.pattern->size));
  }
  f.y.resize(r_to_u.rows(), r_to_u.cols());
  f.y.real() = f.kappa * r_to_u;
  f.y.imag() = s_to_w;
  f.mumps.solve(f.y.data(), static_cast<int>(f.y.cols()));
  r_to_u = f.y.real() / (f.kappa * f.alpha);
  s_to_w = f.y.imag();
}

}  // namespace esfem
