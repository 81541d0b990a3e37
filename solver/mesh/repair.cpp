// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/repair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "solver/error.hpp"
#include "solver/mesh/reconnect.hpp"
#include "solver/mesh/sides.hpp"

namespace esfem {

namespace {

constexpr double joining_distance = 1e-6;  ///< in diagonals of the bounding box

template <class Value>
void keep(std::vector<Value>& values, const std::vector<int>& kept) {
  if (values.empty()) return;
  std::vector<Value> result;
  for (int i : kept) result.push_back(values[i]);
  values = std::move(result);
}

/// Returns how many nodes were dropped.
int drop_unused_nodes(MeshFile& file) {
  Mesh& mesh = file.mesh;
  const int n = int(mesh.nodes.rows());
  std::vector<int> number(n, -1), kept;
  for (int i : mesh.elements.reshaped()) number[i] = 0;
  for (int i = 0; i < n; ++i)
    if (number[i] == 0) {
      number[i] = int(kept.size());
      kept.push_back(i);
    }
  if (int(kept.size()) == n) return 0;
  const Field nodes = mesh.nodes(kept, Eigen::all);
  mesh.nodes = nodes;
  for (NodalField& field : file.fields) field.values = Field(field.values(kept, Eigen::all));
  for (int& i : mesh.elements.reshaped()) i = number[i];
  number_by_position(file.origin.node_tags, n);
  keep(file.origin.node_tags, kept);
  keep(file.origin.node_lines, kept);
  return n - int(kept.size());
}

/// The nodes on open sides, corners and others, in their order.
std::vector<int> open_nodes(const Mesh& mesh) {
  const std::vector<int> twin = side_twins(mesh.elements);
  const int on_edge = mesh.degree - 1;
  std::vector<bool> open(mesh.nodes.rows(), false);
  for (int side = 0; side < int(twin.size()); ++side) {
    if (twin[side] != open_side) continue;
    for (int i : {0, 1}) open[side_corner(mesh.elements, side, i)] = true;
    for (int i = 0; i < on_edge; ++i) open[mesh.elements(side / 3, 3 + side % 3 * on_edge + i)] = true;
  }
  std::vector<int> nodes;
  for (int i = 0; i < int(open.size()); ++i)
    if (open[i]) nodes.push_back(i);
  return nodes;
}

/// For each node, the node whose place it takes, not larger than it.
using Targets = std::vector<int>;

Targets no_targets(const Mesh& mesh) {
  Targets target(mesh.nodes.rows());
  std::iota(target.begin(), target.end(), 0);
  return target;
}

Targets equal_nodes(const Mesh& mesh, std::vector<int> nodes) {
  const auto place = [&mesh](int i) {
    return std::array<double, 3>{mesh.nodes(i, 0), mesh.nodes(i, 1), mesh.nodes(i, 2)};
  };
  std::stable_sort(nodes.begin(), nodes.end(), [&](int i, int j) { return place(i) < place(j); });
  Targets target = no_targets(mesh);
  for (std::size_t k = 1; k < nodes.size(); ++k)
    if (place(nodes[k]) == place(nodes[k - 1])) target[nodes[k]] = target[nodes[k - 1]];
  return target;
}

/// A quarter of the shortest edge of the elements at each node, but no more than `limit`.
std::vector<double> reach_of_nodes(const Mesh& mesh, double limit) {
  std::vector<double> reach(mesh.nodes.rows(), limit);
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    double shortest = 4 * limit;
    for (int i = 0; i < 3; ++i) {
      const double edge =
          (mesh.nodes.row(mesh.elements(e, i)) - mesh.nodes.row(mesh.elements(e, (i + 1) % 3))).norm();
      // Two corners in one place are no scale.
      if (edge > 0) shortest = std::min(shortest, edge);
    }
    for (int i : mesh.elements.row(e)) reach[i] = std::min(reach[i], shortest / 4);
  }
  return reach;
}

/// The cubes of a grid, by number; a point's neighbours within the width of a cube are in the 27 around it.
class Grid {
 public:
  Grid(const Vec3& corner, double width) : corner_(corner), width_(width) {}

  void add(const Vec3& x, int node) { nodes_[key(cube(x))].push_back(node); }
  template <class Use>
  void for_each_around(const Vec3& x, Use use) const {
    const auto [a, b, c] = cube(x);
    for (std::int64_t i = a - 1; i <= a + 1; ++i)
      for (std::int64_t j = b - 1; j <= b + 1; ++j)
        for (std::int64_t k = c - 1; k <= c + 1; ++k)
          if (const auto found = nodes_.find(key({i, j, k})); found != nodes_.end())
            for (int node : found->second) use(node);
  }

