// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/reconnect.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "solver/error.hpp"
#include "solver/mesh/sides.hpp"

namespace esfem {

namespace {

/// The lengths of the three sides.
std::array<double, 3> side_lengths(const Mesh& mesh, int element) {
  std::array<double, 3> lengths;
  for (int i = 0; i < 3; ++i)
    lengths[i] =
        (mesh.nodes.row(mesh.elements(element, (i + 1) % 3)) - mesh.nodes.row(mesh.elements(element, i)))
            .norm();
  return lengths;
}

/// Exchanges the longest side of a flat element; returns whether that was possible.
bool flip_longest_side(Mesh& mesh, const std::vector<int>& twin, int element, std::vector<bool>& changed) {
  const std::array<double, 3> lengths = side_lengths(mesh, element);
  const int side = 3 * element + int(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
  const int other = twin[side], neighbour = other / 3;
  // A flat neighbour is flipped itself first.
  if (other < 0 || changed[element] || changed[neighbour] || has_no_area(mesh, neighbour)) return false;
  const int middle = side_corner(mesh.elements, side_after(side), 1);
  const int a = side_corner(mesh.elements, other, 0), b = side_corner(mesh.elements, other, 1),
            opposite = side_corner(mesh.elements, side_after(other), 1);
  if (middle == opposite) return false;
  mesh.elements.row(neighbour) << a, middle, opposite;
  mesh.elements.row(element) << middle, b, opposite;
  changed[element] = changed[neighbour] = true;
  return true;
}

/// The sides that start at one corner, of the elements around it that are neighbours; `start` is one of them.
std::vector<int> fan_of(const Connectivity& elements, const std::vector<int>& twin, int start) {
  const int node = side_corner(elements, start, 0);
  std::vector<int> fan;
  int corner = start, crossed = start;  // the side that starts at the node, and the one to leave through
  do {
    fan.push_back(corner);
    const int side = twin[crossed];
    // Elements need not be oriented alike: the side starts or ends at the node.
    const bool starts = side_corner(elements, side, 0) == node;
    corner = starts ? side : side_after(side);
    crossed = starts ? side_before(side) : side_after(side);
  } while (corner != start);
  return fan;
}

}  // namespace

bool has_no_area(const Mesh& mesh, int element) {
  const Vec3 a = mesh.nodes.row(mesh.elements(element, 0)), b = mesh.nodes.row(mesh.elements(element, 1)),
             c = mesh.nodes.row(mesh.elements(element, 2));
  const std::array<double, 3> lengths = side_lengths(mesh, element);
  const double longest = *std::max_element(lengths.begin(), lengths.end());
  return !(0.5 * (b - a).cross(c - a).norm() > 1e-10 * longest * longest);
}

void flip_flat_elements(MeshFile& file) {
  Mesh& mesh = file.mesh;
  if (mesh.degree != 1) return;
  std::vector<int> flat;
  for (int e = 0; e < mesh.elements.rows(); ++e)
    if (has_no_area(mesh, e)) flat.push_back(e);
  const std::size_t found = flat.size();
  // Each time those whose neighbour is not flat: as often as flat elements lie one behind the other.
  for (int flips = 1; flips > 0 && !flat.empty();) {
    flips = 0;
    const std::vector<int> twin = side_twins(mesh.elements);
    std::vector<bool> changed(mesh.elements.rows(), false);
    std::vector<int> rest;
    for (int e : flat)
      if (flip_longest_side(mesh, twin, e, changed) && !has_no_area(mesh, e))
        ++flips;
      else
        rest.push_back(e);
    flat = std::move(rest);
  }
  if (const std::size_t flipped = found - flat.size(); flipped > 0)
    file.remarks.push_back(format("%zu element%s with three corners on a line: flipped with the neighbour",
                                  flipped, flipped > 1 ? "s" : ""));
}

void split_touching_nodes(MeshFile& file) {
  Mesh& mesh = file.mesh;
  const std::vector<int> twin = side_twins(mesh.elements);
  if (std::any_of(twin.begin(), twin.end(), [](int side) { return side < 0; })) return;
  std::vector<bool> seen(twin.size(), false), taken(mesh.nodes.rows(), false);
  std::vector<int> copied;
  const Connectivity before = mesh.elements;
  const int n = int(mesh.nodes.rows());
  for (int start = 0; start < int(twin.size()); ++start) {
    if (seen[start]) continue;
    const int node = side_corner(before, start, 0);
    const std::vector<int> fan = fan_of(before, twin, start);
    for (int side : fan) {
      seen[side] = true;
      if (taken[node]) mesh.elements(side / 3, side % 3) = n + int(copied.size());
    }
    if (taken[node]) copied.push_back(node);
    taken[node] = true;
  }
  if (copied.empty()) return;
  std::vector<int> sources(n);
  std::iota(sources.begin(), sources.end(), 0);
  sources.insert(sources.end(), copied.begin(), copied.end());
  mesh.nodes = Field(mesh.nodes(sources, Eigen::all));
  for (NodalField& field : file.fields) field.values = Field(field.values(sources, Eigen::all));
  MeshOrigin& origin = file.origin;
  number_by_position(origin.node_tags, n);
  for (int i : copied) {
    origin.node_tags.push_back(long(origin.node_tags[i]));
    if (!origin.node_lines.empty()) origin.node_lines.push_back(int(origin.node_lines[i]));
  }
  file.remarks.push_back(format("%zu node%s where the surface touches itself: added", copied.size(),
                                copied.size() > 1 ? "s" : ""));
}

}  // namespace esfem
