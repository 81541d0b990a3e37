// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linalg/spd_solver.hpp"

#include <utility>

#include "solver/error.hpp"

namespace esfem {

SpdSolver::SpdSolver(std::shared_ptr<const SparsityPattern> pattern)
    : pattern_(std::move(pattern)), factor_(*pattern_, {1}) {}

void SpdSolver::factorise(double a, const SymmetricMatrix& M, double b, const SymmetricMatrix& A) {
  if (M.pattern != pattern_ || A.pattern != pattern_)
    throw InputError("matrix is not on the pattern that was analysed");
  factor_.factorise([a, b, m = M.values.data(), s = A.values.data()](int k) { return a * m[k] + b * s[k]; });
}

}  // namespace esfem
