// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linalg/block_solver.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "solver/error.hpp"
#include "solver/linalg/symmetric_factor.hpp"

namespace esfem {

namespace {

constexpr int refined_columns = 4;  // at once

/// Four complex columns, node by node: the real parts of a node and then its imaginary parts.
using ComplexRows = Eigen::Matrix<double, Eigen::Dynamic, 2 * refined_columns, Eigen::RowMajor>;
using ColumnSizes = Eigen::Array<double, 1, refined_columns>;

/// rest = b - (M + i factor A) y.
void subtract_product(const SymmetricMatrix& M, const SymmetricMatrix& A, double factor, const ComplexRows& y,
                      const ComplexRows& b, ComplexRows& rest) {
  using Columns = Eigen::Matrix<double, refined_columns, 1>;
  const auto real = [](auto& rows, int i) { return Columns::Map(rows.row(i).data()); };
  const auto imaginary = [](auto& rows, int i) { return Columns::Map(rows.row(i).data() + refined_columns); };
  const SparsityPattern& pattern = *M.pattern;
  rest = b;
  for (int j = 0; j < pattern.size; ++j) {
    const Columns re = real(y, j), im = imaginary(y, j);
    Columns re_sum = Columns::Zero(), im_sum = Columns::Zero();
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
      const int i = pattern.row[k];
      const double m = M.values[k], a = factor * A.values[k];
      re_sum += m * real(y, i) - a * imaginary(y, i);
      im_sum += m * imaginary(y, i) + a * real(y, i);
      if (i == j) continue;
      Columns::Map(rest.row(i).data()) -= m * re - a * im;
      Columns::Map(rest.row(i).data() + refined_columns) -= m * im + a * re;
    }
    Columns::Map(rest.row(j).data()) -= re_sum;
    Columns::Map(rest.row(j).data() + refined_columns) -= im_sum;
  }
}

/// The size of each complex column.
ColumnSizes sizes(const ComplexRows& rows) {
  const Eigen::Matrix<double, 1, 2 * refined_columns> squares = rows.colwise().squaredNorm();
  return (squares.head<refined_columns>() + squares.tail<refined_columns>()).array().sqrt();
}

/// What each column's residual may be. In these units that of a direct solution is 1.5e-16 to 2e-16, for tau
/// from 1e-5 to 8e-3 and edges from 0.1 to 0.2, while it goes from 5e-16 to 7e-14 relative to b.
ColumnSizes attainable(const SymmetricMatrix& M, const SymmetricMatrix& A, double factor,
                       const ComplexRows& y, const ComplexRows& b, ComplexRows& work) {
  for (int j = 0; j < y.rows(); ++j) {
    const int diagonal = M.pattern->column_start[j];
    const double re = M.values[diagonal], im = factor * A.values[diagonal];
    work.row(j) = std::sqrt(re * re + im * im) * y.row(j);
  }
  return 5e-16 * (sizes(b) + sizes(work)) + std::numeric_limits<double>::min();
}

}  // namespace

struct BlockSolver::Factor {
  std::shared_ptr<const SparsityPattern> pattern;
  SymmetricFactor<std::complex<double>> factor;
  double alpha = 0, kappa = 0;
  ComplexRows b, refined, rest;

  explicit Factor(std::shared_ptr<const SparsityPattern> shared)
      : pattern(std::move(shared)),
        factor(*pattern, {0}),
        b(pattern->size, 2 * refined_columns),
        refined(b),
        rest(b) {}

  /// Solves (M + i beta_kappa A) y = b from the guess y = refined, see BlockSolver::refine.
  std::optional<int> refine(double beta_kappa, const SymmetricMatrix& M, const SymmetricMatrix& A, int most) {
    const auto excess = [&] {
      const ColumnSizes bound = attainable(M, A, beta_kappa, refined, b, rest);
      subtract_product(M, A, beta_kappa, refined, b, rest);
      return (sizes(rest) / bound).maxCoeff<Eigen::PropagateNaN>();
    };
    double before = excess();
    for (int n = 1; n <= most; ++n) {
      add_solution_of_rest();
      const double now = excess();
      if (now <= 1) return n;
      if (!(now * std::pow(now / before, most - n) <= 1)) break;
      before = now;
    }
    return {};
  }

