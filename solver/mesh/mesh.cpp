// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"

namespace esfem {

namespace {

/// One key for an edge and its reverse.
std::uint64_t edge_key(int a, int b) {
  return std::uint64_t(std::min(a, b)) << 32 | std::uint64_t(std::max(a, b));
}

Vec3 node(const Field& x, int i) {
  return x.row(i).transpose();
}

/// For each local node of degree `to` the one of degree `from` at the same place, or -1.
std::vector<int> same_local_nodes(int from, int to) {
  const auto given = reference_nodes(from), wanted = reference_nodes(to);
  std::vector<int> same(wanted.rows(), -1);
  for (int i = 0; i < wanted.rows(); ++i)
    for (int j = 0; j < given.rows(); ++j)
      if ((wanted.row(i) - given.row(j)).norm() < 1e-12) same[i] = j;
  return same;
}

/// The nodes that are one of these local nodes (-1: none) of some element, in their order.
std::vector<int> nodes_at(const Mesh& mesh, const std::vector<int>& local) {
  std::vector<bool> used(mesh.nodes.rows(), false);
  for (int e = 0; e < mesh.elements.rows(); ++e)
    for (int i : local)
      if (i >= 0) used[mesh.elements(e, i)] = true;
  std::vector<int> nodes;
  for (int i = 0; i < int(used.size()); ++i)
    if (used[i]) nodes.push_back(i);
  return nodes;
}

/// lagrange_mesh of any degree, the same one included: then nodes in no element are dropped.
Mesh with_degree(const Mesh& mesh, int degree) {
  const int local = nodes_per_element(degree);
  const Eigen::MatrixXd interpolation = shape_functions(mesh.degree, reference_nodes(degree)).value;
  const std::vector<int> same = same_local_nodes(mesh.degree, degree);
  const std::vector<int> kept = nodes_at(mesh, same);
  const int on_edge = degree - 1, inner = 3 + 3 * on_edge;

  Mesh result;
  result.degree = degree;
  result.elements.resize(mesh.elements.rows(), local);
  std::vector<Vec3> nodes;
  std::vector<int> number(mesh.nodes.rows(), -1);
  // Given nodes are taken over as they are: interpolation would round them.
  for (int i : kept) {
    number[i] = int(nodes.size());
    nodes.push_back(node(mesh.nodes, i));
  }
  // The first new node of an edge; they go from the edge's smaller corner to its larger one.
  std::unordered_map<std::uint64_t, int> edge_start;
  edge_start.reserve(mesh.elements.rows() * 3 / 2);

  for (int e = 0; e < mesh.elements.rows(); ++e) {
    Eigen::MatrixXd old(mesh.elements.cols(), 3);
    for (int i = 0; i < old.rows(); ++i) old.row(i) = mesh.nodes.row(mesh.elements(e, i));
    const Eigen::MatrixXd x = interpolation * old;

    for (int i = 0; i < local; ++i)
      if (same[i] >= 0) result.elements(e, i) = number[mesh.elements(e, same[i])];
    // New nodes are numbered where an element first touches them, so that neighbours in space are neighbours
    // in memory.
    for (int edge = 0; edge < 3; ++edge) {
      const int a = mesh.elements(e, edge), b = mesh.elements(e, (edge + 1) % 3), first = 3 + edge * on_edge;
      std::vector<int> columns;
      for (int i = first; i < first + on_edge; ++i)
        if (same[i] < 0) columns.push_back(i);
      if (a > b) std::reverse(columns.begin(), columns.end());
      const auto [entry, is_new] = edge_start.try_emplace(edge_key(a, b), int(nodes.size()));
      for (std::size_t i = 0; i < columns.size(); ++i) {
        result.elements(e, columns[i]) = entry->second + int(i);
        if (is_new) nodes.push_back(node(x, columns[i]));
      }
    }
    for (int i = inner; i < local; ++i) {
      if (same[i] >= 0) continue;
      result.elements(e, i) = int(nodes.size());
      nodes.push_back(node(x, i));
    }
  }
  result.nodes.resize(nodes.size(), 3);
  for (std::size_t i = 0; i < nodes.size(); ++i) result.nodes.row(i) = nodes[i].transpose();
  return result;
}

}  // namespace

Mesh lagrange_mesh(const Mesh& mesh, int degree) {
  return degree == mesh.degree ? mesh : with_degree(mesh, degree);
}

Field lagrange_values(const Mesh& mesh, const Field& values, const Mesh& refined) {
  if (refined.degree == mesh.degree) return values;
  const Eigen::MatrixXd interpolation = shape_functions(mesh.degree, reference_nodes(refined.degree)).value;
  const std::vector<int> same = same_local_nodes(mesh.degree, refined.degree);
  Field result(refined.nodes.rows(), values.cols());
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    const Field old = values(mesh.elements.row(e), Eigen::all), at_nodes = interpolation * old;
    for (int i = 0; i < refined.elements.cols(); ++i)
      result.row(refined.elements(e, i)) = same[i] >= 0 ? old.row(same[i]) : at_nodes.row(i);
  }
  return result;
}

