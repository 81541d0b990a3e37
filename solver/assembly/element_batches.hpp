// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <vector>

#include "solver/fe/quadrature.hpp"
#include "solver/pack.hpp"
#include "solver/types.hpp"

namespace esfem {

/// Those of an element of degree max_degree.
constexpr int max_nodes_per_element = 15;

/// pack_size elements that are treated as one, at given positions of the nodes.
struct Batch {
  int number;                        ///< among those of the ElementBatches, from 0
  const int* node;                   ///< node[pack_size a + lane] is local node a of the lane's element
  Pack one;                          ///< 1, and 0 in lanes that only fill the last batch up
  Pack x[max_nodes_per_element][3];  ///< positions of the nodes
  Pack direction[3];                 ///< unit normal of the corner triangle
  Pack size;                         ///< square of the longest edge between corners
};

/// The first order geometry of the element map at one quadrature point of a batch.
struct BatchPoint {
  Pack tangent_xi[3];     ///< derivative of the element map with respect to xi
  Pack tangent_eta[3];    ///< with respect to eta
  Pack normal[3];         ///< t_xi x t_eta; its length is the Jacobian
  Pack jacobian;          ///< |normal|: area on the surface per area dxi deta
  Pack inverse_jacobian;  ///< 1/|normal|

  /// From the tangents.
  void set_normal() {
    cross(tangent_xi, tangent_eta, normal);
    const Pack squared = dot(normal, normal);
    inverse_jacobian = inverse_sqrt(squared);
    jacobian = squared * inverse_jacobian;
  }
};

/// Contravariant tangents: grad u = u_xi dual_xi + u_eta dual_eta, from the first fundamental form.
struct DualTangents {
  Pack xi[3];   ///< xi . t_xi = 1, xi . t_eta = 0
  Pack eta[3];  ///< eta . t_xi = 0, eta . t_eta = 1

  /// The inverse of the first fundamental form, applied to the tangents, is t_eta x n and n x t_xi over |n|².
  explicit DualTangents(const BatchPoint& point) {
    cross(point.tangent_eta, point.normal, xi);
    cross(point.normal, point.tangent_xi, eta);
    const Pack scale = point.inverse_jacobian * point.inverse_jacobian;
    for (int i = 0; i < 3; ++i) {
      xi[i] *= scale;
      eta[i] *= scale;
    }
  }
};

/// The elements of a mesh in batches of pack_size, with the shape functions at the points of a quadrature
/// rule. The last batch is filled up with repetitions of the last element, which count zero times.
class ElementBatches {
 public:
  /// One shape function at one quadrature point.
  struct Shape {
    double value;  ///< phi_a
    double dxi;    ///< d phi_a/d xi
    double deta;   ///< d phi_a/d eta
  };

  /// Copies what it needs of the elements, which are of this degree, and of the rule.
  ElementBatches(const Connectivity& elements, int degree, const Quadrature& rule);

  /// The number of batches.
  int count() const { return (element_count_ + pack_size - 1) / pack_size; }
  /// The number of nodes of an element.
  int nodes() const { return nodes_; }
  /// The number of points of the rule.
  int points() const { return static_cast<int>(weights_.size()); }
  /// The weight of a point, on the reference triangle of area 1/2.
  double weight(int point) const { return weights_[point]; }
  /// The `nodes()` shape functions at a point.
  const Shape* shapes(int point) const { return &shapes_[point * nodes_]; }
  /// The lane's element; a repetition has the number of the element that it repeats.
  int element(int batch, int lane) const { return std::min(batch * pack_size + lane, element_count_ - 1); }

  /// Collects the positions of a batch's nodes.
  void load(int number, const Field& x, Batch& batch) const;

  /// out[a] = value of column c at local node a.
  void gather(const Batch& batch, const Field& u, int c, Pack* out) const {
    for (int a = 0; a < nodes_; ++a)
      for (int lane = 0; lane < pack_size; ++lane)
        out[a][lane] = u.data()[c * u.rows() + batch.node[pack_size * a + lane]];
  }

  /// out[a][c] = value of component c < components at local node a.
  template <int width>
  void gather(const Batch& batch, const Field& u, int components, Pack (*out)[width]) const {
    for (int a = 0; a < nodes_; ++a)
      for (int c = 0; c < components; ++c)
        for (int lane = 0; lane < pack_size; ++lane)
          out[a][c][lane] = u.data()[c * u.rows() + batch.node[pack_size * a + lane]];
  }

  /// Geometry at a quadrature point. Lanes whose Jacobian is finite and positive relative to the element's
  /// size are true in the result.
  [[gnu::always_inline]] Lanes evaluate(const Batch& batch, int point, BatchPoint& out) const {
    for (int i = 0; i < 3; ++i) out.tangent_xi[i] = out.tangent_eta[i] = Pack{};
    const Shape* shape = shapes(point);
    for (int a = 0; a < nodes_; ++a) {
      for (int i = 0; i < 3; ++i) {
        out.tangent_xi[i] += shape[a].dxi * batch.x[a][i];
        out.tangent_eta[i] += shape[a].deta * batch.x[a][i];
      }
    }
    out.set_normal();
    const Pack upright = dot(out.normal, batch.direction);
    return (upright > smallest_jacobian * batch.size) & (upright < largest_jacobian * batch.size);
  }

  /// Throws NumericsError for the first lane that is false.
  void require_regular(const Lanes& regular, const Batch& batch) const {
    if (!all(regular)) report_degenerate(batch);
  }

 private:
  /// Bounds of the Jacobian (twice the area for a flat triangle) relative to the square of the longest edge.
  static constexpr double smallest_jacobian = 1e-10, largest_jacobian = 1e10;

  [[noreturn]] void report_degenerate(const Batch& batch) const;

  int element_count_, nodes_;
  std::vector<int> node_;  ///< batches x nodes x lanes
  std::vector<double> weights_;
  std::vector<Shape> shapes_;  ///< points x nodes
};

}  // namespace esfem
