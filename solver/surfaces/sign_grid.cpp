// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/surfaces/sign_grid.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "solver/disjoint_sets.hpp"
#include "solver/error.hpp"

namespace esfem {

SignGrid::SignGrid(const Formula& d, const Box& box, int cells) : low_(box.low) {
  const Vec3 size = box.high - box.low;
  cell_ = size.maxCoeff() / cells;
  for (int i = 0; i < 3; ++i) points_[i] = std::max(2, int(std::lround(size[i] / cell_))) + 1;
  for (int i = 0; i < 3; ++i) step_[i] = size[i] / (points_[i] - 1);
  is_inside_.reserve(std::size_t(points_[0]) * points_[1] * points_[2]);
  const CompiledFormulas compiled({d});
  Field row(points_[2], 3);
  for (int i = 0; i < points_[0]; ++i)
    for (int j = 0; j < points_[1]; ++j) {
      for (int k = 0; k < points_[2]; ++k) row.row(k) = point({i, j, k});
      const Field values = compiled(row);
      for (int k = 0; k < points_[2]; ++k) is_inside_.push_back(values(k, 0) < 0);
    }
}

Vec3 SignGrid::point(const Index& index) const {
  return low_ + Vec3(index[0] * step_[0], index[1] * step_[1], index[2] * step_[2]);
}

bool SignGrid::contains(const Index& index) const {
  for (int i = 0; i < 3; ++i)
    if (index[i] < 0 || index[i] >= points_[i]) return false;
  return true;
}

bool SignGrid::has_inside() const {
  return std::find(is_inside_.begin(), is_inside_.end(), true) != is_inside_.end();
}

bool SignGrid::is_on_side(const Index& index) const {
  for (int i = 0; i < 3; ++i)
    if (index[i] == 0 || index[i] == points_[i] - 1) return true;
  return false;
}

int SignGrid::euler_characteristic() const {
  int sum = 0;
  visit([&](const Index& corner) {
    if (is_cut(corner)) sum += chains_from(corner, 0, is_inside(corner), false, 0);
  });
  return sum;
}

int SignGrid::components() const {
  DisjointSets parts(static_cast<int>(is_inside_.size()));
  visit([&](const Index& at) {
    for (int moved = 1; moved < 8; ++moved) {
      const Index next = {at[0] + (moved & 1), at[1] + (moved >> 1 & 1), at[2] + (moved >> 2)};
      if (contains(next) && is_inside(next) == is_inside(at))
        parts.unite(static_cast<int>(number(at)), static_cast<int>(number(next)));
    }
  });
  return parts.count() - 1;
}

/// Whether the cube from a corner on has points inside and outside.
bool SignGrid::is_cut(const Index& corner) const {
  if (!contains({corner[0] + 1, corner[1] + 1, corner[2] + 1})) return false;  // all is outside there
  int inside = 0;
  for (int bits = 0; bits < 8; ++bits)
    inside += is_inside({corner[0] + (bits & 1), corner[1] + (bits >> 1 & 1), corner[2] + (bits >> 2)});
  return inside > 0 && inside < 8;
}

/// Signed number of chains that begin with a corner and that the surface cuts; `moved`: the coordinates, as
/// bits, that have grown since the corner.
int SignGrid::chains_from(const Index& corner, int moved, bool first, bool crosses, int length) const {
  int sum = length > 0 && crosses ? (length % 2 == 1 ? 1 : -1) : 0;
  for (int more = 1; more < 8; ++more) {
    if ((more & moved) != 0) continue;
    Index next = corner;
    for (int i = 0; i < 3; ++i)
      if (more & (1 << i)) ++next[i];
    if (contains(next))
      sum += chains_from(next, moved | more, first, crosses || is_inside(next) != first, length + 1);
  }
  return sum;
}

namespace {

void check_signs(const SignGrid& grid, const std::string& where) {
  bool is_inside_everywhere = true, is_outside_on_sides = false;
  std::optional<Vec3> open;
  grid.visit([&](const SignGrid::Index& index) {
    const bool is_inside = grid.is_inside(index), is_on_side = grid.is_on_side(index);
    is_inside_everywhere = is_inside_everywhere && is_inside;
    is_outside_on_sides = is_outside_on_sides || (is_on_side && !is_inside);
    if (is_inside && !open && is_on_side) open = grid.point(index);
  });
  if (!grid.has_inside())
    throw InputError(where +
                     ": the level set has no zero in the box, it is positive there; expected d < 0 "
                     "inside the surface");
  if (is_inside_everywhere)
    throw InputError(where +
                     ": the level set has no zero in the box, it is negative there; expected d > 0 "
                     "outside the surface");
  if (open && !is_outside_on_sides)
    throw InputError(where +
                     ": the level set is negative on all sides of the box; expected it negative inside the "
                     "surface and positive outside: change its sign");
  if (open)
    throw InputError(where + format(": the surface is open at the box: d < 0 at (%g, %g, %g); expected a box "
                                    "around the surface, with d > 0 on its sides",
                                    (*open)[0], (*open)[1], (*open)[2]));
}

}  // namespace

SignGrid resolving_grid(const Formula& d, const Box& box, const std::string& where) {
  SignGrid grid(d, box, 48);
  check_signs(grid, where);
  for (int cells : {96, 192}) {
    SignGrid finer(d, box, cells);
    check_signs(finer, where);
    if (finer.euler_characteristic() == grid.euler_characteristic()) return finer;
    grid = std::move(finer);
  }
  throw InputError(where +
                   ": the surface has parts finer than 1/192 of the box; expected a box that is not "
                   "larger than the surface needs");
}

}  // namespace esfem
