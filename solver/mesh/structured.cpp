// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/mesh/profile_grid.hpp"
#include "solver/surfaces/angenent_torus.hpp"

namespace esfem {

Mesh subdivide(const Mesh& mesh) {
  const Mesh quadratic = lagrange_mesh(mesh, 2);
  Mesh result;
  result.nodes = quadratic.nodes;
  result.elements.resize(4 * mesh.elements.rows(), 3);
  const int child[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
  for (int e = 0; e < mesh.elements.rows(); ++e)
    for (int c = 0; c < 4; ++c)
      for (int i = 0; i < 3; ++i) result.elements(4 * e + c, i) = quadratic.elements(e, child[c][i]);
  return result;
}

namespace {

void put_on_sphere(Mesh& mesh, double radius) {
  for (int i = 0; i < mesh.nodes.rows(); ++i) mesh.nodes.row(i) *= radius / mesh.nodes.row(i).norm();
}

Mesh subdivided_sphere(Mesh mesh, double radius, int subdivisions) {
  if (!(radius > 0) || !std::isfinite(radius))
    throw InputError(format("radius %g of a sphere mesh, a positive number expected", radius));
  if (subdivisions < 0 || subdivisions > 10)
    throw InputError(format("%d subdivisions of a sphere mesh, 0 to 10 expected", subdivisions));
  put_on_sphere(mesh, radius);
  for (int s = 0; s < subdivisions; ++s) {
    mesh = subdivide(mesh);
    put_on_sphere(mesh, radius);
  }
  return mesh;
}

}  // namespace

Mesh icosphere(double radius, int subdivisions) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  Mesh mesh;
  mesh.nodes.resize(12, 3);
  mesh.nodes << -1, g, 0, 1, g, 0, -1, -g, 0, 1, -g, 0,  //
      0, -1, g, 0, 1, g, 0, -1, -g, 0, 1, -g,            //
      g, 0, -1, g, 0, 1, -g, 0, -1, -g, 0, 1;
  mesh.elements.resize(20, 3);
  mesh.elements << 0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11,  //
      1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6, 7, 1, 8,               //
      3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9,                   //
      4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6, 7, 9, 8, 1;
  return subdivided_sphere(std::move(mesh), radius, subdivisions);
}

Mesh octasphere(double radius, int subdivisions) {
  Mesh mesh;
  mesh.nodes.resize(6, 3);
  mesh.nodes << 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  mesh.elements.resize(8, 3);
  mesh.elements << 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 1, 0, 5, 2, 1, 5, 3, 2, 5, 0, 3, 5;
  return subdivided_sphere(std::move(mesh), radius, subdivisions);
}

namespace {

void check_torus_radii(double major, double minor) {
  if (!(minor > 0) || !(major > minor) || !std::isfinite(major))
    throw InputError(format("torus radii %g and %g, 0 < minor < major expected", major, minor));
}

/// The grid whose nodes have the angles `around(j)`, j = 0, ..., n_minor - 1, around the tube.
template <class Angle>
Mesh torus_grid_with_angles(double major, double minor, int n_major, int n_minor, Angle around) {
  check_torus_radii(major, minor);
  Eigen::Matrix2Xd profile(2, std::max(n_minor, 0));
  for (int j = 0; j < n_minor; ++j)
    profile.col(j) << major + minor * std::cos(around(j)), minor * std::sin(around(j));
  return profile_grid(profile, n_major);
}

}  // namespace

Mesh profile_grid(const Eigen::Matrix2Xd& profile, int n_around) {
  const int n_profile = static_cast<int>(profile.cols());
  if (n_around < 3 || n_profile < 3)
    throw InputError(format("torus grid of %d x %d cells, at least 3 x 3 expected", n_around, n_profile));
  Mesh mesh;
  mesh.nodes.resize(n_around * n_profile, 3);
  mesh.elements.resize(2 * n_around * n_profile, 3);
  const auto number = [&](int i, int j) { return i % n_around * n_profile + j % n_profile; };
  for (int i = 0; i < n_around; ++i)
    for (int j = 0; j < n_profile; ++j) {
      const double along = turn * i / n_around;
      mesh.nodes.row(number(i, j)) << profile(0, j) * std::cos(along), profile(0, j) * std::sin(along),
          profile(1, j);
      const int a = number(i, j), b = number(i + 1, j), c = number(i + 1, j + 1), d = number(i, j + 1);
      // Alternating diagonals: every node has four or eight neighbours, except beside a seam of an odd count.
      const int e = 2 * a;
      if ((i + j) % 2 == 0) {
        mesh.elements.row(e) << a, b, c;
        mesh.elements.row(e + 1) << a, c, d;
      } else {
        mesh.elements.row(e) << a, b, d;
        mesh.elements.row(e + 1) << b, c, d;
      }
    }
  return mesh;
}

Mesh angenent_torus_grid(int n_around, int n_profile) {
  const AngenentProfile& profile = angenent_profile();
  Eigen::Matrix2Xd points(2, std::max(n_profile, 0));
  // From the outer equator upwards, against the arclength.
  for (int j = 0; j < n_profile; ++j)
    points.col(j) = profile.at(profile.length() * (0.5 - j / double(n_profile))).position;
  return profile_grid(points, n_around);
}

Mesh torus_grid(double major, double minor, int n_major, int n_minor) {
  return torus_grid_with_angles(major, minor, n_major, n_minor,
                                [n_minor](int j) { return turn * j / n_minor; });
}

Mesh isothermal_torus_grid(double major, double minor, int n_major, int n_minor) {
  // Integral of r d theta/(R + r cos theta): tan(theta/2) = sqrt((R + r)/(R - r)) tan(s psi/(2r)), s² = R² -
  // r², with the period 2 pi r/s in psi.
  return torus_grid_with_angles(major, minor, n_major, n_minor, [=](int j) {
    const double half = turn / 2 * j / n_minor;
    return 2 *
           std::atan2(std::sqrt(major + minor) * std::sin(half), std::sqrt(major - minor) * std::cos(half));
  });
}

std::function<double(const Vec3&)> radial_edge_length(double inner_distance, double inner_length,
                                                      double outer_distance, double outer_length) {
  if (!(inner_distance >= 0) || !(outer_distance > inner_distance))
    throw InputError(
        format("edge lengths at the distances %g and %g from the axis, 0 <= first < second expected",
               inner_distance, outer_distance));
  return [=](const Vec3& y) {
    const double outwards = (std::hypot(y[0], y[1]) - inner_distance) / (outer_distance - inner_distance);
    return inner_length + (outer_length - inner_length) * std::clamp(outwards, 0.0, 1.0);
  };
}

std::function<double(const Vec3&)> torus_edge_length(double major, double minor, double largest) {
  check_torus_radii(major, minor);
  const double smallest = largest * std::min(1.0, (major - minor) / minor);
  return radial_edge_length(major - minor, smallest, major + minor, largest);
}

std::function<double(const Vec3&)> angenent_torus_edge_length(double largest) {
  const AngenentProfile& profile = angenent_profile();
  return radial_edge_length(profile.at(0).position[0], largest / 2,
                            profile.at(profile.length() / 2).position[0], largest);
}

}  // namespace esfem
