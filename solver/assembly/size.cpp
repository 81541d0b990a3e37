// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/assembly/size.hpp"

#include <cmath>
#include <utility>

#include "solver/constants.hpp"

namespace esfem {

namespace {

/// Area of the triangles between the corners, and its first moment: the integral of x over them.
std::pair<double, Vec3> area_and_moment(const Mesh& mesh) {
  const Field& x = mesh.nodes;
  double sum = 0;
  Vec3 moment = Vec3::Zero();
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    const Vec3 a = x.row(mesh.elements(e, 0)), b = x.row(mesh.elements(e, 1)), c = x.row(mesh.elements(e, 2));
    const double area = (b - a).cross(c - a).norm() / 2;
    sum += area;
    moment += area / 3 * (a + b + c);
  }
  return {sum, moment};
}

}  // namespace

double area_of_triangles(const Mesh& mesh) {
  return area_and_moment(mesh).first;
}

double characteristic_length(const Mesh& mesh) {
  const double exponent = std::round(std::log10(std::sqrt(area_of_triangles(mesh) / (4 * pi))));
  return std::isfinite(exponent) ? std::pow(10, exponent) : 1;
}

Vec3 centroid(const Mesh& mesh) {
  const auto [area, moment] = area_and_moment(mesh);
  return moment / area;
}

Vec3 far_centre(const Field& x, double length) {
  Vec3 centre = x.colwise().mean();
  for (double& coordinate : centre)
    coordinate = std::abs(coordinate) < 10 * length ? 0 : length * std::round(coordinate / length);
  return centre;
}

}  // namespace esfem
