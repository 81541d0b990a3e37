// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/peers/mumps_block_solver.hpp"

#include <dmumps_c.h>
#include <zmumps_c.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include "solver/error.hpp"
#include "solver/linalg/metis_ordering.hpp"
#include "tests/peers/symmetric_mumps.hpp"

namespace esfem {

using ComplexMumps = SymmetricMumps<std::complex<double>, ZMUMPS_STRUC_C, zmumps_c>;
using RealMumps = SymmetricMumps<double, DMUMPS_STRUC_C, dmumps_c>;

namespace {

/// Calls visit(k, i, j) for each entry of the pattern, the k-th, in row i and column j.
template <class Visit>
void for_each_entry(const SparsityPattern& pattern, const Visit& visit) {
  for (int j = 0; j < pattern.size; ++j)
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) visit(k, pattern.row[k], j);
}

/// The column of each entry.
std::vector<int> columns(const SparsityPattern& pattern) {
  std::vector<int> column;
  for_each_entry(pattern, [&](int, int, int j) { column.push_back(j); });
  return column;
}

/// Rows and columns of the lower triangle; unknowns 2i and 2i+1 are u and w of node i.
std::pair<std::vector<int>, std::vector<int>> entries_of_blocks(const SparsityPattern& pattern) {
  std::vector<int> row, column;
  const auto add = [&](int i, int j) {
    row.push_back(std::max(i, j));
    column.push_back(std::min(i, j));
  };
  for_each_entry(pattern, [&](int, int i, int j) {
    add(2 * i, 2 * j);
    add(2 * i + 1, 2 * j + 1);
    add(2 * i + 1, 2 * j);
    if (i != j) add(2 * i, 2 * j + 1);
  });
  return {row, column};
}

/// Both unknowns of a node follow each other.
std::vector<int> ordering_of_blocks(const SparsityPattern& pattern) {
  std::vector<int> ordering;
  for (const int node : metis_ordering(pattern)) {
    ordering.push_back(2 * node);
    ordering.push_back(2 * node + 1);
  }
  return ordering;
}

}  // namespace

struct MumpsBlockSolver::Factor {
  ComplexMumps mumps;
  Eigen::MatrixXcd y;
  double alpha = 0, kappa = 0;
};

MumpsBlockSolver::MumpsBlockSolver(std::shared_ptr<const SparsityPattern> pattern)
    : factor_(new Factor{
          {"block system", pattern->row, columns(*pattern), metis_ordering(*pattern), ComplexMumps::none},
          {}}) {}

MumpsBlockSolver::~MumpsBlockSolver() = default;

void MumpsBlockSolver::factorise(double alpha, double beta, double gamma, const SymmetricMatrix& M,
                                 const SymmetricMatrix& A) {
  Factor& f = *factor_;
  f.alpha = alpha;
  f.kappa = std::sqrt(gamma / (alpha * beta));
  Eigen::Map<Eigen::VectorXcd> values(f.mumps.values(), M.values.size());
  values.real() = M.values;
  values.imag() = f.kappa * beta * A.values;
  f.mumps.factorise();
}

void MumpsBlockSolver::solve(Field& r_to_u, Field& s_to_w) {
  Factor& f = *factor_;
  f.y.resize(r_to_u.rows(), r_to_u.cols());
  f.y.real() = f.kappa * r_to_u;
  f.y.imag() = s_to_w;
  f.mumps.solve(f.y.data(), static_cast<int>(f.y.cols()));
  r_to_u = f.y.real() / (f.kappa * f.alpha);
  s_to_w = f.y.imag();
}

struct MumpsSymmetricBlockSolver::Factor {
  std::shared_ptr<const SparsityPattern> pattern;
  RealMumps mumps;
  Eigen::VectorXd y;

  Factor(std::shared_ptr<const SparsityPattern> shared,
         std::pair<std::vector<int>, std::vector<int>> rows_and_columns)
      : pattern(std::move(shared)),
        mumps("symmetric block system", std::move(rows_and_columns.first), std::move(rows_and_columns.second),
              ordering_of_blocks(*pattern), RealMumps::by_threshold),
        y(2 * pattern->size) {}
};

MumpsSymmetricBlockSolver::MumpsSymmetricBlockSolver(std::shared_ptr<const SparsityPattern> pattern)
    : factor_(std::make_unique<Factor>(pattern, entries_of_blocks(*pattern))) {}

MumpsSymmetricBlockSolver::~MumpsSymmetricBlockSolver() = default;

void MumpsSymmetricBlockSolver::factorise(const SymmetricMatrix& P, const SymmetricMatrix& Q,
                                          const SymmetricMatrix& R) {
  Factor& f = *factor_;
  if (P.pattern != f.pattern || Q.pattern != f.pattern || R.pattern != f.pattern)
    throw InputError("symmetric block system: matrix is not on the pattern that was analysed");
  if (!std::isfinite(P.values.sum() + Q.values.sum() + R.values.sum()))
    throw NumericsError("matrix to factorise is not finite");
  double* value = f.mumps.values();
  for_each_entry(*f.pattern, [&](int k, int i, int j) {
    *value++ = P.values[k];
    *value++ = R.values[k];
    *value++ = Q.values[k];
    if (i != j) *value++ = Q.values[k];
  });
  f.mumps.factorise();
}

void MumpsSymmetricBlockSolver::solve(Field& r_to_u, Field& s_to_w) {
  Factor& f = *factor_;
  const int n = f.pattern->size;
  if (r_to_u.rows() != n || s_to_w.rows() != n || r_to_u.cols() != 1 || s_to_w.cols() != 1) {
    throw InputError(
        format("right-hand sides of a symmetric block system are %td x %td and %td x %td, expected %d x 1",
               r_to_u.rows(), r_to_u.cols(), s_to_w.rows(), s_to_w.cols(), n));
  }
  for (int i = 0; i < n; ++i) {
    f.y[2 * i] = r_to_u(i);
    f.y[2 * i + 1] = s_to_w(i);
  }
  f.mumps.solve(f.y.data(), 1);
  for (int i = 0; i < n; ++i) {
    r_to_u(i) = f.y[2 * i];
    s_to_w(i) = f.y[2 * i + 1];
  }
}

}  // namespace esfem
