// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/delaunay.hpp"

#include <CGAL/Complex_2_in_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Implicit_surface_3.h>
#include <CGAL/Random.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/Surface_mesh_cell_base_3.h>
#include <CGAL/Surface_mesh_vertex_base_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/hilbert_sort.h>
#include <CGAL/make_surface_mesh.h>
#include <CGAL/property_map.h>

#include <array>
#include <memory>
#include <numeric>
#include <unordered_map>

namespace esfem {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

Vec3 to_vector(const Point& p) {
  return {p.x(), p.y(), p.z()};
}

/// Vertices and cells numbered in the order of their creation: the mesher keeps sets of handles, which CGAL
/// orders by these numbers when it finds them, and by address (another one in each run) when it does not.
template <class Base>
class Numbered : public Base {
 public:
  using Has_timestamp = CGAL::Tag_true;
  template <class Tds>
  struct Rebind_TDS {
    using Other = Numbered<typename Base::template Rebind_TDS<Tds>::Other>;
  };
  using Base::Base;
  std::size_t time_stamp() const { return number_; }
  void set_time_stamp(std::size_t number) { number_ = number; }

 private:
  std::size_t number_ = std::size_t(-1);
};

using SpatialTriangulation = CGAL::Delaunay_triangulation_3<
    Kernel, CGAL::Triangulation_data_structure_3<Numbered<CGAL::Surface_mesh_vertex_base_3<Kernel>>,
                                                 Numbered<CGAL::Surface_mesh_cell_base_3<Kernel>>>>;
using Complex = CGAL::Complex_2_in_triangulation_3<SpatialTriangulation>;

/// A facet is refined while the radius of its surface Delaunay ball exceeds radius_factor times the size
/// there, the largest excess first.
class SizeCriterion {
 public:
  using Quality = double;
  using Facet = SpatialTriangulation::Facet;
  explicit SizeCriterion(const SizeFunction& size) : size_(size) {}
  bool is_bad(const Facet& facet, Quality& quality) const {
    const Point& center = facet.first->get_facet_surface_center(facet.second);
    const Point& corner = facet.first->vertex((facet.second + 1) & 3)->point();
    quality = radius_factor * size_(to_vector(center)) / std::sqrt(CGAL::squared_distance(center, corner));
    return quality < 1.0;
  }

 private:
  // Measured: after the relaxation the largest edge is then the size, within some percent.
  static constexpr double radius_factor = 0.55;
  const SizeFunction& size_;
};

/// The facets of the complex, turned so that their normal agrees with the surface's.
Mesh extract(const Complex& complex, const Surface& surface) {
  std::unordered_map<Complex::Vertex_handle, int, CGAL::Hash_handles_with_or_without_timestamps> number;
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  for (auto facet = complex.facets_begin(); facet != complex.facets_end(); ++facet) {
    std::array<int, 3> triangle;
    for (int i = 0; i < 3; ++i) {
      const auto vertex = facet->first->vertex((facet->second + 1 + i) & 3);
      const auto [entry, added] = number.try_emplace(vertex, int(points.size()));
      if (added) points.push_back(to_vector(vertex->point()));
      triangle[i] = entry->second;
    }
    const Vec3 &a = points[triangle[0]], &b = points[triangle[1]], &c = points[triangle[2]];
    if ((b - a).cross(c - a).dot(surface.normal((a + b + c) / 3)) < 0) std::swap(triangle[1], triangle[2]);
    triangles.push_back(triangle);
  }
  Mesh mesh;
  mesh.nodes.resize(points.size(), 3);
  for (std::size_t i = 0; i < points.size(); ++i) mesh.nodes.row(i) = points[i];
  mesh.elements.resize(triangles.size(), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (int j = 0; j < 3; ++j) mesh.elements(i, j) = triangles[i][j];
  project_nodes(mesh, surface);
  return mesh;
}

}  // namespace

Mesh delaunay_surface_mesh(const Surface& surface, const SizeFunction& size) {
  CGAL::get_default_random() = CGAL::Random(0);  // the mesher takes its first rays from it
  const double radius =
      1.5 * surface.bounding_radius;  // rays are clipped to this ball: the surface lies well inside
  const Point centre(surface.centre[0], surface.centre[1], surface.centre[2]);
  const auto level = [&surface](const Point& p) { return surface.level(to_vector(p)); };
  using Implicit = CGAL::Implicit_surface_3<Kernel, decltype(level)>;
  SpatialTriangulation triangulation;
  Complex complex(triangulation);
  // The bisection along a ray stops at 1e-4 of the radius: the exact projection follows.
  CGAL::make_surface_mesh(complex, Implicit(level, Kernel::Sphere_3(centre, radius * radius), 1e-4),
                          SizeCriterion(size), CGAL::Manifold_tag());
  return extract(complex, surface);
}

std::function<int(const Vec3&)> closest_node(const Field& nodes) {
  using Vertex = CGAL::Triangulation_vertex_base_with_info_3<int, Kernel>;
  using Delaunay = CGAL::Delaunay_triangulation_3<
      Kernel, CGAL::Triangulation_data_structure_3<Vertex, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>>;
  const auto triangulation = std::make_shared<Delaunay>();
  std::vector<std::pair<Point, int>> points;
  for (Eigen::Index i = 0; i < nodes.rows(); ++i)
    points.emplace_back(Point(nodes(i, 0), nodes(i, 1), nodes(i, 2)), int(i));
  triangulation->insert(points.begin(), points.end());
  return [triangulation](const Vec3& x) {
    return triangulation->nearest_vertex(Point(x[0], x[1], x[2]))->info();
  };
}

std::vector<std::size_t> hilbert_order(const Field& nodes) {
  std::vector<Point> points;
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) points.emplace_back(nodes(i, 0), nodes(i, 1), nodes(i, 2));
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  using Traits = CGAL::Spatial_sort_traits_adapter_3<Kernel, CGAL::Pointer_property_map<Point>::type>;
  CGAL::hilbert_sort(order.begin(), order.end(), Traits(CGAL::make_property_map(points)));
  return order;
}

}  // namespace esfem
