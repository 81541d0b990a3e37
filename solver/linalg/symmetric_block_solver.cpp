// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linalg/symmetric_block_solver.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "solver/error.hpp"
#include "solver/linalg/gmres.hpp"

namespace esfem {
namespace {

/// Of the backward error, the residual relative to |right-hand side| + |matrix| |solution|; a direct solution
/// with pivoting attains 1e-16.
constexpr double largest_backward_error = 1e-15;

constexpr int most_refinements = 5, most_gmres_iterations = 200;

}  // namespace

SymmetricBlockSolver::SymmetricBlockSolver(std::shared_ptr<const SparsityPattern> pattern)
    : pattern_(std::move(pattern)), factor_(*pattern_, {0, 0}, SmallPivots::are_replaced) {}

void SymmetricBlockSolver::factorise(const SymmetricMatrix& P, const SymmetricMatrix& Q,
                                     const SymmetricMatrix& R) {
  if (P.pattern != pattern_ || Q.pattern != pattern_ || R.pattern != pattern_)
    throw InputError("symmetric block system: matrix is not on the pattern that was analysed");
  P_ = &P, Q_ = &Q, R_ = &R;
  factor_.factorise([&](int k) {
    Eigen::Matrix2d block;
    block << P.values[k], Q.values[k], Q.values[k], R.values[k];
    return block;
  });
  row_size_.setZero(2 * pattern_->size, 1);
  for (int j = 0; j < pattern_->size; ++j)
    for (int k = pattern_->column_start[j]; k < pattern_->column_start[j + 1]; ++k) {
      const double q = std::abs(Q.values[k]);
      const Eigen::Vector2d sizes(std::abs(P.values[k]) + q, std::abs(R.values[k]) + q);
      row_size_.middleRows<2>(2 * j) += sizes;
      if (const int i = pattern_->row[k]; i != j) row_size_.middleRows<2>(2 * i) += sizes;
    }
}

/// out = K y; rows 2i and 2i + 1 are those of node i.
void SymmetricBlockSolver::multiply(const Field& y, Field& out) const {
  out.setZero(y.rows(), 1);
  const auto add = [&](int k, int i, int j) {
    const double u = y(2 * j), w = y(2 * j + 1);
    out(2 * i) += P_->values[k] * u + Q_->values[k] * w;
    out(2 * i + 1) += Q_->values[k] * u + R_->values[k] * w;
  };
  for (int j = 0; j < pattern_->size; ++j)
    for (int k = pattern_->column_start[j]; k < pattern_->column_start[j + 1]; ++k) {
      add(k, pattern_->row[k], j);
      if (pattern_->row[k] != j) add(k, j, pattern_->row[k]);
    }
}

void SymmetricBlockSolver::solve(Field& r_to_u, Field& s_to_w) {
  const int n = pattern_->size;
  if (r_to_u.rows() != n || s_to_w.rows() != n || r_to_u.cols() != 1 || s_to_w.cols() != 1) {
    throw InputError(
        format("right-hand sides of a symmetric block system are %td x %td and %td x %td, expected %d x 1",
               r_to_u.rows(), r_to_u.cols(), s_to_w.rows(), s_to_w.cols(), n));
  }
  right_.resize(2 * n, 1);
  for (int i = 0; i < n; ++i) right_.middleRows<2>(2 * i) << r_to_u(i), s_to_w(i);

  y_ = right_;
  factor_.solve(y_);
  const auto size = [&] {
    return right_.norm() + row_size_.cwiseProduct(y_).norm() + std::numeric_limits<double>::min();
  };
  const auto backward_error = [&] {
    multiply(y_, correction_);
    correction_ = right_ - correction_;
    return correction_.norm() / size();
  };
  double error = backward_error();
  for (int iteration = 0; iteration < most_refinements && error > largest_backward_error; ++iteration) {
    factor_.solve(correction_);
    y_ += correction_;
    error = backward_error();
  }
  if (!(error <= largest_backward_error)) {
    // K P^-1 z = the rest of the right-hand side, P the factors
    const Eigen::VectorXd rest = correction_;
    Eigen::VectorXd z = Eigen::VectorXd::Zero(rest.size());
    Field work;
    const auto map = [&](const Eigen::VectorXd& from, Eigen::VectorXd& to) {
      work = from;
      factor_.solve(work);
      multiply(work, correction_);
      to = correction_;
    };
    solve_gmres(map, rest, largest_backward_error * size() / rest.norm(), most_gmres_iterations, z);
    work = z;
    factor_.solve(work);
    y_ += work;
  }
  for (int i = 0; i < n; ++i) {
    r_to_u(i) = y_(2 * i);
    s_to_w(i) = y_(2 * i + 1);
  }
}

}  // namespace esfem
