// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

#include "solver/formulas/formula.hpp"
#include "solver/surfaces/formula_surface.hpp"

namespace esfem {

/// The signs of a formula d(x, y, z) in the points of a grid of equal cells that fill a box, and the topology
/// of the surface {d = 0} that they show.
class SignGrid {
 public:
  /// `cells`: along the longest side. Throws InputError where d has no finite value.
  SignGrid(const Formula& d, const Box& box, int cells);

  /// Numbers of a point along x, y and z, from 0 on.
  using Index = std::array<int, 3>;

  /// Edge length of the cells along the longest side.
  double cell() const { return cell_; }
  /// A point in space.
  Vec3 point(const Index& index) const;
  /// Is d < 0 there? The index must be in the grid.
  bool is_inside(const Index& index) const { return is_inside_[number(index)]; }
  /// Is the index in the grid?
  bool contains(const Index& index) const;
  /// Is d < 0 anywhere?
  bool has_inside() const;
  /// Is the point on a side of the box?
  bool is_on_side(const Index& index) const;

  /// Calls each(index) for all points.
  template <class Visit>
  void visit(const Visit& each) const {
    for (int i = 0; i < points_[0]; ++i)
      for (int j = 0; j < points_[1]; ++j)
        for (int k = 0; k < points_[2]; ++k) each(Index{i, j, k});
  }

  /// Of the surface that cuts the edges of Kuhn's simplices (each is a chain of corners of a cube that grow
  /// in all coordinates): a vertex in each edge, an edge in each triangle, a face in each tetrahedron it
  /// cuts.
  int euler_characteristic() const;

  /// Of the same surface: there is one more part of the box inside or outside than it has components.
  int components() const;

 private:
  std::size_t number(const Index& index) const {
    return (std::size_t(index[0]) * points_[1] + index[1]) * points_[2] + index[2];
  }
  bool is_cut(const Index& corner) const;
  int chains_from(const Index& corner, int moved, bool first, bool crosses, int length) const;

  Vec3 low_;
  double cell_;
  int points_[3];
  double step_[3];
  std::vector<bool> is_inside_;
};

/// The coarsest of some grids that has the topology of the next finer one. Throws InputError, headed by
/// `where`, when d has one sign in the box, when the surface leaves the box, or is too fine for the grids.
SignGrid resolving_grid(const Formula& d, const Box& box, const std::string& where);

}  // namespace esfem
