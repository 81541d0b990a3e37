// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Dense>

namespace esfem {

/// Largest degree k of elements P_k.
constexpr int max_degree = 4;

/// Number of nodes of a P_k triangle: (k+1)(k+2)/2. Throws InputError unless 1 <= k <= 4.
int nodes_per_element(int degree);

/// Nodes of the P_k reference triangle {xi, eta >= 0, xi + eta <= 1}, one row (xi, eta) a node.
/// Order (Gmsh's, recursive): corners 0, 1, 2; edges 01, 12, 20, each from its first corner to its second;
/// then the inner nodes, for k = 4 as the corners of the inner triangle.
Eigen::Matrix<double, Eigen::Dynamic, 2> reference_nodes(int degree);

/// Shape functions and their reference derivatives, each (points x nodes).
struct ShapeTable {
  Eigen::MatrixXd value;  ///< phi_a
  Eigen::MatrixXd dxi;    ///< d phi_a/d xi
  Eigen::MatrixXd deta;   ///< d phi_a/d eta
};

/// P_k Lagrange shape functions at points (rows xi, eta).
ShapeTable shape_functions(int degree, const Eigen::Matrix<double, Eigen::Dynamic, 2>& points);

}  // namespace esfem
