// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/curve.hpp"

#include <algorithm>
#include <cmath>

#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/fe/quadrature.hpp"

namespace esfem {

namespace {

/// u^i v^j for 1 <= i + j <= degree with their derivatives.
struct Monomials {
  Eigen::VectorXd value, du, dv;

  Monomials(double u, double v, int degree) {
    const int count = (degree + 1) * (degree + 2) / 2 - 1;
    value.resize(count);
    du.resize(count);
    dv.resize(count);
    int k = 0;
    for (int n = 1; n <= degree; ++n)
      for (int j = 0; j <= n; ++j, ++k) {
        const int i = n - j;
        value[k] = std::pow(u, i) * std::pow(v, j);
        du[k] = i == 0 ? 0 : i * std::pow(u, i - 1) * std::pow(v, j);
        dv[k] = j == 0 ? 0 : j * std::pow(u, i) * std::pow(v, j - 1);
      }
  }
};

int coefficient_count(int degree) {
  return (degree + 1) * (degree + 2) / 2 - 1;
}

Mat3 frame_around(const Vec3& normal) {
  Mat3 frame;
  frame.col(2) = normal;
  frame.col(0) = normal.unitOrthogonal();
  frame.col(1) = normal.cross(frame.col(0));
  return frame;
}

/// Sectors around one, ring by ring, until there are `wanted`, at most four rings. Where the surface turns
/// away it is no longer a graph over the tangent plane: no neighbours are collected there.
std::vector<int> sectors_around(int centre, int wanted, const std::vector<Vec3>& normals,
                                const std::vector<std::vector<int>>& neighbours) {
  const int most_rings = 4;
  const double smallest_cosine = 0.3;
  std::vector<int> found{centre};
  std::size_t begin = 0;
  for (int ring = 0; ring < most_rings && int(found.size()) <= wanted; ++ring) {
    const std::size_t end = found.size();
    for (; begin < end; ++begin)
      for (int other : neighbours[found[begin]])
        if (normals[other].dot(normals[centre]) > smallest_cosine &&
            std::find(found.begin(), found.end(), other) == found.end())
          found.push_back(other);
  }
  found.erase(found.begin());
  return found;
}

/// Lagrange interpolation at t through points, whose parameters are the lengths of the polyline.
Vec3 on_curve_through(const std::vector<Vec3>& points, int from, double s) {
  std::vector<double> t{0};
  for (std::size_t i = 1; i < points.size(); ++i) t.push_back(t.back() + (points[i] - points[i - 1]).norm());
  const double at = t[from] + s * (t[from + 1] - t[from]);
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    double weight = 1;
    for (std::size_t j = 0; j < points.size(); ++j)
      if (j != i) weight *= (at - t[j]) / (t[i] - t[j]);
    sum += weight * points[i];
  }
  return sum;
}

}  // namespace

SmoothSurface::SmoothSurface(const Mesh& flat, int degree, double feature_angle)
    : flat_(flat), features_(find_features(flat, feature_angle)), along_feature_(degree / 2) {
  if (flat.degree != 1 || degree < 2 || degree > max_degree)
    throw InputError(
        format("curved elements of degree %d through a mesh of degree %d, 2 to %d and 1 expected", degree,
               flat.degree, max_degree));
  node_of_sector_.resize(features_.sectors);
  std::vector<std::vector<int>> neighbours(features_.sectors);
  for (int h = 0; h < int(features_.sector.size()); ++h) {
    const int sector = features_.sector[h];
    node_of_sector_[sector] = flat.elements(h / 3, h % 3);
    for (int i = 1; i < 3; ++i) {
      const int other = features_.sector[h / 3 * 3 + (h + i) % 3];
      if (std::find(neighbours[sector].begin(), neighbours[sector].end(), other) == neighbours[sector].end())
        neighbours[sector].push_back(other);
    }
  }
  const std::vector<Vec3> normals = sector_normals();
  heights_.resize(features_.sectors);
  for (int sector = 0; sector < features_.sectors; ++sector) fit(sector, degree + 2, normals, neighbours);
}

/// With the weights of Max (Journal of Graphics Tools 4, 1999), exact when all corners lie on a sphere.
std::vector<Vec3> SmoothSurface::sector_normals() const {
  std::vector<Vec3> normals(features_.sectors, Vec3::Zero());
  for (int e = 0; e < flat_.elements.rows(); ++e)
    for (int i = 0; i < 3; ++i) {
      const Vec3 a = corner(e, i + 1) - corner(e, i), b = corner(e, i + 2) - corner(e, i);
      normals[features_.sector[3 * e + i]] += a.cross(b) / (a.squaredNorm() * b.squaredNorm());
    }
  for (Vec3& normal : normals) normal.normalize();
  return normals;
}

