// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Dense>

namespace esfem {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// Nodal values of a finite element function: N rows (nodes) x components, column-major, so that column l is
/// block l of the papers' stacked vectors (their entry j + (l-1)N). Positions x, normals, velocities: N x 3.
using Field = Eigen::MatrixXd;

/// Node numbers of the elements, one row an element (0-based).
using Connectivity = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace esfem
