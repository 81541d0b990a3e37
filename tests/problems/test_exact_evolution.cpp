// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/error.hpp"
#include "solver/mesh/mesh.hpp"
#include "solver/problems/exact_evolution.hpp"
#include "solver/surfaces/angenent_torus.hpp"

namespace esfem::test_exact_evolution {
namespace {

/// Value and gradient (3 x components) of the exact fields in one point.
std::pair<Eigen::VectorXd, Eigen::MatrixXd> fields_at(const ExactEvolution& exact, double t, const Vec3& y) {
  SurfacePoints points;
  for (int lane = 0; lane < pack_size; ++lane) set_lane(points, lane, y, exact.surface(t).shape_at(y));
  FieldsAtPoints fields(exact.components());
  exact.fields(t, points, fields);
  Eigen::VectorXd value(exact.components());
  Eigen::MatrixXd gradient(3, exact.components());
  for (int l = 0; l < exact.components(); ++l) {
    value[l] = fields.value[l][0];
    for (int i = 0; i < 3; ++i) gradient(i, l) = fields.gradient[l][i][0];
  }
  return {value, gradient};
}

/// The largest difference of a value or gradient from that of the surface's level set, in the nodes x.
double deviation_from_level_set(const ExactEvolution& exact, const Surface& surface, const Field& x) {
  double largest = 0;
  const auto compare = [&](const auto& difference) {
    largest = std::max(largest, difference.cwiseAbs().maxCoeff());
  };
  for (int j = 0; j < x.rows(); ++j) {
    const Vec3 y = x.row(j), nu = surface.normal(y);
    const auto [value, gradient] = fields_at(exact, 0.3, y);
    compare(value.segment<3>(exact.column("x")) - y);
    compare(value.segment<3>(exact.column("nu")) - nu);
    compare(value.segment<1>(exact.column("H")).array() - surface.mean_curvature(y));
    compare(gradient.middleCols<3>(exact.column("x")) - (Mat3::Identity() - nu * nu.transpose()));
    compare(gradient.middleCols<3>(exact.column("nu")) - surface.weingarten(y));
    compare(gradient.col(exact.column("H")) - surface.mean_curvature_gradient(y));
  }
  return largest;
}

TEST(StationaryEvolution, HasTheFieldsOfItsSurface) {
  const double minor = std::sqrt(0.5);
  const Field on_sphere = icosphere(1.7, 2).nodes, on_clifford = torus_grid(1, minor, 12, 9).nodes,
              on_torus = torus_grid(1, 0.4, 12, 9).nodes;
  EXPECT_LT(deviation_from_level_set(stationary_sphere(1.7), sphere(1.7), on_sphere), 1e-13);
  EXPECT_LT(deviation_from_level_set(stationary_torus(1, minor), torus(1, minor), on_clifford), 1e-12);
  EXPECT_LT(deviation_from_level_set(stationary_torus(1, 0.4), torus(1, 0.4), on_torus), 1e-12);
  EXPECT_GT(deviation_from_level_set(stationary_torus(1.01, 0.4), torus(1, 0.4), on_torus), 1e-3);
  EXPECT_GT(deviation_from_level_set(stationary_sphere(1.71), sphere(1.7), on_sphere), 1e-3);
}

TEST(StationaryEvolution, StaysWhereItIs) {
  const Field x0 = torus_grid(1, 0.4, 5, 4).nodes;
  const ExactEvolution exact = stationary_torus(1, 0.4);
  EXPECT_EQ(exact.trajectories(x0, 7), x0);
  EXPECT_EQ(exact.components(), 7);
  const Field values = exact.nodal_values(x0, 7);
  EXPECT_EQ(values.leftCols(3), x0);
  EXPECT_EQ(values, exact.nodal_values(x0, 0));
}

/// Points of the self-shrinking torus with that scale.
Field angenent_nodes(double scale) {
  const int n = 100;
  Field x(n, 3);
  for (int j = 0; j < n; ++j) {
    const Eigen::Vector2d p = scale * angenent_profile().at(j * angenent_profile().length() / n).position;
    x.row(j) << p[0] * std::cos(j), p[0] * std::sin(j), p[1];
  }
  return x;
}

/// The largest |dx/dt - v| along the trajectories from x0 (central differences of order four in time).
double deviation_of_velocity(const ExactEvolution& exact, const Field& x0, double t) {
  const double step = 1e-3;
  const auto x = [&](double s) -> Field { return exact.trajectories(x0, s); };
  const Field difference =
      (8 * (x(t + step) - x(t - step)) - (x(t + 2 * step) - x(t - 2 * step))) / (12 * step);
  const Field v = exact.nodal_values(x(t), t).middleCols(exact.column("v"), 3);
  return (difference - v).cwiseAbs().maxCoeff();
}

TEST(ShrinkingAngenentTorus, MovesByItsMeanCurvature) {
  for (const double scale : {1.0, 0.8}) {
    const ExactEvolution exact = shrinking_angenent_torus(scale);
    const Field x0 = angenent_nodes(scale);
    for (const double t : {0.05, 0.2, 0.3}) EXPECT_LT(deviation_of_velocity(exact, x0, t), 1e-9) << t;
    EXPECT_LT((exact.trajectories(x0, 0) - x0).cwiseAbs().maxCoeff(), 1e-12);
  }
  // Particles that do not slide move with the right normal velocity, but not normally.
  ExactEvolution scaled = shrinking_angenent_torus();
  scaled.trajectories = [](const Field& x0, double t) -> Field { return std::sqrt(1 - t) * x0; };
  EXPECT_GT(deviation_of_velocity(scaled, angenent_nodes(1), 0.2), 0.1);
}

TEST(ShrinkingAngenentTorus, StaysOnItsSurface) {
  const ExactEvolution exact = shrinking_angenent_torus();
  const Field x0 = angenent_nodes(1);
  for (const double t : {0.0, 0.2, 0.5}) {
    const Surface surface = exact.surface(t);
    const Field x = exact.trajectories(x0, t);
    for (int j = 0; j < x.rows(); ++j) EXPECT_NEAR(surface.level(x.row(j)), 0, 1e-12);
  }
}

TEST(ShrinkingAngenentTorus, TrajectoriesArePassedOnAtAnyTime) {
  // From 0 to 0.5 at once, or by way of 0.3: from there on the surface is a torus of scale sqrt(0.7).
  const Field x0 = angenent_nodes(1);
  const ExactEvolution whole = shrinking_angenent_torus(), rest = shrinking_angenent_torus(std::sqrt(0.7));
  const Field apart = whole.trajectories(x0, 0.5) - rest.trajectories(whole.trajectories(x0, 0.3), 0.2);
  EXPECT_LT(apart.cwiseAbs().maxCoeff(), 1e-11);
}

TEST(ShrinkingAngenentTorus, HasTheFieldsOfItsSurface) {
  const double t = 0.3;
  const Field on_surface = angenent_nodes(std::sqrt(1 - t));
  const ExactEvolution exact = shrinking_angenent_torus();
  EXPECT_LT(deviation_from_level_set(exact, exact.surface(t), on_surface), 1e-11);
  EXPECT_GT(deviation_from_level_set(shrinking_angenent_torus(1.01), exact.surface(t), on_surface), 1e-3);
}

TEST(ShrinkingAngenentTorus, GradientOfTheVelocityIsThatOfMinusHNu) {
  const double t = 0.3, step = 1e-5;
  const ExactEvolution exact = shrinking_angenent_torus();
  const Surface surface = exact.surface(t);
  const auto v = [&](const Vec3& y) -> Vec3 { return -surface.mean_curvature(y) * surface.normal(y); };
  const Field x = angenent_nodes(std::sqrt(1 - t));
  for (int j = 0; j < x.rows(); ++j) {
    const Vec3 y = x.row(j);
    const auto [value, gradient] = fields_at(exact, t, y);
    EXPECT_LT((value.segment<3>(3) - v(y)).norm(), 1e-11);
    for (int i = 0; i < 3; ++i) {
      const Vec3 next = surface.closest_point(y + step * Vec3::Unit(i)),
                 last = surface.closest_point(y - step * Vec3::Unit(i));
      const Vec3 slope = (v(next) - v(last)) / (2 * step);
      EXPECT_LT((gradient.middleCols<3>(3).row(i).transpose() - slope).norm(), 1e-6);
    }
  }
}

TEST(ShrinkingAngenentTorus, EndsWhereItHasShrunkToAPoint) {
  EXPECT_THROW(shrinking_angenent_torus(0.5).surface(0.25), InputError);
}

}  // namespace
}  // namespace esfem::test_exact_evolution
