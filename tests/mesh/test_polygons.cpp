// SPDX-License-Identifier: GPL-3.0-or-later
// Quadrangles and polygons of more corners are cut into triangles.
#include <gmock/gmock.h>

#include <cmath>

#include "solver/constants.hpp"
#include "solver/mesh/polygons.hpp"
#include "tests/mesh/mesh_files.hpp"

namespace esfem::test_polygons {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

namespace {

using Outline = std::vector<std::pair<double, double>>;

/// The prism over a polygon, turned in space, with its n + 2 faces; bump moves the corners of its top up and
/// down.
Polygons prism(const Outline& outline, double bump = 0) {
  const int n = int(outline.size());
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  Polygons result;
  result.origin.source = "here";
  for (int z : {0, 1})
    for (int i = 0; i < n; ++i)
      result.points.push_back(turn *
                              Vec3(outline[i].first, outline[i].second, z * (1 + (i % 2 ? bump : -bump))));
  for (int i = n - 1; i >= 0; --i) result.corners.push_back(i);
  for (int i = 0; i < n; ++i) result.corners.push_back(n + i);
  result.sizes = {n, n};
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    for (int corner : {i, j, n + j, n + i}) result.corners.push_back(corner);
    result.sizes.push_back(4);
  }
  return result;
}

void expect_prism(const Outline& outline, double area, double length, double tolerance = 1e-14,
                  double bump = 0) {
  MeshFile file = triangulated(prism(outline, bump));
  const int n = int(outline.size());
  EXPECT_EQ(file.mesh.elements.rows(), 2 * (n - 2) + 2 * n);
  EXPECT_EQ(repair_and_check(file), format("%d polygons cut into triangles", n == 3 ? n : n + 2));
  EXPECT_NEAR(corner_area(file.mesh), 2 * area + length, tolerance);
  EXPECT_NEAR(enclosed_volume(file.mesh), area, tolerance);
}

std::string complaint(Polygons polygons) {
  try {
    triangulated(std::move(polygons));
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

const Outline quadrangle = {{0, 0}, {4, 0}, {1, 1}, {0, 4}};  // not convex at (1, 1)
const Outline letter_u = {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};

Outline regular(int n, double inner = 1) {
  Outline outline;
  for (int i = 0; i < n; ++i) {
    const double r = i % 2 ? inner : 1;
    outline.emplace_back(r * std::cos(2 * pi * i / n), r * std::sin(2 * pi * i / n));
  }
  return outline;
}

}  // namespace

TEST(Polygons, NonConvexOnesKeepTheirArea) {
  expect_prism({{0, 0}, {1, 0}, {0, 1}}, 0.5, 2 + std::sqrt(2.));
  expect_prism(quadrangle, 4, 8 + 2 * std::sqrt(10.));
  std::vector<int> starts = {0, 1, 2, 3};
  for (int start : starts) {
    Outline turned = quadrangle;
    std::rotate(turned.begin(), turned.begin() + start, turned.end());
    expect_prism(turned, 4, 8 + 2 * std::sqrt(10.));
  }
  for (int start = 0; start < 8; ++start) {
    Outline turned = letter_u;
    std::rotate(turned.begin(), turned.begin() + start, turned.end());
    expect_prism(turned, 7, 16);
  }
  // A star, and a circle of a thousand corners.
  const double edge = std::sqrt(1 + 0.09 - 0.6 * std::cos(pi / 7));
  expect_prism(regular(14, 0.3), 7 * 0.3 * std::sin(pi / 7), 14 * edge, 1e-13);
  expect_prism(regular(1000), 500 * std::sin(pi / 500), 2000 * std::sin(pi / 1000), 1e-11);
}

TEST(Polygons, CornersOnALine) {
  // The middles of the edges are corners: no triangle may be without area.
  expect_prism({{0, 0}, {0.3, 0}, {0.7, 0}, {1, 0}, {1, 1}, {0.4, 1}, {0, 1}, {0, 0.1}}, 1, 4);
  expect_prism({{0, 0}, {0.1, 0}, {0.2, 0}, {1, 0}, {0, 1}}, 0.5, 2 + std::sqrt(2.));
}

TEST(Polygons, SlightlyNonPlanarOnes) {
  for (const Outline& outline : {regular(8), letter_u, quadrangle}) {
    MeshFile file = triangulated(prism(outline, 1e-3));
    repair_and_check(file);
    MeshFile flat = triangulated(prism(outline));
    EXPECT_NEAR(enclosed_volume(file.mesh), enclosed_volume(flat.mesh), 1e-2);
  }
}

TEST(Polygons, QuadranglesHaveTheBetterDiagonal) {
  const Outline kite = {{0, 0}, {1, -0.2}, {3, 0}, {1, 0.2}};
  MeshFile file = triangulated(prism(kite));
  for (int e : {0, 1})
    for (int i = 0; i < 3; ++i) {
      const int a = file.mesh.elements(e, i), b = file.mesh.elements(e, (i + 1) % 3);
      EXPECT_LT((file.mesh.nodes.row(a) - file.mesh.nodes.row(b)).norm(), 2.1);
    }
}

TEST(Polygons, CornersInOnePlace) {
  // The quadrangles at a pole of a globe have two corners there, with a number for each of them.
  const int n = 6;
  std::string text;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= 3; ++j) {
      const double phi = 2 * pi * i / n, theta = pi * j / 3, r = j % 3 == 0 ? 0 : std::sin(theta);
      text += format("v %.17g %.17g %.17g\n", r * std::cos(phi), r * std::sin(phi), std::cos(theta));
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 3; ++j) {
      const int a = 4 * i + j + 1, b = 4 * ((i + 1) % n) + j + 1;
      text += format("f %d %d %d %d\n", a, a + 1, b + 1, b);
    }
  MeshFile file = parse_obj("globe", text);
  const std::string remark = repair_and_check(file);
  EXPECT_EQ(file.mesh.nodes.rows(), 2 + 2 * n);
  EXPECT_EQ(file.mesh.elements.rows(), 4 * n);
  EXPECT_THAT(remark, AllOf(HasSubstr("18 polygons cut"), HasSubstr("12 nodes in 2 places"),
                            HasSubstr("12 degenerate elements")));
}

TEST(Polygons, RefusesWhatIsNoSimplePolygon) {
  Outline crossing = {{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  EXPECT_THAT(complaint(prism(crossing)),
              HasSubstr("element 1 (counted from 1): its polygon crosses or touches itself"));
  Outline pentagram;
  for (int i = 0; i < 5; ++i) pentagram.emplace_back(std::cos(0.8 * pi * i), std::sin(0.8 * pi * i));
  EXPECT_THAT(complaint(prism(pentagram)), HasSubstr("crosses or touches itself"));
  const Outline touching = {{0, 0}, {1, 0}, {0.5, 0.5}, {1, 1}, {0, 1}, {0.5, 0.5}};
  EXPECT_THAT(complaint(prism(touching)), HasSubstr("crosses or touches itself"));
  const Outline line = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {1.5, 0}};
  EXPECT_NE(complaint(prism(line)), "");
  for (double size : {1e-200, 1e200}) {
    Outline extreme = letter_u;
    for (auto& [x, y] : extreme) x *= size, y *= size;
    EXPECT_NE(complaint(prism(extreme)), "");
  }
}

TEST(Polygons, ErrorsHaveTheNumberOfThePolygon) {
  const std::string cube =
      "OFF\n8 5 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
      "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n";
  EXPECT_THAT(
      complaint_of(parse_off, cube),
      AllOf(StartsWith(
                "a: element 1 (line 11): not closed, 1 boundary loop; the longest has 4 edges, length 4"),
            HasSubstr("(before: 5 polygons cut into triangles)")));
}

}  // namespace esfem::test_polygons
