// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "solver/analysis/differences.hpp"
#include "solver/error.hpp"
#include "solver/mesh/closest_point.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/surfaces/surface.hpp"

namespace esfem::test_differences {
namespace {

/// u = x y + z in the nodes of a mesh of the ellipsoid.
DiscreteFunctions interpolant(double edge_length, int degree, double scale = 1) {
  const Surface surface = ellipsoid(1.2 * scale, scale, 0.8 * scale);
  DiscreteFunctions result;
  result.mesh = lagrange_mesh(generate_mesh(surface, edge_length), degree);
  project_nodes(result.mesh, surface);
  const auto& x = result.mesh.nodes;
  result.fields = {{"u", (x.col(0).array() * x.col(1).array() + x.col(2).array()).matrix()}};
  return result;
}

TEST(Differences, TheComparisonOfInterpolantsHasTheirOrders) {
  // Meshes that are not nested. The interpolant on the fine mesh is the exact function but for a small part
  // of what is measured, so the slopes are those of the interpolation: k + 1 in L2, k in H1.
  for (int k = 1; k <= 3; ++k) {
    const DiscreteFunctions fine = interpolant(k == 1 ? 0.06 : 0.12, k);
    const Errors coarse = differences(interpolant(0.5, k), fine),
                 middle = differences(interpolant(0.25, k), fine);
    for (const char* quantity : {"x", "u"}) {
      const auto slope = [&](const char* norm) {
        return std::log2(coarse.at(quantity).at(norm) / middle.at(quantity).at(norm));
      };
      EXPECT_GT(slope("closest_L2"), k + 0.8) << quantity << k;
      EXPECT_GT(slope("closest_H1_semi"), k - 0.2) << quantity << k;
      EXPECT_LT(slope("closest_H1_semi"), k + 0.8) << quantity << k;
    }
  }
}

TEST(Differences, ASurfaceIsAtNoDistanceFromItself) {
  const DiscreteFunctions one = interpolant(0.3, 2);
  const Errors none = differences(one, one);
  EXPECT_LT(none.at("x").at("closest_L2"), 1e-13);
  EXPECT_LT(none.at("u").at("closest_L2"), 1e-13);
  EXPECT_LT(none.at("u").at("closest_H1"), 1e-11);
}

TEST(Differences, AShiftedSurfaceIsAtTheNormalPartOfTheShift) {
  DiscreteFunctions one = interpolant(0.3, 2), other = one;
  one.fields.clear();
  const double offset = 0.01;
  other.mesh.nodes.rowwise() += Eigen::RowVector3d(0, 0, offset);
  // The distance is the normal part of the offset, but for its square: int nu_3² offset² over the surface.
  const double found = differences(one, other).at("x").at("closest_L2");
  const Surface surface = ellipsoid(1.2, 1, 0.8);
  double sum = 0;
  const int n = 100;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double theta = M_PI * (i + 0.5) / n, phi = 2 * M_PI * (j + 0.5) / n;
      const Vec3 s(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      const Vec3 normal(s[0] * 1 * 0.8, s[1] * 1.2 * 0.8,
                        s[2] * 1.2 * 1);  // length: dA over that of the sphere
      sum += normal[2] * normal[2] / normal.norm() * std::sin(theta) * (M_PI / n) * (2 * M_PI / n);
    }
  EXPECT_NEAR(found / offset, std::sqrt(sum), 0.01 * std::sqrt(sum));
}

TEST(Differences, AFieldThatTheOtherLacksIsNamed) {
  const DiscreteFunctions one = interpolant(0.4, 1);
  DiscreteFunctions other = one;
  other.fields[0].name = "w";
  EXPECT_THROW(differences(one, other), InputError);
}

TEST(ClosestPoint, IsOnTheNormalOfTheElementWhereItIsInside) {
  const Mesh mesh = interpolant(0.4, 3).mesh;
  const ClosestPoint closest(mesh);
  int inside = 0;
  for (int i = 0; i < 200; ++i) {
    const double z = -1 + 2 * (i + 0.5) / 200, phi = 2.39996 * i, r = std::sqrt(1 - z * z);
    const Vec3 x(1.25 * r * std::cos(phi), 1.05 * r * std::sin(phi), 0.85 * z);
    const ElementPoint found = closest(x);
    // No node is closer.
    EXPECT_LE((found.y - x).norm(),
              (mesh.nodes.rowwise() - x.transpose()).rowwise().norm().minCoeff() + 1e-13);
    if (found.xi < 1e-6 || found.eta < 1e-6 || found.xi + found.eta > 1 - 1e-6) continue;
    ++inside;
    // A small move along the surface changes the distance in second order only.
    const Vec3 aside = closest(x + 1e-4 * (x - found.y).cross(Vec3(0.3, 0.5, 0.8)).normalized()).y;
    EXPECT_LT(std::abs((aside - found.y).dot(x - found.y)), 1e-7 * (x - found.y).norm());
  }
  EXPECT_GT(inside, 150);
}

}  // namespace
}  // namespace esfem::test_differences
