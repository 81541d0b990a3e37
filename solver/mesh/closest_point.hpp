// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "solver/mesh/mesh.hpp"

namespace esfem {

/// A point of a discrete surface: reference coordinates in an element, and where it is.
struct ElementPoint {
  int element;  ///< 0-based
  double xi;    ///< in the reference triangle, as eta
  double eta;   ///< in the reference triangle
  Vec3 y;       ///< the point, X(xi, eta) of the element
};

/// The closest points of a discrete surface of any degree, for points near it.
///
/// CGAL's AABB tree finds the closest of the flat triangles through the nodes of the elements; from there
/// |X(xi, eta) - x|² is minimised by Gauss and Newton's method on the curved element, whose steps shrink by
/// distance times curvature each. Where that leaves the element, those around it, and their edges, are tried.
class ClosestPoint {
 public:
  /// The mesh must outlive the object.
  explicit ClosestPoint(const Mesh& mesh);
  ~ClosestPoint();
  /// The point of the surface that is closest to x.
  ElementPoint operator()(const Vec3& x) const;

 private:
  struct Tree;

  struct Trial {
    ElementPoint point;
    bool is_inside;  ///< of the element, not on its boundary
  };
  Trial closest_in(int element, double xi, double eta, const Vec3& x) const;
  ElementPoint closest_on_side(int element, int side, const Vec3& x) const;

  const Mesh& mesh_;
  std::vector<std::vector<int>> around_;  ///< the elements at each corner, by node
  std::unique_ptr<Tree> tree_;
};

}  // namespace esfem
