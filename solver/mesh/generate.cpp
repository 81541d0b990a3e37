// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/generate.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "solver/constants.hpp"
#include "solver/disjoint_sets.hpp"
#include "solver/error.hpp"
#include "solver/mesh/delaunay.hpp"
#include "solver/mesh/relax.hpp"

namespace esfem {
namespace {

struct Promise {
  double min_angle;  ///< degrees
  double mean_radius_ratio;
  double deviation;  ///< of the largest edge, relative
};

void check_resolution(const Mesh& mesh, const Surface& surface, const SizeFunction& edge_length) {
  const double allowance = 1.01;  // the surface's own smallest radius may be rounded
  for (Eigen::Index i = 0; i < mesh.nodes.rows(); ++i) {
    const Vec3 y = mesh.nodes.row(i);
    const double radius = 1 / surface.largest_curvature(y);
    if (edge_length(y) > allowance * radius)
      throw InputError(
          format("%s: edge length %g at (%g, %g, %g), expected at most %g, the radius of curvature",
                 surface.name.c_str(), edge_length(y), y[0], y[1], y[2], radius));
  }
}

int component_count(const Mesh& mesh) {
  DisjointSets sets(int(mesh.nodes.rows()));
  for (Eigen::Index t = 0; t < mesh.elements.rows(); ++t)
    for (int i : {1, 2}) sets.unite(mesh.elements(t, i), mesh.elements(t, 0));
  return sets.count();
}

void check_topology(const Mesh& mesh, const Surface& surface) {
  if (const int count = component_count(mesh); mesh.elements.rows() > 0 && count < surface.components)
    throw InputError(
        format("%s: the surface has %d components, of which %d got a mesh; expected a box around "
               "one of them alone, or a mesh file with all of them",
               surface.name.c_str(), surface.components, count));
  const int characteristic = euler_characteristic(mesh);
  if (mesh.elements.rows() > 0 && characteristic == surface.euler_characteristic) return;
  throw NumericsError(
      format("%s: the Delaunay mesh has %d vertices, %d triangles, Euler characteristic %d, expected %d",
             surface.name.c_str(), int(mesh.nodes.rows()), int(mesh.elements.rows()), characteristic,
             surface.euler_characteristic));
}

/// Largest ratio of an edge's length to the one asked for at its midpoint.
double largest_relative_edge(const Mesh& mesh, const SizeFunction& edge_length) {
  double largest = 0;
  for (Eigen::Index t = 0; t < mesh.elements.rows(); ++t)
    for (int i = 0; i < 3; ++i) {
      const Vec3 a = mesh.nodes.row(mesh.elements(t, i)), b = mesh.nodes.row(mesh.elements(t, (i + 1) % 3));
      largest = std::max(largest, (b - a).norm() / edge_length((a + b) / 2));
    }
  return largest;
}

void check_quality(const Mesh& mesh, const Surface& surface, double relative_edge, const Promise& promise) {
  const MeshQuality quality = mesh_quality(mesh.elements, mesh.nodes);
  if (quality.min_angle >= promise.min_angle && quality.mean_radius_ratio >= promise.mean_radius_ratio &&
      std::abs(relative_edge - 1) <= promise.deviation)
    return;
  throw NumericsError(
      format("%s: mesh of %d vertices with smallest angle %.1f degrees, mean radius ratio %.3f (smallest "
             "%.3f, element %d), "
             "largest edge %.2f times the one asked for; expected at least %g, %g, and 1 within %g",
             surface.name.c_str(), int(mesh.nodes.rows()), quality.min_angle, quality.mean_radius_ratio,
             quality.min_radius_ratio, quality.worst_element + 1, relative_edge, promise.min_angle,
             promise.mean_radius_ratio, promise.deviation));
}

/// Vertices along a Hilbert curve, every triangle from its lowest vertex on, triangles in the order of these:
/// an element and its neighbours are close in memory.
Mesh renumber(const Mesh& mesh) {
  const std::vector<std::size_t> order = hilbert_order(mesh.nodes);
  std::vector<int> number(order.size());
  Mesh result = mesh;
  for (std::size_t i = 0; i < order.size(); ++i) {
    number[order[i]] = int(i);
    result.nodes.row(i) = mesh.nodes.row(order[i]);
  }
  std::vector<std::array<int, 3>> triangles(mesh.elements.rows());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) triangles[t][i] = number[mesh.elements(t, i)];
    std::rotate(triangles[t].begin(), std::min_element(triangles[t].begin(), triangles[t].end()),
                triangles[t].end());
  }
  std::sort(triangles.begin(), triangles.end());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) result.elements(t, i) = triangles[t][i];
  return result;
}

Mesh generate(const Surface& surface, const SizeFunction& edge_length, const Promise& promise) {
  const int attempts = 3;
  double scale = 1, relative_edge = 0;
  Mesh mesh;
  // The largest edge is known only after the relaxation; two thirds of the tolerance leave room for a second
  // try.
  for (int attempt = 0; attempt < attempts && std::abs(relative_edge - 1) > promise.deviation * 2 / 3;
       ++attempt) {
    // A size function that jumps has edges far too long on the fine side: no density cures that.
    if (attempt > 0) scale /= std::clamp(relative_edge, 0.8, 1.25);
    mesh = delaunay_surface_mesh(surface, [&](const Vec3& y) { return scale * edge_length(y); });
    check_resolution(mesh, surface, edge_length);
    check_topology(mesh, surface);
    relax(mesh, surface, edge_length);
    relative_edge = largest_relative_edge(mesh, edge_length);
  }
  mesh = renumber(mesh);
  check_quality(mesh, surface, relative_edge, promise);
  return mesh;
}