 private:
  using Cube = std::array<std::int64_t, 3>;
  Cube cube(const Vec3& x) const {
    const Vec3 scaled = (x - corner_) / width_;
    return {std::int64_t(scaled[0]), std::int64_t(scaled[1]), std::int64_t(scaled[2])};
  }
  // At most 1e6 cubes lie along each axis.
  static std::int64_t key(const Cube& cube) {
    return ((cube[0] + 1) << 42) + ((cube[1] + 1) << 21) + cube[2] + 1;
  }

  Vec3 corner_;
  double width_;
  std::unordered_map<std::int64_t, std::vector<int>> nodes_;
};

/// Each node takes the nearest place within reach that is taken, or is a place itself: so the nodes of one
/// place are close to its first one, and no chain of close nodes moves them further. `largest` becomes the
/// largest distance.
Targets close_nodes(const Mesh& mesh, const std::vector<int>& nodes, double& largest) {
  const Vec3 corner = mesh.nodes.colwise().minCoeff();
  const double width = joining_distance * (mesh.nodes.colwise().maxCoeff().transpose() - corner).norm();
  Targets target = no_targets(mesh);
  largest = 0;
  // Nodes that are not finite have no place; the check of the mesh names them.
  if (!(width > 0 && std::isfinite(width)) || !mesh.nodes.allFinite()) return target;
  const std::vector<double> reach = reach_of_nodes(mesh, width);
  Grid places(corner, width);
  for (int i : nodes) {
    const Vec3 x = mesh.nodes.row(i);
    int nearest = i;
    double distance = reach[i];
    places.for_each_around(x, [&](int j) {
      const double d = (mesh.nodes.row(j).transpose() - x).norm();
      if (d > reach[j] || d > distance || (d == distance && j > nearest)) return;
      nearest = j;
      distance = d;
    });
    target[i] = nearest;
    if (nearest == i)
      places.add(x, i);
    else
      largest = std::max(largest, distance);
  }
  return target;
}

/// Puts the nodes of a place into its middle; returns "n nodes in m places", "" without any.
std::string join(Mesh& mesh, const Targets& target) {
  std::vector<int> count(target.size(), 0);
  Field shift = Field::Zero(mesh.nodes.rows(), 3);
  for (int i = 0; i < int(target.size()); ++i) {
    ++count[target[i]];
    shift.row(target[i]) += mesh.nodes.row(i) - mesh.nodes.row(target[i]);
  }
  int joined = 0, places = 0;
  for (int i = 0; i < int(target.size()); ++i) {
    if (count[i] < 2) continue;
    mesh.nodes.row(i) += shift.row(i) / count[i];
    joined += count[i];
    ++places;
  }
  for (int& i : mesh.elements.reshaped()) i = target[i];
  return places == 0 ? "" : format("%d nodes in %d place%s", joined, places, places > 1 ? "s" : "");
}

void join_nodes(MeshFile& file) {
  std::vector<int> open = open_nodes(file.mesh);
  if (open.empty()) return;
  if (const std::string joined = join(file.mesh, equal_nodes(file.mesh, open)); !joined.empty()) {
    file.remarks.push_back("equal nodes, " + joined + ": joined");
    drop_unused_nodes(file);
    open = open_nodes(file.mesh);
  }
  double largest = 0;
  if (const std::string joined = join(file.mesh, close_nodes(file.mesh, open, largest)); !joined.empty()) {
    file.remarks.push_back(joined + format(", corners within %g of the size (at most %.2g apart): joined",
                                           joining_distance, largest));
    drop_unused_nodes(file);
  }
}

void drop_collapsed_elements(MeshFile& file) {
  const Connectivity& elements = file.mesh.elements;
  std::vector<int> kept;
  int first = -1;
  for (int e = 0; e < elements.rows(); ++e) {
    const int a = elements(e, 0), b = elements(e, 1), c = elements(e, 2);
    if (a != b && b != c && c != a)
      kept.push_back(e);
    else if (first < 0)
      first = e;
  }
  if (first < 0) return;
  const long dropped = elements.rows() - long(kept.size());
  file.remarks.push_back(format("%ld degenerate element%s with two equal corners (the first is %s): dropped",
                                dropped, dropped > 1 ? "s" : "", file.origin.element(first).c_str()));
  number_by_position(file.origin.element_tags, elements.rows());
  const Connectivity rest = elements(kept, Eigen::all);
  file.mesh.elements = rest;
  keep(file.origin.element_tags, kept);
  keep(file.origin.element_lines, kept);
  drop_unused_nodes(file);
}

}  // namespace

void repair(MeshFile& file) {
  if (const int dropped = drop_unused_nodes(file))
    file.remarks.push_back(format("%d node%s in no triangle: dropped", dropped, dropped > 1 ? "s" : ""));
  join_nodes(file);
  drop_collapsed_elements(file);
  flip_flat_elements(file);
  split_touching_nodes(file);
}

}  // namespace esfem