Mesh corner_mesh(const Mesh& mesh) {
  return with_degree(mesh, 1);
}

void project_nodes(Mesh& mesh, const Surface& surface) {
  // A triangle of a mesh that belongs to the surface is nowhere further from it than half an edge.
  const double reach = 0.5 * mesh_quality(mesh.elements, mesh.nodes).h;
  for (int i = 0; i < mesh.nodes.rows(); ++i) {
    const Vec3 x = node(mesh.nodes, i);
    Vec3 y;
    try {
      y = surface.closest_point(x);
    } catch (const NumericsError& error) {
      throw InputError(format("node %d: %s", i + 1, error.what()));
    }
    // Closest point is exact up to 1e-12 only; one Newton step along the normal takes |d| to round-off.
    const LevelSetJet d = surface.level_set(y);
    y -= d.value / d.gradient.squaredNorm() * d.gradient;
    const double distance = (y - x).norm();
    if (!(distance <= reach))
      throw InputError(format(
          "node %d (%g, %g, %g) is %g away from the %s; expected a mesh of this surface, with nodes within "
          "half an edge length, %g",
          i + 1, x[0], x[1], x[2], distance, surface.name.c_str(), reach));
    mesh.nodes.row(i) = y.transpose();
  }
}

MeshQuality mesh_quality(const Connectivity& elements, const Field& x) {
  if (elements.rows() == 0) throw InputError("quality of a mesh without elements, at least one expected");
  const double degrees = 180 / pi;
  MeshQuality quality{0, INFINITY, 180, 0, INFINITY, 0};
  for (int e = 0; e < elements.rows(); ++e) {
    Vec3 side[3];
    double length[3];
    for (int i = 0; i < 3; ++i) {
      side[i] = node(x, elements(e, (i + 2) % 3)) - node(x, elements(e, (i + 1) % 3));
      length[i] = side[i].norm();
      quality.h = std::max(quality.h, length[i]);
      quality.h_min = std::min(quality.h_min, length[i]);
    }
    const double doubled_area = side[0].cross(side[1]).norm();
    for (int i = 0; i < 3; ++i) {
      const double angle = std::atan2(doubled_area, -side[(i + 1) % 3].dot(side[(i + 2) % 3]));
      quality.min_angle = std::min(quality.min_angle, angle * degrees);
    }
    const double perimeter = length[0] + length[1] + length[2];
    const double product = length[0] * length[1] * length[2];
    const double ratio = product > 0 ? 4 * doubled_area * doubled_area / (perimeter * product) : 0;
    quality.mean_radius_ratio += ratio / double(elements.rows());
    if (ratio < quality.min_radius_ratio) {
      quality.min_radius_ratio = ratio;
      quality.worst_element = e;
    }
  }
  return quality;
}

int euler_characteristic(const Mesh& mesh) {
  std::unordered_set<int> corners;
  std::unordered_set<std::uint64_t> edges;
  for (int e = 0; e < mesh.elements.rows(); ++e)
    for (int i = 0; i < 3; ++i) {
      corners.insert(mesh.elements(e, i));
      edges.insert(edge_key(mesh.elements(e, i), mesh.elements(e, (i + 1) % 3)));
    }
  return int(corners.size()) - int(edges.size()) + int(mesh.elements.rows());
}

}  // namespace esfem
