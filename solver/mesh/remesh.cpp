// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/remesh.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>

#include "solver/error.hpp"

namespace esfem {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangulation = CGAL::Surface_mesh<Point>;
using Vertex = Triangulation::Vertex_index;

struct Size {
  double area = 0, volume = 0, diagonal = 0;
};

Size size_of(const Mesh& mesh) {
  Size size;
  const Vec3 lowest = mesh.nodes.colwise().minCoeff(), highest = mesh.nodes.colwise().maxCoeff();
  size.diagonal = (highest - lowest).norm();
  const Vec3 centre = (lowest + highest) / 2;
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    Vec3 x[3];
    for (int i = 0; i < 3; ++i) x[i] = mesh.nodes.row(mesh.elements(e, i)).transpose() - centre;
    size.area += (x[1] - x[0]).cross(x[2] - x[0]).norm() / 2;
    size.volume += x[0].dot(x[1].cross(x[2])) / 6;
  }
  return size;
}

void check_edge_length(double edge_length, const Size& size) {
  const double most_triangles = 1e7, equilateral = std::sqrt(3) / 4;
  const double least = std::sqrt(size.area / (equilateral * most_triangles)), most = size.diagonal / 4;
  if (edge_length >= least && edge_length <= most) return;
  throw InputError(
      format("edge length %g for remeshing, expected %g (ten million triangles) to %g (a quarter of "
             "the surface's diagonal)",
             edge_length, least, most));
}

Triangulation to_cgal(const Mesh& mesh) {
  Triangulation result;
  for (int i = 0; i < mesh.nodes.rows(); ++i)
    result.add_vertex({mesh.nodes(i, 0), mesh.nodes(i, 1), mesh.nodes(i, 2)});
  for (int e = 0; e < mesh.elements.rows(); ++e)
    if (result.add_face(Vertex(mesh.elements(e, 0)), Vertex(mesh.elements(e, 1)),
                        Vertex(mesh.elements(e, 2))) == Triangulation::null_face())
      throw InputError(format("element %d (counted from 1) is not one of a closed, oriented surface", e + 1));
  return result;
}

Mesh from_cgal(const Triangulation& triangulation) {
  Mesh mesh;
  mesh.nodes.resize(triangulation.number_of_vertices(), 3);
  std::vector<int> number(triangulation.num_vertices());
  int nodes = 0, elements = 0;
  for (const Vertex v : triangulation.vertices()) {
    const Point& p = triangulation.point(v);
    number[v] = nodes;
    mesh.nodes.row(nodes++) << p.x(), p.y(), p.z();
  }
  mesh.elements.resize(triangulation.number_of_faces(), 3);
  for (const auto f : triangulation.faces()) {
    int i = 0;
    for (const Vertex v : triangulation.vertices_around_face(triangulation.halfedge(f)))
      mesh.elements(elements, i++) = number[v];
    ++elements;
  }
  return mesh;
}

/// Sharp edges stay on their feature, and nodes where a feature ends or has a corner stay.
void remesh_between(const Mesh& mesh, const Features& features, double edge_length,
                    Triangulation& triangulation) {
  const int iterations = 10;
  auto sharp = triangulation.add_property_map<Triangulation::Edge_index, bool>("sharp", false).first;
  auto fixed = triangulation.add_property_map<Vertex, bool>("fixed", false).first;
  for (int h = 0; h < int(features.sharp.size()); ++h) {
    if (!features.sharp[h]) continue;
    const Vertex a(mesh.elements(h / 3, h % 3)), b(mesh.elements(h / 3, (h + 1) % 3));
    sharp[triangulation.edge(triangulation.halfedge(a, b))] = true;
    if (features.next_sharp[h] < 0) fixed[b] = true;
  }
  CGAL::Polygon_mesh_processing::isotropic_remeshing(triangulation.faces(), edge_length, triangulation,
                                                     CGAL::parameters::number_of_iterations(iterations)
                                                         .edge_is_constrained_map(sharp)
                                                         .vertex_is_constrained_map(fixed));
}