  /// One iteration of the refinement.
  void add_solution_of_rest() {
    factor.solve(
        refined_columns,
        [&](int i, int c) { return std::complex<double>(rest(i, c), rest(i, refined_columns + c)); },
        [&](int i, int c, const std::complex<double>& y) {
          refined(i, c) += y.real();
          refined(i, refined_columns + c) += y.imag();
        });
  }
};

BlockSolver::BlockSolver(std::shared_ptr<const SparsityPattern> pattern)
    : factor_(std::make_unique<Factor>(std::move(pattern))) {}

BlockSolver::~BlockSolver() = default;

void BlockSolver::check_system(double alpha, double beta, double gamma, const SymmetricMatrix& M,
                               const SymmetricMatrix& A) const {
  if (!(alpha > 0 && beta > 0 && gamma > 0)) {
    throw InputError(
        format("block system: found the factors %g, %g, %g; expected positive ones", alpha, beta, gamma));
  }
  if (M.pattern != factor_->pattern || A.pattern != factor_->pattern)
    throw InputError("block system: matrix is not on the pattern that was analysed");
}

void BlockSolver::check_columns(const Field& r, const Field& other) const {
  if (r.rows() == factor_->pattern->size && other.rows() == r.rows() && other.cols() == r.cols()) return;
  throw InputError(
      format("fields of a block system are %td x %td and %td x %td, expected %d rows and the same number of "
             "columns",
             r.rows(), r.cols(), other.rows(), other.cols(), factor_->pattern->size));
}

void BlockSolver::factorise(double alpha, double beta, double gamma, const SymmetricMatrix& M,
                            const SymmetricMatrix& A) {
  Factor& f = *factor_;
  check_system(alpha, beta, gamma, M, A);
  f.alpha = alpha;
  f.kappa = std::sqrt(gamma / (alpha * beta));
  f.factor.factorise([m = M.values.data(), s = A.values.data(), factor = f.kappa * beta](int k) {
    return std::complex<double>(m[k], factor * s[k]);
  });
}

void BlockSolver::solve(Field& r_to_u, Field& s_to_w) {
  Factor& f = *factor_;
  check_columns(r_to_u, s_to_w);
  f.factor.solve(
      static_cast<int>(r_to_u.cols()),
      [&](int i, int c) { return std::complex<double>(f.kappa * r_to_u(i, c), s_to_w(i, c)); },
      [&](int i, int c, const std::complex<double>& y) {
        r_to_u(i, c) = y.real() / (f.kappa * f.alpha);
        s_to_w(i, c) = y.imag();
      });
}

std::optional<int> BlockSolver::refine(double alpha, double beta, double gamma, const SymmetricMatrix& M,
                                       const SymmetricMatrix& A, const Field& r, const Field& s, int most,
                                       Field& u, Field& w) {
  Factor& f = *factor_;
  check_system(alpha, beta, gamma, M, A);
  for (const Field* field : std::initializer_list<const Field*>{&s, &u, &w}) check_columns(r, *field);
  const double kappa = std::sqrt(gamma / (alpha * beta));
  std::optional<int> iterations = 1;
  for (Eigen::Index first = 0; first < r.cols(); first += refined_columns) {
    const Eigen::Index count = std::min<Eigen::Index>(refined_columns, r.cols() - first);
    const auto put = [&](ComplexRows& rows, double factor, const Field& real, const Field& imaginary) {
      if (count < refined_columns) rows.setZero();
      rows.leftCols(count) = factor * real.middleCols(first, count);
      rows.middleCols(refined_columns, count) = imaginary.middleCols(first, count);
    };
    put(f.b, kappa, r, s);
    put(f.refined, kappa * alpha, u, w);
    const std::optional<int> of_group = f.refine(kappa * beta, M, A, most);
    u.middleCols(first, count) = f.refined.leftCols(count) / (kappa * alpha);
    w.middleCols(first, count) = f.refined.middleCols(refined_columns, count);
    iterations = iterations && of_group ? std::max(iterations, of_group) : std::nullopt;
  }
  return iterations;
}

}  // namespace esfem
