// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/polygons.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <array>
#include <set>

#include "solver/error.hpp"

namespace esfem {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using PlaneTriangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::No_constraint_intersection_tag>;

using Corners = std::vector<int>;
using Triangles = std::vector<std::array<int, 3>>;

constexpr const char* not_simple = "its polygon crosses or touches itself, a simple polygon expected";

/// Twice the area vector.
Vec3 doubled_area(const std::vector<Vec3>& x, const Corners& polygon) {
  Vec3 sum = Vec3::Zero();
  const Vec3& origin = x[polygon[0]];
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum += (x[polygon[i]] - origin).cross(x[polygon[i + 1]] - origin);
  return sum;
}

/// Shape and orientation: proportional to the area along the normal over the squared edges, scaled by the
/// normal's length.
double quality(const std::vector<Vec3>& x, const Vec3& normal, int a, int b, int c) {
  const double squared_edges =
      (x[b] - x[a]).squaredNorm() + (x[c] - x[b]).squaredNorm() + (x[a] - x[c]).squaredNorm();
  return (x[b] - x[a]).cross(x[c] - x[a]).dot(normal) / squared_edges;
}

void cut_quadrangle(const std::vector<Vec3>& x, const Corners& q, Triangles& triangles) {
  const Vec3 normal = doubled_area(x, q);
  const auto worse = [&](int i) {  // of the two triangles that the diagonal from corner i makes
    return std::min(quality(x, normal, q[i], q[i + 1], q[i + 2]),
                    quality(x, normal, q[i], q[i + 2], q[(i + 3) % 4]));
  };
  const double first = worse(0), second = worse(1);
  if (std::max(first, second) < 0) throw InputError(not_simple);
  // Equal up to round-off (rectangles): the same diagonal in every position of the surface.
  const int i = second > first + 1e-6 * std::abs(first) ? 1 : 0;
  triangles.push_back({q[i], q[i + 1], q[i + 2]});
  triangles.push_back({q[i], q[i + 2], q[(i + 3) % 4]});
}

/// The faces that are reached from outside without crossing the polygon.
std::set<PlaneTriangulation::Face_handle> outside(const PlaneTriangulation& triangulation) {
  std::set<PlaneTriangulation::Face_handle> reached{triangulation.infinite_face()};
  std::vector<PlaneTriangulation::Face_handle> todo{triangulation.infinite_face()};
  while (!todo.empty()) {
    const PlaneTriangulation::Face_handle face = todo.back();
    todo.pop_back();
    for (int i = 0; i < 3; ++i)
      if (!face->is_constrained(i) && reached.insert(face->neighbor(i)).second)
        todo.push_back(face->neighbor(i));
  }
  return reached;
}

void cut_polygon(const std::vector<Vec3>& x, const Corners& polygon, Triangles& triangles) {
  const Vec3 normal = doubled_area(x, polygon).normalized();
  if (!(normal.norm() > 0.5)) throw InputError("its polygon has no area, a simple polygon expected");
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  PlaneTriangulation triangulation;
  std::vector<PlaneTriangulation::Vertex_handle> vertices;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 d = x[polygon[i]] - x[polygon[0]];
    vertices.push_back(triangulation.insert({d.dot(u), d.dot(v)}));
    vertices.back()->info() = int(i);
    // A point that was there gives its vertex back.
    if (triangulation.number_of_vertices() != i + 1) throw InputError(not_simple);
  }
  try {
    for (std::size_t i = 0; i < polygon.size(); ++i)
      triangulation.insert_constraint(vertices[i], vertices[(i + 1) % polygon.size()]);
  } catch (const PlaneTriangulation::Intersection_of_constraints_exception&) {
    throw InputError(not_simple);
  }
  const auto reached = outside(triangulation);
  const std::size_t before = triangles.size();
  for (const PlaneTriangulation::Face_handle face : triangulation.finite_face_handles())
    if (!reached.count(face))
      triangles.push_back({polygon[face->vertex(0)->info()], polygon[face->vertex(1)->info()],
                           polygon[face->vertex(2)->info()]});
  if (triangles.size() - before != polygon.size() - 2) throw InputError(not_simple);
}

