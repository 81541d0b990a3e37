// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/features.hpp"

#include <algorithm>
#include <cmath>

#include "solver/constants.hpp"
#include "solver/disjoint_sets.hpp"
#include "solver/error.hpp"
#include "solver/mesh/sides.hpp"

namespace esfem {

namespace {

Vec3 vector_along(const Mesh& mesh, int side) {
  return mesh.nodes.row(side_corner(mesh.elements, side, 1)) -
         mesh.nodes.row(side_corner(mesh.elements, side, 0));
}

Vec3 doubled_area_vector(const Mesh& mesh, int element) {
  return vector_along(mesh, 3 * element).cross(vector_along(mesh, 3 * element + 1));
}

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / pi;
}

/// Whether one corner of a triangle almost lies on the opposite side, and on which.
int opposite_of_flat_corner(const Mesh& mesh, int element) {
  const double flat = 150;
  for (int i = 0; i < 3; ++i) {
    const int h = 3 * element + i;
    if (angle_between(vector_along(mesh, side_after(h)), -vector_along(mesh, h)) > flat)
      return side_before(h);
  }
  return -1;
}

/// Sides across which `normals` differ by more than the angle.
std::vector<bool> sharp_edges(const std::vector<Vec3>& normals, const std::vector<int>& twin, double angle) {
  std::vector<bool> sharp(twin.size());
  for (std::size_t h = 0; h < twin.size(); ++h)
    sharp[h] = angle_between(normals[h / 3], normals[twin[h] / 3]) > angle;
  return sharp;
}

/// On a curved surface the normal of a triangle whose corner almost lies on the opposite side is arbitrary:
/// where it differs from its neighbours, it gets the normal of the one across the long side, with which it
/// forms a sound quadrilateral.
void lay_down_caps(const Mesh& mesh, const std::vector<int>& twin, const std::vector<bool>& sharp,
                   std::vector<Vec3>& normals) {
  const std::vector<Vec3> own = normals;
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    if (sharp[3 * e] + sharp[3 * e + 1] + sharp[3 * e + 2] < 2) continue;
    const int side = opposite_of_flat_corner(mesh, e);
    if (side >= 0) normals[e] = own[twin[side] / 3];
  }
}

/// Numbers the sectors of the corners: sides with the same first corner are united across edges that are not
/// sharp.
void number_sectors(Features& features) {
  const int n = int(features.twin.size());
  DisjointSets sets(n);
  for (int h = 0; h < n; ++h)
    if (!features.sharp[h]) sets.unite(h, side_after(features.twin[h]));
  features.sector = sets.numbered();
  features.sectors = sets.count();
}

void link_sharp_edges(const Mesh& mesh, double angle, Features& features) {
  const int n = int(features.twin.size());
  std::vector<std::vector<int>> leaving(mesh.nodes.rows());
  for (int h = 0; h < n; ++h)
    if (features.sharp[h]) leaving[side_corner(mesh.elements, h, 0)].push_back(h);
  features.next_sharp.assign(n, -1);
  for (int h = 0; h < n; ++h) {
    if (!features.sharp[h]) continue;
    const std::vector<int>& here = leaving[side_corner(mesh.elements, h, 1)];
    if (here.size() != 2) continue;
    const int next = here[0] == features.twin[h] ? here[1] : here[0];
    if (angle_between(vector_along(mesh, h), vector_along(mesh, next)) <= angle)
      features.next_sharp[h] = next;
  }
}

}  // namespace

Features find_features(const Mesh& mesh, double angle) {
  if (!(angle > 0 && angle <= 180))
    throw InputError(format("feature angle %g, more than 0 and at most 180 degrees expected", angle));
  const std::vector<int> twin = side_twins(mesh.elements);
  if (*std::min_element(twin.begin(), twin.end()) < 0)
    throw InputError("features of a mesh that is not closed, a closed one expected");
  std::vector<Vec3> normals(mesh.elements.rows());
  for (int e = 0; e < mesh.elements.rows(); ++e) normals[e] = doubled_area_vector(mesh, e);
  lay_down_caps(mesh, twin, sharp_edges(normals, twin, angle), normals);
  return features_along(mesh, twin, sharp_edges(normals, twin, angle), angle);
}

Features features_along(const Mesh& mesh, const std::vector<int>& twin, const std::vector<bool>& sharp,
                        double angle) {
  Features features;
  features.twin = twin;
  features.sharp = sharp;
  features.sharp_edges = int(std::count(sharp.begin(), sharp.end(), true) / 2);
  number_sectors(features);
  link_sharp_edges(mesh, angle, features);
  return features;
}

}  // namespace esfem
