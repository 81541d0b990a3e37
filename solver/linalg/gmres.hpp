// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "solver/types.hpp"

namespace esfem {

/// A square linear map: writes the image of `from` into `to`, which has the same size.
using LinearMap = std::function<void(const Eigen::VectorXd& from, Eigen::VectorXd& to)>;

/// Solves map(y) = rhs by GMRES from the guess in y, until the residual is at most `tolerance` times that of
/// y = 0. Returns the number of iterations. Throws NumericsError when `most_iterations` do not suffice.
int solve_gmres(const LinearMap& map, const Eigen::VectorXd& rhs, double tolerance, int most_iterations,
                Eigen::VectorXd& y);

}  // namespace esfem