/// Cuts off what joins neighbouring corners in one place, as triangles with two equal corners: so the
/// neighbours along these edges keep theirs.
Corners without_repeated_corners(const std::vector<Vec3>& x, const Corners& polygon, Triangles& triangles) {
  const std::size_t n = polygon.size();
  std::size_t left = n;
  Corners kept{polygon[0]};
  for (std::size_t i = 1; i < n; ++i)
    if (left > 3 && x[kept.back()] == x[polygon[i]]) {
      triangles.push_back({kept.back(), polygon[i], polygon[(i + 1) % n]});
      --left;
    } else {
      kept.push_back(polygon[i]);
    }
  if (left > 3 && x[kept.back()] == x[kept.front()]) {
    triangles.push_back({kept.back(), kept.front(), kept[1]});
    kept.erase(kept.begin());
  }
  return kept;
}

void cut(const std::vector<Vec3>& x, const Corners& corners, Triangles& triangles) {
  const Corners polygon = without_repeated_corners(x, corners, triangles);
  if (polygon.size() == 3)
    triangles.push_back({polygon[0], polygon[1], polygon[2]});
  else if (polygon.size() == 4)
    cut_quadrangle(x, polygon, triangles);
  else
    cut_polygon(x, polygon, triangles);
}

}  // namespace

MeshFile triangulated(Polygons&& polygons) {
  MeshFile result;
  result.origin = std::move(polygons.origin);
  result.fields = std::move(polygons.fields);
  MeshOrigin& origin = result.origin;
  const std::vector<int> lines = std::move(origin.element_lines);
  const std::vector<long> tags = std::move(origin.element_tags);
  origin.element_lines.clear();
  origin.element_tags.clear();
  const auto tag = [&](std::size_t e) { return tags.empty() ? long(e) + 1 : tags[e]; };
  const std::vector<Vec3>& x = polygons.points;
  const auto complain = [&](std::size_t e, const std::string& what) {
    const std::string line = lines.empty() ? "counted from 1" : format("line %d", lines[e]);
    throw InputError(
        format("%s: element %ld (%s): %s", origin.source.c_str(), tag(e), line.c_str(), what.c_str()));
  };

  Triangles triangles;
  Corners polygon;
  int cut_polygons = 0;
  std::size_t corner = 0;
  for (std::size_t e = 0; e < polygons.sizes.size(); ++e) {
    polygon.clear();
    for (int i = 0; i < polygons.sizes[e]; ++i, ++corner) {
      const long number = polygons.corners[corner];
      if (number < polygons.first || number - polygons.first >= long(x.size()))
        complain(e, format("node %ld, out of range: %ld to %ld expected", number, polygons.first,
                           polygons.first + long(x.size()) - 1));
      polygon.push_back(int(number - polygons.first));
    }
    if (polygon.size() < 3) complain(e, format("%zu corners, at least 3 expected", polygon.size()));
    cut_polygons += polygon.size() > 3;
    try {
      cut(x, polygon, triangles);
    } catch (const InputError& error) {
      complain(e, error.what());
    }
    origin.element_tags.resize(triangles.size(), tag(e));
    if (!lines.empty()) origin.element_lines.resize(triangles.size(), lines[e]);
  }
  if (cut_polygons > 0)
    result.remarks.push_back(
        format("%d polygon%s cut into triangles", cut_polygons, cut_polygons > 1 ? "s" : ""));

  result.mesh.nodes.resize(long(x.size()), 3);
  for (std::size_t i = 0; i < x.size(); ++i) result.mesh.nodes.row(long(i)) = x[i];
  result.mesh.elements.resize(long(triangles.size()), 3);
  for (std::size_t e = 0; e < triangles.size(); ++e)
    for (int i = 0; i < 3; ++i) result.mesh.elements(long(e), i) = triangles[e][i];
  return result;
}

}  // namespace esfem
