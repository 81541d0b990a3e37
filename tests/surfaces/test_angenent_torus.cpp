// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/surfaces/angenent_torus.hpp"

namespace esfem::test_angenent_torus {
namespace {

TEST(PeriodicTable, InterpolatesWithOrderEight) {
  const auto f = [](double s) { return std::exp(std::sin(2 * pi * s / 3)); };
  const auto error = [&](int n) {
    Eigen::RowVectorXd values(n);
    for (int j = 0; j < n; ++j) values[j] = f(3.0 * j / n);
    const PeriodicTable<1> table(3, values);
    double largest = 0;
    for (double s = -4; s < 7; s += 0.0137) largest = std::max(largest, std::abs(table(s)[0] - f(s)));
    return largest;
  };
  EXPECT_GT(std::log2(error(32) / error(64)), 7.5);
  EXPECT_LT(error(512), 1e-14);
}

TEST(AngenentProfile, ClosesAndIsSymmetricToTheEquator) {
  const AngenentProfile& profile = angenent_profile();
  EXPECT_LT(profile.gap(), 1e-12);
  for (double s = 0; s < profile.length(); s += 0.0731) {
    const AngenentProfile::Point above = profile.at(s), below = profile.at(-s);
    EXPECT_NEAR(above.position[0], below.position[0], 1e-12);
    EXPECT_NEAR(above.position[1], -below.position[1], 1e-12);
    EXPECT_NEAR(above.meridian_curvature, below.meridian_curvature, 1e-11);
  }
}

/// (1/(4 pi)) times the integral of exp(-|x|²/4) over the surface: 4/e on the shrinking sphere.
TEST(AngenentProfile, HasItsEntropy) {
  const AngenentProfile& profile = angenent_profile();
  double sum = 0;
  const int n = 500;
  for (int j = 0; j < n; ++j) {
    const Eigen::Vector2d p = profile.at(j * profile.length() / n).position;
    sum += p[0] / 2 * std::exp(-p.squaredNorm() / 4) * profile.length() / n;
  }
  EXPECT_NEAR(sum, 1.85121667, 5e-9);
}

TEST(AngenentProfile, HasTheCurvaturesOfItsTable) {
  const AngenentProfile& profile = angenent_profile();
  const double step = 1e-4;
  for (double s = 0; s < profile.length(); s += 0.0731) {
    const AngenentProfile::Point p = profile.at(s), next = profile.at(s + step), last = profile.at(s - step);
    EXPECT_LT(((next.position - last.position) / (2 * step) - p.tangent).norm(), 1e-7);
    EXPECT_LT(((next.normal - last.normal) / (2 * step) - p.meridian_curvature * p.tangent).norm(), 1e-6);
    EXPECT_NEAR(p.parallel_curvature, p.normal[0] / p.position[0], 1e-13);
    EXPECT_NEAR(p.meridian_curvature + p.parallel_curvature, p.position.dot(p.normal) / 2, 1e-12);
  }
}

TEST(AngenentProfile, IsAGraphOverTheAngle) {
  const AngenentProfile& profile = angenent_profile();
  for (double s = 0; s < profile.length(); s += 0.0731) {
    const Eigen::Vector2d p = profile.at(s).position, away = p - Eigen::Vector2d(1.5, 0);
    const double found = profile.radial_arclength(p[0], p[1]);
    EXPECT_LT((profile.at(found).position - p).norm(), 1e-13);
    EXPECT_NEAR(profile.radial_level(p[0], p[1]), 0, 1e-13);
    EXPECT_GT(profile.radial_level(p[0] + 0.01 * away[0], p[1] + 0.01 * away[1]), 0);
    EXPECT_LT(profile.radial_level(p[0] - 0.01 * away[0], p[1] - 0.01 * away[1]), 0);
  }
}

/// Points of the surface with that scale, and a little beside it.
std::vector<Vec3> points_of(double scale, double offset) {
  const AngenentProfile& profile = angenent_profile();
  std::vector<Vec3> points;
  for (double s = 0; s < profile.length(); s += 0.0731) {
    const AngenentProfile::Point p = profile.at(s);
    const Eigen::Vector2d moved = scale * p.position + offset * p.normal;
    points.emplace_back(moved[0] * std::cos(9 * s), moved[0] * std::sin(9 * s), moved[1]);
  }
  return points;
}

/// The largest |H - <y, nu>/(2 scale²)| on the surface of that scale.
double shrinker_residual(const Surface& surface, double scale) {
  double largest = 0;
  for (const Vec3& y : points_of(surface.parameters.at("scale"), 0)) {
    const double expected = y.dot(surface.normal(y)) / (2 * scale * scale);
    largest = std::max(largest, std::abs(surface.mean_curvature(y) - expected));
  }
  return largest;
}

TEST(AngenentTorus, ShrinksItself) {
  EXPECT_LT(shrinker_residual(angenent_torus(), 1), 1e-11);
  EXPECT_LT(shrinker_residual(angenent_torus(0.6), 0.6), 1e-11);
  EXPECT_GT(shrinker_residual(angenent_torus(0.6), 0.601), 1e-3);
}

TEST(AngenentTorus, ItsLevelSetIsTheSignedDistanceWithItsDerivatives) {
  for (const double scale : {1.0, 0.7}) {
    const Surface surface = angenent_torus(scale);
    for (const double offset : {-0.2, -0.05, 0.0, 0.1, 0.2}) {
      for (const Vec3& y : points_of(scale, offset)) {
        const LevelSetJet jet = surface.level_set(y);
        EXPECT_NEAR(jet.value, offset, 1e-13);
        EXPECT_GE(surface.level(y) * offset, 0);
        const double step = 1e-5;
        for (int i = 0; i < 3; ++i) {
          const Vec3 shift = step * Vec3::Unit(i);
          const LevelSetJet next = surface.level_set(y + shift), last = surface.level_set(y - shift);
          EXPECT_NEAR((next.value - last.value) / (2 * step), jet.gradient[i], 1e-8);
          EXPECT_LT(((next.gradient - last.gradient) / (2 * step) - jet.hessian.col(i)).norm(), 1e-6);
        }
      }
    }
  }
}

TEST(AngenentTorus, HasTheDerivativesOfItsMeanCurvature) {
  const double step = 1e-3;
  for (const double scale : {1.0, 0.7}) {
    const Surface surface = angenent_torus(scale);
    // H in space, constant along normals.
    const auto H = [&](const Vec3& x) { return surface.mean_curvature(surface.closest_point(x)); };
    for (const Vec3& y : points_of(scale, 0)) {
      const LevelSetJet jet = surface.mean_curvature_jet(y);
      EXPECT_NEAR(jet.value, H(y), 1e-11);
      for (int i = 0; i < 3; ++i) {
        const Vec3 e = step * Vec3::Unit(i);
        EXPECT_NEAR((H(y + e) - H(y - e)) / (2 * step), jet.gradient[i], 2e-4);
        for (int j = 0; j < 3; ++j) {
          const Vec3 f = step * Vec3::Unit(j);
          const double second =
              (H(y + e + f) - H(y + e - f) - H(y - e + f) + H(y - e - f)) / (4 * step * step);
          EXPECT_NEAR(second, jet.hessian(i, j), 5e-3);
        }
      }
    }
  }
}

TEST(AngenentTorus, ItsMeshHasItsTopology) {
  const Mesh mesh = generate_mesh(angenent_torus(), 0.4);
  EXPECT_EQ(euler_characteristic(mesh), 0);
}

TEST(AngenentTorus, RefusesScalesThatAreNotPositive) {
  EXPECT_THROW(angenent_torus(0), InputError);
  EXPECT_THROW(angenent_torus(-1), InputError);
  EXPECT_THROW(angenent_torus(NAN), InputError);
}

}  // namespace
}  // namespace esfem::test_angenent_torus
