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

}  // namespace

Mesh lagrange_mesh(const Mesh& mesh, int degree) {
  const int local = nodes_per_element(degree);
  if (degree == mesh.degree) return mesh;
  const Eigen::MatrixXd interpolation = shape_functions(mesh.degree, reference_nodes(degree)).value;
  const int on_edge = degree - 1, inner = local - 3 - 3 * on_edge;

  Mesh result;
  result.degree = degree;
  result.elements.resize(mesh.elements.rows(), local);
  std::vector<Vec3> nodes;
  std::vector<int> corner_number(mesh.nodes.rows(), -1);
  // First node of an edge's run, which goes from the edge's smaller corner to its larger one.
  std::unordered_map<std::uint64_t, int> edge_start;
  edge_start.reserve(mesh.elements.rows() * 3 / 2);

  for (int e = 0; e < mesh.elements.rows(); ++e) {
    Eigen::MatrixXd old(mesh.elements.cols(), 3);
    for (int i = 0; i < old.rows(); ++i) old.row(i) = mesh.nodes.row(mesh.elements(e, i));
    const Eigen::MatrixXd x = interpolation * old;

    // Nodes are numbered where an element first touches them, so neighbours in space are neighbours in
    // memory.
    for (int i = 0; i < 3; ++i) {
      int& number = corner_number[mesh.elements(e, i)];
      if (number < 0) {
        number = int(nodes.size());
        // A corner is taken over as it is: interpolation would round it.
        nodes.push_back(node(mesh.nodes, mesh.elements(e, i)));
      }
      result.elements(e, i) = number;
    }
    for (int edge = 0; on_edge > 0 && edge < 3; ++edge) {
      const int a = mesh.elements(e, edge), b = mesh.elements(e, (edge + 1) % 3);
      const auto [entry, is_new] = edge_start.try_emplace(edge_key(a, b), int(nodes.size()));
      if (is_new) nodes.resize(nodes.size() + on_edge);
      for (int i = 0; i < on_edge; ++i) {
        const int number = entry->second + (a < b ? i : on_edge - 1 - i), column = 3 + edge * on_edge + i;
        result.elements(e, column) = number;
        if (is_new) nodes[number] = node(x, column);
      }
    }
    for (int i = local - inner; i < local; ++i) {
      result.elements(e, i) = int(nodes.size());
      nodes.push_back(node(x, i));
    }
  }
  result.nodes.resize(nodes.size(), 3);
  for (std::size_t i = 0; i < nodes.size(); ++i) result.nodes.row(i) = nodes[i].transpose();
  return result;
}

Mesh corner_mesh(const Mesh& mesh) {
  std::vector<int> number(mesh.nodes.rows(), -1);
  for (int e = 0; e < mesh.elements.rows(); ++e)
    for (int i = 0; i < 3; ++i) number[mesh.elements(e, i)] = 0;
  int corners = 0;
  for (int& n : number)
    if (n == 0) n = corners++;

  Mesh result;
  result.nodes.resize(corners, 3);
  for (int i = 0; i < mesh.nodes.rows(); ++i)
    if (number[i] >= 0) result.nodes.row(number[i]) = mesh.nodes.row(i);
  result.elements.resize(mesh.elements.rows(), 3);
  for (int e = 0; e < mesh.elements.rows(); ++e)
    for (int i = 0; i < 3; ++i) result.elements(e, i) = number[mesh.elements(e, i)];
  return result;
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