void SmoothSurface::fit(int sector, int degree, const std::vector<Vec3>& normals,
                        const std::vector<std::vector<int>>& neighbours) {
  // More than coefficients, but not many: further rings cost more on a coarse mesh than they even out.
  const std::vector<int> around =
      sectors_around(sector, coefficient_count(degree) * 6 / 5, normals, neighbours);
  const int n = int(around.size());
  while (degree > 1 && coefficient_count(degree) > n) --degree;
  Height& height = heights_[sector];
  height.origin = flat_.nodes.row(node_of_sector_[sector]);
  height.frame = frame_around(normals[sector]);
  height.degree = degree;
  height.coefficients = Eigen::VectorXd::Zero(coefficient_count(degree));
  if (n == 0) return;
  Eigen::MatrixX3d local(n, 3);
  for (int i = 0; i < n; ++i)
    local.row(i) = (flat_.nodes.row(node_of_sector_[around[i]]) - height.origin.transpose()) * height.frame;
  height.radius = local.leftCols<2>().rowwise().norm().maxCoeff();
  local /= height.radius;
  // The fit is wanted within the first ring: what is twice as far away counts a quarter; but no corner of a
  // needle counts for all.
  const double nearest = 0.1;
  const Eigen::VectorXd weights = (local.rowwise().squaredNorm().array() + nearest * nearest).inverse();
  Eigen::MatrixXd terms(n, coefficient_count(degree));
  for (int i = 0; i < n; ++i) terms.row(i) = weights[i] * Monomials(local(i, 0), local(i, 1), degree).value;
  // The smallest solution where terms depend on each other: a cylinder whose corners are all on its two rims
  // stays straight along its axis.
  const Eigen::RowVectorXd scale = terms.colwise().norm().cwiseMax(1e-300);
  terms.array().rowwise() /= scale.array();
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(1e-4);
  decomposition.compute(terms);
  height.coefficients =
      decomposition.solve(weights.cwiseProduct(local.col(2))).array() / scale.transpose().array();
}

/// About the signed distance from the surface of a fit, and the direction away from it.
SmoothSurface::Level SmoothSurface::distance(const Height& height, const Vec3& x) {
  const Vec3 local = height.frame.transpose() * (x - height.origin) / height.radius;
  const Monomials terms(local[0], local[1], height.degree);
  const Vec3 gradient =
      height.frame * Vec3(-height.coefficients.dot(terms.du), -height.coefficients.dot(terms.dv), 1);
  const double slope = gradient.norm();
  return {height.radius * (local[2] - height.coefficients.dot(terms.value)) / slope, gradient / slope};
}

/// Newton's method along the blended normals, which comes to the closest point but for O(h^5).
Vec3 SmoothSurface::blended_point(int element, const Vec3& weights, const Vec3& start) const {
  const int most_steps = 20;
  const double size = (corner(element, 1) - corner(element, 0)).norm();
  Vec3 x = start;
  for (int step = 0; step < most_steps; ++step) {
    double value = 0;
    Vec3 gradient = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
      if (weights[i] == 0) continue;
      const Level level = distance(heights_[features_.sector[3 * element + i]], x);
      value += weights[i] * level.value;
      gradient += weights[i] * level.gradient;
    }
    x -= value / gradient.squaredNorm() * gradient;
    if (!(std::abs(value) > 1e-14 * size)) break;
  }
  return x;
}

Vec3 SmoothSurface::feature_point(int side, double s) const {
  const auto start_of = [&](int h) { return corner(h / 3, h % 3); };
  const auto end_of = [&](int h) { return corner(h / 3, h % 3 + 1); };
  std::vector<Vec3> points{start_of(side), end_of(side)};
  int from = 0;
  const auto& next = features_.next_sharp;
  for (int h = features_.next_sharp[side], i = 0; i < along_feature_ && h >= 0; h = next[h], ++i)
    points.push_back(end_of(h));
  for (int h = next[features_.twin[side]], i = 0; i < along_feature_ && h >= 0; h = next[h], ++i) {
    points.insert(points.begin(), end_of(h));
    ++from;
  }
  return on_curve_through(points, from, s);
}

