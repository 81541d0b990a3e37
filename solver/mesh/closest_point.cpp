// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/closest_point.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "solver/fe/lagrange.hpp"

namespace esfem {
namespace {

using Cartesian = CGAL::Simple_cartesian<double>;

/// The point at (xi, eta) of an element, and its derivatives.
struct Jet {
  Vec3 y;
  Eigen::Matrix<double, 3, 2> J;
};

Jet jet(const Mesh& mesh, int element, double xi, double eta) {
  const ShapeTable shapes = shape_functions(mesh.degree, Eigen::RowVector2d(xi, eta));
  const Field nodes = mesh.nodes(mesh.elements.row(element), Eigen::all);
  Jet jet;
  jet.y = (shapes.value * nodes).transpose();
  jet.J << (shapes.dxi * nodes).transpose(), (shapes.deta * nodes).transpose();
  return jet;
}

constexpr int most_steps = 40;
constexpr double small_step = 1e-14, slack = 1e-12;

}  // namespace

struct ClosestPoint::Tree {
  using Triangle = Cartesian::Triangle_3;
  using Primitive = CGAL::AABB_triangle_primitive<Cartesian, std::vector<Triangle>::const_iterator>;

  std::vector<Triangle> triangles;      ///< k² for each element
  std::vector<Eigen::Vector2d> middle;  ///< reference coordinates of the first k² triangles' middles
  CGAL::AABB_tree<CGAL::AABB_traits<Cartesian, Primitive>> tree;

  explicit Tree(const Mesh& mesh) {
    const int k = mesh.degree;
    Eigen::Matrix<double, Eigen::Dynamic, 2> corners(3 * k * k, 2);
    int n = 0;
    const auto add = [&](double a, double b, double c, double d, double e, double f) {
      corners.middleRows(n, 3) << a, b, c, d, e, f;
      n += 3;
    };
    for (int i = 0; i < k; ++i)
      for (int j = 0; i + j < k; ++j) {
        add(i, j, i + 1, j, i, j + 1);
        if (i + j + 2 <= k) add(i + 1, j, i + 1, j + 1, i, j + 1);
      }
    corners /= k;
    for (int i = 0; i < n; i += 3) middle.push_back(corners.middleRows(i, 3).colwise().mean());
    const Eigen::MatrixXd shapes = shape_functions(k, corners).value;
    for (int e = 0; e < mesh.elements.rows(); ++e) {
      const Field x = shapes * Field(mesh.nodes(mesh.elements.row(e), Eigen::all));
      const auto point = [&](int i) { return Cartesian::Point_3(x(i, 0), x(i, 1), x(i, 2)); };
      for (int i = 0; i < n; i += 3) triangles.emplace_back(point(i), point(i + 1), point(i + 2));
    }
    tree.rebuild(triangles.cbegin(), triangles.cend());
    tree.accelerate_distance_queries();
  }
};

ClosestPoint::ClosestPoint(const Mesh& mesh)
    : mesh_(mesh), around_(mesh.nodes.rows()), tree_(std::make_unique<Tree>(mesh)) {
  for (int e = 0; e < mesh.elements.rows(); ++e)
    for (int i = 0; i < 3; ++i) around_[mesh.elements(e, i)].push_back(e);
}

ClosestPoint::~ClosestPoint() = default;

ClosestPoint::Trial ClosestPoint::closest_in(int element, double xi, double eta, const Vec3& x) const {
  for (int n = 0; n < most_steps; ++n) {
    const Jet at = jet(mesh_, element, xi, eta);
    const Eigen::Vector2d step = (at.J.transpose() * at.J).ldlt().solve(at.J.transpose() * (x - at.y));
    if (!step.allFinite() || step.norm() > 4) break;
    xi += step[0];
    eta += step[1];
    if (xi < -1 || eta < -1 || xi + eta > 2) break;  // where the map means nothing
    if (step.norm() < small_step) break;
  }
  const bool is_inside = xi >= -slack && eta >= -slack && xi + eta <= 1 + slack;
  if (is_inside) return {{element, xi, eta, jet(mesh_, element, xi, eta).y}, true};
  ElementPoint best = closest_on_side(element, 0, x);
  for (int side : {1, 2}) {
    const ElementPoint other = closest_on_side(element, side, x);
    if ((other.y - x).norm() < (best.y - x).norm()) best = other;
  }
  return {best, false};
}

ElementPoint ClosestPoint::closest_on_side(int element, int side, const Vec3& x) const {
  const Eigen::Vector2d corner[3] = {{0, 0}, {1, 0}, {0, 1}};
  const Eigen::Vector2d from = corner[side], along = corner[(side + 1) % 3] - from;
  double s = 0.5;
  for (int n = 0; n < most_steps; ++n) {
    const Eigen::Vector2d at = from + s * along;
    const Jet here = jet(mesh_, element, at[0], at[1]);
    const Vec3 tangent = here.J * along;
    const double next = std::clamp(s + tangent.dot(x - here.y) / tangent.squaredNorm(), 0.0, 1.0);
    const double step = next - s;
    s = next;
    if (std::abs(step) < small_step) break;
  }
  const Eigen::Vector2d at = from + s * along;
  return {element, at[0], at[1], jet(mesh_, element, at[0], at[1]).y};
}

ElementPoint ClosestPoint::operator()(const Vec3& x) const {
  const auto triangle = tree_->tree.closest_point_and_primitive({x[0], x[1], x[2]}).second;
  const int index = int(triangle - tree_->triangles.cbegin()), parts = int(tree_->middle.size());
  const Eigen::Vector2d start = tree_->middle[index % parts];
  const int first = index / parts;
  Trial best = closest_in(first, start[0], start[1], x);
  if (best.is_inside) return best.point;
  std::set<int> neighbours;
  for (int i = 0; i < 3; ++i)
    for (int e : around_[mesh_.elements(first, i)]) neighbours.insert(e);
  neighbours.erase(first);
  for (int e : neighbours) {
    const Trial other = closest_in(e, 1.0 / 3, 1.0 / 3, x);
    if ((other.point.y - x).norm() < (best.point.y - x).norm()) best = other;
  }
  return best.point;
}

}  // namespace esfem
