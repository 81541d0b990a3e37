// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/generate.hpp"

#include <algorithm>
#include <cmath>

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

/// max |kappa_i|, from kappa_1 + kappa_2 = tr A and kappa_1² + kappa_2² = |A|².
double largest_curvature(const Surface& surface, const Vec3& y) {
  const Mat3 A = surface.weingarten(y);
  const double H = A.trace();
  return (std::abs(H) + std::sqrt(std::max(2 * A.squaredNorm() - H * H, 0.0))) / 2;
}

void check_resolution(const Mesh& mesh, const Surface& surface, const SizeFunction& edge_length) {
  const double allowance = 1.01;  // the surface's own smallest radius may be rounded
  for (Eigen::Index i = 0; i < mesh.nodes.rows(); ++i) {
    const Vec3 y = mesh.nodes.row(i);
    const double radius = 1 / largest_curvature(surface, y);
    if (edge_length(y) > allowance * radius)
      throw InputError(
          format("%s: edge length %g at (%g, %g, %g), expected at most %g, the radius of curvature",
                 surface.name.c_str(), edge_length(y), y[0], y[1], y[2], radius));
  }
}

void check_topology(const Mesh& mesh, const Surface& surface) {
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

void check_positive(double edge_length, const Surface& surface) {
  if (!(edge_length > 0) || !std::isfinite(edge_length))
    throw InputError(
        format("%s: edge length %g, expected a positive number", surface.name.c_str(), edge_length));
}

}  // namespace

Mesh generate_mesh(const Surface& surface, double edge_length) {
  check_positive(edge_length, surface);
  const double largest = surface.smallest_curvature_radius;
  if (edge_length > largest * (1 + 1e-12))
    throw InputError(format("%s: edge length %g, expected at most %g, the smallest radius of curvature",
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

}  // namespace esfem
