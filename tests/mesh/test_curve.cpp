// SPDX-License-Identifier: GPL-3.0-or-later
// Curved elements on flat triangulations: what they keep, and surfaces that are not smooth. Their orders on
// smooth ones are in flows/test_start_on_curved_elements.cpp.
#include <gmock/gmock.h>

#include <cmath>

#include "solver/assembly/surface_space.hpp"
#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/mesh/curve.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/mesh/test_folder.hpp"

namespace esfem::test_curve {
namespace {

using testing::HasSubstr;

TEST(CurvedMesh, KeepsCornersAndDoesNotDependOnUnits) {
  const Mesh flat = icosphere(1, 2), exact = lagrange_mesh(flat, 2), curved = curved_mesh(flat, 2).mesh;
  EXPECT_EQ(corner_mesh(curved).nodes, corner_mesh(exact).nodes);
  EXPECT_EQ(curved.elements, exact.elements);
  Mesh small = flat;
  small.nodes = 1e-9 * flat.nodes;
  EXPECT_LT((1e9 * curved_mesh(small, 2).mesh.nodes - curved.nodes).norm(), 1e-10);
}

/// A prism with n sides and rings of edges at these heights; its lids are cut from their centres.
Mesh prism(int n, const std::vector<double>& heights) {
  Mesh mesh;
  const int rings = int(heights.size()), bottom = n * rings, top = bottom + 1;
  mesh.nodes.resize(n * rings + 2, 3);
  for (int r = 0; r < rings; ++r)
    for (int i = 0; i < n; ++i)
      mesh.nodes.row(r * n + i) << std::cos(2 * pi * i / n), std::sin(2 * pi * i / n), heights[r];
  mesh.nodes.row(bottom) << 0, 0, heights.front();
  mesh.nodes.row(top) << 0, 0, heights.back();
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n, last = (rings - 1) * n;
    for (int ring = 0; ring < last; ring += n) {
      triangles.push_back({ring + i, ring + j, ring + n + j});
      triangles.push_back({ring + i, ring + n + j, ring + n + i});
    }
    triangles.push_back({bottom, j, i});
    triangles.push_back({top, last + i, last + j});
  }
  mesh.elements.resize(triangles.size(), 3);
  for (std::size_t e = 0; e < triangles.size(); ++e)
    for (int i = 0; i < 3; ++i) mesh.elements(e, i) = triangles[e][i];
  return mesh;
}

TEST(CurvedMesh, MakesARoundCylinderWithPlaneLids) {
  const int n = 24;
  for (const auto& heights : {std::vector<double>{0, 0.3, 0.6, 0.9}, {0, 0.9}}) {
    const CurvedMesh curved = curved_mesh(prism(n, heights), 2);
    EXPECT_EQ(curved.sharp_edges, 2 * n);
    EXPECT_EQ(curved.straight, 0);
    const Mesh& mesh = curved.mesh;
    const double sagitta = 1 - std::cos(pi / n);
    for (int e = 0; e < mesh.elements.rows(); ++e)
      for (int i = 0; i < 3; ++i) {
        const Vec3 x = mesh.nodes.row(mesh.elements(e, 3 + i));
        const Vec3 a = mesh.nodes.row(mesh.elements(e, i)), b = mesh.nodes.row(mesh.elements(e, (i + 1) % 3));
        if (a[2] == b[2]) {
          const bool on_lid = a[2] == heights.front() || a[2] == heights.back();
          EXPECT_NEAR(x[2], a[2], on_lid ? 1e-12 : 1e-6);
        }
        const bool to_centre = a.head<2>().norm() < 0.5 || b.head<2>().norm() < 0.5;
        EXPECT_NEAR(x.head<2>().norm(), to_centre ? 0.5 : 1, 0.05 * sagitta);
      }
  }
}

TEST(CurvedMesh, LeavesPolyhedraAsTheyAre) {
  const Mesh box = prism(4, {0, 0.5, 1});
  const CurvedMesh curved = curved_mesh(box, 3);
  EXPECT_EQ(curved.sharp_edges, 16);  // four sides of each lid, and four upright edges in two parts
  EXPECT_LT((curved.mesh.nodes - lagrange_mesh(box, 3).nodes).norm(), 1e-12);
  EXPECT_TRUE(is_flat(curved_mesh(icosphere(1, 0), 2).mesh));
  EXPECT_FALSE(is_flat(curved_mesh(icosphere(1, 0), 2, 60).mesh)) << "without features it is rounded";
}

TEST(CurvedMesh, StaysSoundOnRoughSurfaces) {
  Mesh rough = icosphere(1, 2);
  for (int i = 0; i < rough.nodes.rows(); ++i) rough.nodes.row(i) *= 1 + 0.5 * std::sin(1e3 * i);
  for (int degree : {2, 3, 4}) {
    const CurvedMesh curved = curved_mesh(rough, degree, 180);
    EXPECT_GT(curved.straight, 0);
    EXPECT_GT(SurfaceSpace(curved.mesh).area(curved.mesh.nodes), 12);
    const SurfaceSpace flat(lagrange_mesh(rough, degree));
    EXPECT_LT(SurfaceSpace(curved.mesh).area(curved.mesh.nodes),
              1.5 * flat.area(lagrange_mesh(rough, degree).nodes));
  }
}

TEST(CurvedMesh, KnowsFlatElements) {
  EXPECT_TRUE(is_flat(icosphere(1, 1)));
  Mesh mesh = lagrange_mesh(icosphere(1, 1), 2);
  EXPECT_TRUE(is_flat(mesh));
  mesh.nodes.row(mesh.elements(5, 4)) *= 1 + 1e-4;
  EXPECT_FALSE(is_flat(mesh));
}

TEST(CurvedMesh, RefusesWhatItCannotCurve) {
  const Mesh mesh = icosphere(1, 1);
  EXPECT_THAT(complaint<InputError>([&] { curved_mesh(mesh, 1); }), HasSubstr("degree 1"));
  EXPECT_THAT(complaint<InputError>([&] { curved_mesh(lagrange_mesh(mesh, 2), 2); }), HasSubstr("degree 2"));
  EXPECT_THAT(complaint<InputError>([&] { curved_mesh(mesh, 2, 0); }), HasSubstr("feature angle 0"));
  Mesh open = mesh;
  open.elements.conservativeResize(mesh.elements.rows() - 1, 3);
  EXPECT_THAT(complaint<InputError>([&] { curved_mesh(open, 2); }), HasSubstr("not closed"));
}

}  // namespace
}  // namespace esfem::test_curve
