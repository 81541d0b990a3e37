// SPDX-License-Identifier: GPL-3.0-or-later
// Elements are oriented alike and outward, component by component.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "solver/constants.hpp"
#include "solver/mesh/read.hpp"
#include "tests/mesh/mesh_files.hpp"

namespace esfem::test_orientation {

using testing::AllOf;
using testing::HasSubstr;

namespace {

Mesh scaled(Mesh mesh, double by, double shift = 0) {
  mesh.nodes *= by;
  mesh.nodes.array() += shift;
  return mesh;
}

/// Swaps two corners of an element (of degree 1).
void turn(Mesh& mesh, int e) {
  std::swap(mesh.elements(e, 1), mesh.elements(e, 2));
}

Mesh inside_out(Mesh mesh) {
  for (int e = 0; e < mesh.elements.rows(); ++e) turn(mesh, e);
  return mesh;
}

/// A grid of the square whose sides i = 0 and i = n are one, and so are j = 0 and j = n, the second pair
/// turned when `twisted`; without the second pair when `open`. The positions are of no surface: all points
/// differ.
Mesh glued_square(int n, bool twisted, bool open) {
  Mesh mesh;
  const int rows = open ? n + 1 : n;
  mesh.nodes.resize(n * rows, 3);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < n; ++i) {
      const double u = 2 * pi * i / n, v = 2 * pi * j / n;
      mesh.nodes.row(n * j + i) << (2 + std::cos(u)) * std::cos(v), (2 + std::cos(u)) * std::sin(v),
          std::sin(u) + 0.3 * std::sin(v + 1);
    }
  const auto node = [&](int i, int j) {
    if (j == n && !open) {
      j = 0;
      if (twisted) i = 2 * n - i;
    }
    return n * j + i % n;
  };
  mesh.elements.resize(2 * n * n, 3);
  for (int j = 0, e = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      mesh.elements.row(e++) << node(i, j), node(i + 1, j), node(i + 1, j + 1);
      mesh.elements.row(e++) << node(i, j), node(i + 1, j + 1), node(i, j + 1);
    }
  return mesh;
}

}  // namespace

TEST(Orient, TurnsTheFewElementsThatDiffer) {
  Mesh mesh = small_ellipsoid();
  for (int e : {3, 40, 41, 79}) turn(mesh, e);
  EXPECT_EQ(check_closed_surface(mesh, "here"), "4 elements oriented against the others: turned");
  EXPECT_NEAR(enclosed_volume(mesh), small_ellipsoid_volume, 1e-14);
  EXPECT_TRUE(closed_and_oriented(mesh));
  EXPECT_EQ(check_closed_surface(mesh, "here"), "");
}

TEST(Orient, FollowsMostOfTheElementsAndThenTheVolume) {
  Mesh mesh = small_ellipsoid();
  for (int e = 0; e < 75; ++e) turn(mesh, e);
  EXPECT_EQ(check_closed_surface(mesh, "here"),
            "5 elements oriented against the others: turned; orientation was inward: turned");
  EXPECT_EQ(mesh.elements.rows(), 80);
  EXPECT_NEAR(enclosed_volume(mesh), small_ellipsoid_volume, 1e-14);
}

TEST(Orient, CurvedElements) {
  for (int degree = 2; degree <= 4; ++degree) {
    Mesh corners = small_ellipsoid();
    for (int e = 0; e < 80; e += 3) turn(corners, e);
    // The edges of turned elements have their nodes in the order of the corners.
    Mesh mesh = lagrange_mesh(corners, degree);
    check_closed_surface(mesh, "here");
    EXPECT_TRUE(closed_and_oriented(mesh));
    EXPECT_NEAR(enclosed_volume(mesh), small_ellipsoid_volume, 1e-14);
  }
}

TEST(Orient, Components) {
  const Mesh a = small_ellipsoid(), b = scaled(a, 2, 10);
  Mesh both = together(a, b);
  EXPECT_EQ(check_closed_surface(both, "here"), "2 components");
  both = together(a, inside_out(b));
  EXPECT_EQ(check_closed_surface(both, "here"),
            "2 components; orientation of 1 component was inward: turned");
  EXPECT_NEAR(enclosed_volume(both), 9 * small_ellipsoid_volume, 1e-12);
  both = together(inside_out(a), inside_out(b));
  EXPECT_EQ(check_closed_surface(both, "here"),
            "2 components; orientation of 2 components were inward: turned");
  EXPECT_NEAR(enclosed_volume(both), 9 * small_ellipsoid_volume, 1e-12);
}

TEST(Orient, CavitiesKeepTheirOrientationRelativeToTheBody) {
  const Mesh body = icosphere(1, 2), cavity = scaled(icosphere(1, 1), 0.3),
             grain = scaled(icosphere(1, 1), 0.1, 0.02), other = scaled(icosphere(1, 1), 1, 5);
  const double hollow = enclosed_volume(body) - enclosed_volume(cavity);
  Mesh mesh = together(body, inside_out(cavity));
  EXPECT_EQ(check_closed_surface(mesh, "here"), "2 components");
  EXPECT_NEAR(enclosed_volume(mesh), hollow, 1e-13);
  mesh = together(cavity, inside_out(body));
  EXPECT_EQ(check_closed_surface(mesh, "here"),
            "2 components; orientation of 2 components were inward: turned");
  EXPECT_NEAR(enclosed_volume(mesh), hollow, 1e-13);
  // A body in the cavity, and another one outside.
  mesh = together(together(inside_out(grain), cavity), together(other, inside_out(body)));
  EXPECT_EQ(check_closed_surface(mesh, "here"),
            "4 components; orientation of 3 components were inward: turned");
  EXPECT_NEAR(enclosed_volume(mesh), hollow + enclosed_volume(grain) + enclosed_volume(other), 1e-12);
  // Both outward, as the file says: two bodies.
  mesh = together(body, cavity);
  EXPECT_EQ(check_closed_surface(mesh, "here"), "2 components");
}

TEST(Orient, RefusesOneSidedSurfaces) {
  EXPECT_EQ(check_complaint(glued_square(6, false, false)).find("orientable"), std::string::npos);
  EXPECT_THAT(check_complaint(glued_square(6, true, false)),
              AllOf(HasSubstr("here: element "), HasSubstr("not orientable"), HasSubstr("Klein bottle")));
  EXPECT_THAT(check_complaint(glued_square(6, false, true)), HasSubstr("not closed, 2 boundary loops"));
}

TEST(Orient, RefusesSurfacesWithoutVolume) {
  Mesh flat = octasphere(1, 0);
  flat.nodes.col(2).setConstant(7);
  EXPECT_THAT(check_complaint(flat), AllOf(HasSubstr("element 1 "), HasSubstr("pressed flat")));
  // A thin one is a surface, at any size and place; one of two that is flat is found.
  Mesh thin = octasphere(1, 0);
  thin.nodes.col(2) *= 1e-7;
  for (double size : {1e-9, 1., 1e9}) EXPECT_EQ(check_complaint(scaled(thin, size)), "");
  EXPECT_THAT(check_complaint(together(scaled(thin, 1, 5), flat)),
              AllOf(HasSubstr("element 9 "), HasSubstr("pressed flat")));
}

}  // namespace esfem::test_orientation