/// `size` where it grows by at most `growth` times the distance on the surface: in the vertices of a mesh for
/// `size` itself the least of size + growth * distance along its edges (Dijkstra), elsewhere the least of the
/// same from the closest vertex and its neighbours.
class GradualSize {
 public:
  GradualSize(const Surface& surface, SizeFunction size, double growth)
      : size_(std::move(size)), growth_(growth) {
    const Mesh mesh = delaunay_surface_mesh(surface, size_);
    nodes_ = mesh.nodes;
    closest_ = closest_node(nodes_);
    neighbours_.resize(nodes_.rows());
    for (Eigen::Index t = 0; t < mesh.elements.rows(); ++t)
      for (int i = 0; i < 3; ++i) {
        neighbours_[mesh.elements(t, i)].push_back(mesh.elements(t, (i + 1) % 3));
        neighbours_[mesh.elements(t, i)].push_back(mesh.elements(t, (i + 2) % 3));
      }
    spread();
  }

  double operator()(const Vec3& y) const {
    const int vertex = closest_(y);
    double size = std::min(size_(y), size_from(vertex, y));
    for (int neighbour : neighbours_[vertex]) size = std::min(size, size_from(neighbour, y));
    return size;
  }

 private:
  double size_from(int vertex, const Vec3& y) const {
    return sizes_[vertex] + growth_ * (y - Vec3(nodes_.row(vertex))).norm();
  }

  void spread() {
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (int i = 0; i < nodes_.rows(); ++i) {
      sizes_.push_back(size_(nodes_.row(i)));
      queue.emplace(sizes_[i], i);
    }
    while (!queue.empty()) {
      const auto [size, vertex] = queue.top();
      queue.pop();
      if (size > sizes_[vertex]) continue;
      for (int neighbour : neighbours_[vertex]) {
        const double limited = size_from(vertex, nodes_.row(neighbour));
        if (limited >= sizes_[neighbour]) continue;
        sizes_[neighbour] = limited;
        queue.emplace(limited, neighbour);
      }
    }
  }

  SizeFunction size_;
  double growth_;
  Field nodes_;
  std::function<int(const Vec3&)> closest_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<double> sizes_;
};

void check_positive(double edge_length, const Surface& surface) {
  if (!(edge_length > 0) || !std::isfinite(edge_length))
    throw InputError(
        format("%s: edge length %g, expected a positive number", surface.name.c_str(), edge_length));
}

/// Refuses an edge length that is a mistake in the unit, say.
void check_count(double edge_length, const Surface& surface) {
  const double nodes = nodes_at_most(surface, edge_length);
  if (nodes > most_nodes)
    throw InputError(
        format("%s: edge length %g on a surface of radius %g makes about %.1g nodes; expected at "
               "most %g",
               surface.name.c_str(), edge_length, surface.bounding_radius, nodes, most_nodes));
}

}  // namespace

double nodes_at_most(const Surface& surface, double edge_length) {
  // Equilateral triangles on the bounding sphere, which most surfaces do not fill.
  const double ratio = surface.bounding_radius / edge_length;
  return 14.5 * ratio * ratio;
}

Mesh generate_mesh(const Surface& surface, double edge_length) {
  check_positive(edge_length, surface);
  check_count(edge_length, surface);
  const double largest = surface.smallest_curvature_radius;
  if (edge_length > largest * (1 + 1e-12))
    throw InputError(
        format("%s: edge length %g, expected at most %g, the smallest radius of curvature, or a "
               "mesh that is graded by curvature (\"grading\")",
               surface.name.c_str(), edge_length, largest));
  return generate(surface, [edge_length](const Vec3&) { return edge_length; }, {25, 0.94, 0.15});
}

Mesh generate_mesh(const Surface& surface, const std::function<double(const Vec3&)>& edge_length) {
  const auto checked = [&](const Vec3& y) {
    const double length = edge_length(y);
    check_positive(length, surface);
    return length;
  };
  return generate(surface, checked, {20, 0.90, 0.25});
}

Mesh generate_mesh(const Surface& surface, double edge_length, double grading) {
  check_positive(edge_length, surface);
  check_count(edge_length, surface);
  if (!(grading > 0 && grading <= 1))
    throw InputError(format("%s: grading %g, expected a number greater than 0 and at most 1",
                            surface.name.c_str(), grading));
  // int |A|² >= 8 pi on closed surfaces (Willmore), and equilateral triangles have 2 / (sqrt(3) h²) nodes an
  // area.
  const double least_nodes = 16 * pi / (std::sqrt(3.0) * grading * grading);
  if (least_nodes > most_nodes)
    throw InputError(format("%s: grading %g makes %.1g nodes or more; expected at most %g",
                            surface.name.c_str(), grading, least_nodes, most_nodes));
  const auto by_curvature = [&](const Vec3& y) {
    return edge_length /
           std::sqrt(1 + surface.weingarten(y).squaredNorm() * std::pow(edge_length / grading, 2));
  };
  const double growth = 0.25;
  return generate_mesh(surface, GradualSize(surface, by_curvature, growth));
}

}  // namespace esfem
