// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/fe/lagrange.hpp"

#include <array>
#include <vector>

#include "solver/error.hpp"

namespace esfem {
namespace {

/// k times the barycentric coordinates of a node: three integers with sum k.
using LatticePoint = std::array<int, 3>;

std::vector<LatticePoint> lattice(int k) {
  std::vector<LatticePoint> nodes = {{k, 0, 0}, {0, k, 0}, {0, 0, k}};
  for (int edge = 0; edge < 3; ++edge)
    for (int m = 1; m < k; ++m) {
      LatticePoint node = {0, 0, 0};
      node[edge] = k - m;
      node[(edge + 1) % 3] = m;
      nodes.push_back(node);
    }
  if (k == 3) nodes.push_back({1, 1, 1});
  if (k == 4) nodes.insert(nodes.end(), {{2, 1, 1}, {1, 2, 1}, {1, 1, 2}});
  return nodes;
}

struct Factors {
  std::array<double, max_degree + 1> value, derivative;
};

/// The polynomials of degree n = 0..k in one barycentric coordinate that vanish at 0, 1/k, ..., (n-1)/k and
/// are 1 at n/k; a shape function is a product of three of them.
Factors factors(int k, double coordinate) {
  Factors p{};
  p.value[0] = 1;
  for (int n = 0; n < k; ++n) {
    const double scale = 1.0 / (n + 1), root = k * coordinate - n;
    p.value[n + 1] = scale * p.value[n] * root;
    p.derivative[n + 1] = scale * (p.derivative[n] * root + p.value[n] * k);
  }
  return p;
}

}  // namespace

int nodes_per_element(int degree) {
  if (degree < 1 || degree > max_degree)
    throw InputError(format("degree %d of the finite elements: expected 1 to %d", degree, max_degree));
  return (degree + 1) * (degree + 2) / 2;
}

Eigen::Matrix<double, Eigen::Dynamic, 2> reference_nodes(int degree) {
  Eigen::Matrix<double, Eigen::Dynamic, 2> nodes(nodes_per_element(degree), 2);
  int row = 0;
  for (const LatticePoint& node : lattice(degree))
    nodes.row(row++) << double(node[1]) / degree, double(node[2]) / degree;
  return nodes;
}

ShapeTable shape_functions(int degree, const Eigen::Matrix<double, Eigen::Dynamic, 2>& points) {
  const int nodes = nodes_per_element(degree);
  ShapeTable table;
  table.value.resize(points.rows(), nodes);
  table.dxi.resize(points.rows(), nodes);
  table.deta.resize(points.rows(), nodes);
  const std::vector<LatticePoint> index = lattice(degree);
  for (int q = 0; q < points.rows(); ++q) {
    const double xi = points(q, 0), eta = points(q, 1);
    const Factors a = factors(degree, 1 - xi - eta), b = factors(degree, xi), c = factors(degree, eta);
    for (int n = 0; n < nodes; ++n) {
      const auto [i, j, l] = index[n];
      const double d0 = a.derivative[i] * b.value[j] * c.value[l];
      table.value(q, n) = a.value[i] * b.value[j] * c.value[l];
      table.dxi(q, n) = a.value[i] * b.derivative[j] * c.value[l] - d0;
      table.deta(q, n) = a.value[i] * b.value[j] * c.derivative[l] - d0;
    }
  }
  return table;
}

}  // namespace esfem