Vec3 SmoothSurface::point(int element, const Vec3& weights, bool& is_wild) const {
  const double largest_distance = 0.25;  // relative to the longest edge; an arc of 90 degrees has 0.21
  Vec3 flat = Vec3::Zero();
  double longest = 0;
  int sharp_side = -1;
  for (int i = 0; i < 3; ++i) {
    flat += weights[i] * corner(element, i);
    longest = std::max(longest, (corner(element, i + 1) - corner(element, i)).norm());
    if (weights[(i + 2) % 3] == 0 && features_.sharp[3 * element + i]) sharp_side = i;
  }
  const Vec3 x = sharp_side >= 0 ? feature_point(3 * element + sharp_side, weights[(sharp_side + 1) % 3])
                                 : blended_point(element, weights, flat);
  is_wild = !((x - flat).norm() <= largest_distance * longest);
  return is_wild ? flat : x;
}

Vec3 SmoothSurface::point(int element, const Vec3& weights) const {
  bool is_wild;
  return point(element, weights, is_wild);
}

namespace {

/// Elements whose normal somewhere points away from that of their flat triangle, or whose area vanishes
/// there.
std::vector<int> folded_elements(const Mesh& mesh) {
  const double least = 0.1;  // relative to the flat triangle
  const ShapeTable inner = shape_functions(mesh.degree, default_quadrature(mesh.degree).points),
                   nodal = shape_functions(mesh.degree, reference_nodes(mesh.degree));
  Eigen::MatrixXd dxi(inner.dxi.rows() + nodal.dxi.rows(), inner.dxi.cols()), deta(dxi.rows(), dxi.cols());
  dxi << inner.dxi, nodal.dxi;
  deta << inner.deta, nodal.deta;
  std::vector<int> folded;
  Field x(mesh.elements.cols(), 3);
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    for (int i = 0; i < x.rows(); ++i) x.row(i) = mesh.nodes.row(mesh.elements(e, i));
    const Vec3 flat = Vec3(x.row(1) - x.row(0)).cross(Vec3(x.row(2) - x.row(0)));
    const Field a = dxi * x, b = deta * x;
    for (int q = 0; q < a.rows(); ++q)
      if (!(Vec3(a.row(q)).cross(Vec3(b.row(q))).dot(flat) > least * flat.squaredNorm())) {
        folded.push_back(e);
        break;
      }
  }
  return folded;
}

}  // namespace

CurvedMesh curved_mesh(const Mesh& flat, int degree, double feature_angle) {
  const SmoothSurface surface(flat, degree, feature_angle);
  CurvedMesh result{lagrange_mesh(flat, degree), surface.features().sharp_edges,
                    int(flat.elements.rows()) * 3 / 2};
  Mesh& mesh = result.mesh;
  const Field straight = mesh.nodes;
  const auto reference = reference_nodes(degree);
  std::vector<bool> done(mesh.nodes.rows(), false), is_straight(mesh.nodes.rows(), false);
  for (int e = 0; e < mesh.elements.rows(); ++e)
    for (int i = 3; i < mesh.elements.cols(); ++i) {
      const int node = mesh.elements(e, i);
      if (done[node]) continue;
      done[node] = true;
      const double xi = reference(i, 0), eta = reference(i, 1);
      // On the edge opposite to corner 0 this weight is a round-off.
      const double first = std::abs(1 - xi - eta) < 1e-12 ? 0 : 1 - xi - eta;
      bool is_wild;
      mesh.nodes.row(node) = surface.point(e, {first, xi, eta}, is_wild);
      is_straight[node] = is_wild;
    }
  // A straightened edge changes its neighbour: again until none folds; at last all are straight.
  for (std::vector<int> folded; !(folded = folded_elements(mesh)).empty();) {
    bool changed = false;
    for (int e : folded)
      for (int i = 3; i < mesh.elements.cols(); ++i) {
        const int node = mesh.elements(e, i);
        changed |= !is_straight[node];
        mesh.nodes.row(node) = straight.row(node);
        is_straight[node] = true;
      }
    if (!changed) break;
  }
  result.straight = int(std::count(is_straight.begin(), is_straight.end(), true));
  return result;
}

bool is_flat(const Mesh& mesh) {
  const double allowance = 1e-6;  // relative to the longest edge: coordinates may have single precision
  const Eigen::MatrixXd corners = shape_functions(1, reference_nodes(mesh.degree)).value;
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    Field x(mesh.elements.cols(), 3);
    for (int i = 0; i < x.rows(); ++i) x.row(i) = mesh.nodes.row(mesh.elements(e, i));
    const Field off = x - corners * x.topRows(3);
    const double longest =
        std::max({(x.row(1) - x.row(0)).norm(), (x.row(2) - x.row(1)).norm(), (x.row(0) - x.row(2)).norm()});
    if (off.rowwise().norm().maxCoeff() > allowance * longest) return false;
  }
  return true;
}

}  // namespace esfem
