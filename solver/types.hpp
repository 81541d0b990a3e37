// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Dense>

/// The library. The main page lists its folders.
namespace esfem {

/// A point or a vector in space, as a column.
using Vec3 = Eigen::Vector3d;
/// A linear map of vectors in space: a Hessian, a Weingarten map.
using Mat3 = Eigen::Matrix3d;

/// Nodal values of a finite element function: N rows (nodes) x components, column-major, so that column l is
/// block l of the papers' stacked vectors (their entry j + (l-1)N). Positions x, normals, velocities: N x 3.
using Field = Eigen::MatrixXd;

/// Node numbers of the elements, one row an element (0-based).
using Connectivity = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace esfem