std::vector<Vec3> centres_of_thin_triangles(const Mesh& mesh) {
  const double least_ratio = 0.05;
  std::vector<Vec3> centres;
  for (int e = 0; e < mesh.elements.rows(); ++e)
    if (mesh_quality(mesh.elements.row(e), mesh.nodes).min_radius_ratio < least_ratio)
      centres.push_back(mesh.nodes(mesh.elements.row(e), Eigen::all).colwise().mean().transpose());
  return centres;
}

/// The features without the edges that are near one of these points.
Features features_away_from(const std::vector<Vec3>& points, double distance, const Mesh& mesh,
                            const Features& features, double angle) {
  std::vector<bool> sharp = features.sharp;
  for (int h = 0; h < int(sharp.size()); ++h) {
    if (!sharp[h] || features.twin[h] < h) continue;
    const Vec3 a = mesh.nodes.row(mesh.elements(h / 3, h % 3)),
               edge = mesh.nodes.row(mesh.elements(h / 3, (h + 1) % 3)).transpose() - a;
    const bool near = std::any_of(points.begin(), points.end(), [&](const Vec3& x) {
      const double s = std::clamp((x - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
      return (x - a - s * edge).norm() < distance;
    });
    if (near) sharp[h] = sharp[features.twin[h]] = false;
  }
  return features_along(mesh, features.twin, sharp, angle);
}

Vec3 barycentric(const Mesh& mesh, int element, const Vec3& x) {
  Vec3 corner[3];
  for (int i = 0; i < 3; ++i) corner[i] = mesh.nodes.row(mesh.elements(element, i));
  const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  Vec3 weights;
  for (int i = 0; i < 3; ++i)
    weights[i] = (corner[(i + 1) % 3] - x).cross(corner[(i + 2) % 3] - x).dot(normal) / normal.squaredNorm();
  weights = (weights.array() < 1e-9).select(0, weights);
  return weights / weights.sum();
}

std::vector<MeshPoint> located(const Field& nodes, const Mesh& mesh, const Triangulation& triangulation) {
  using Primitive = CGAL::AABB_face_graph_triangle_primitive<Triangulation>;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree(faces(triangulation).begin(),
                                                             faces(triangulation).end(), triangulation);
  std::vector<MeshPoint> points;
  for (int i = 0; i < nodes.rows(); ++i) {
    const auto [x, face] = tree.closest_point_and_primitive({nodes(i, 0), nodes(i, 1), nodes(i, 2)});
    points.push_back({int(face), barycentric(mesh, int(face), Vec3(x.x(), x.y(), x.z()))});
  }
  return points;
}

}  // namespace

RemeshedSurface remesh(const Mesh& mesh, double edge_length, double feature_angle) {
  const Size before = size_of(mesh);
  check_edge_length(edge_length, before);
  Features features = find_features(mesh, feature_angle);
  RemeshedSurface result;
  result.sharp_edges = features.sharp_edges;
  try {
    const Triangulation input = to_cgal(mesh);
    const int most_rounds = 6;
    const double largest_change = 0.01;  // of the volume, for triangles that are not thin
    for (int round = 0; round < most_rounds; ++round) {
      Triangulation remade = input;
      remesh_between(mesh, features, edge_length, remade);
      const Mesh found = from_cgal(remade);
      const double change = size_of(found).volume / before.volume - 1;
      if (round > 0 && std::abs(change - result.relative_volume_change) > largest_change) break;
      result.mesh = found;
      result.kept = features.sharp_edges;
      result.relative_volume_change = change;
      const std::vector<Vec3> thin = centres_of_thin_triangles(found);
      if (thin.empty() || features.sharp_edges == 0) break;
      features = features_away_from(thin, std::ldexp(edge_length, round), mesh, features, feature_angle);
    }
    result.on_input = located(result.mesh.nodes, mesh, input);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception&) {  // CGAL's message is several lines about its source
    throw InputError(
        format("remeshing with edge length %g failed, expected a surface that does not intersect "
               "itself, or another edge length",
               edge_length));
  }
  return result;
}

}  // namespace esfem
