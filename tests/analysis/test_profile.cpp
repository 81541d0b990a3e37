// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "solver/analysis/diagnostics.hpp"
#include "solver/constants.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/tables/table.hpp"

namespace esfem::test_profile {
namespace {

TEST(Profile, OfTheDumbbell) {
  Mesh mesh = lagrange_mesh(generate_mesh(dumbbell(), 0.1), 2);
  project_nodes(mesh, dumbbell());
  // A quarter turn about the x3 axis changes nothing, a shift of the whole surface off the axis hardly
  // anything.
  for (double shift : {0.0, 0.01}) {
    Field x = mesh.nodes;
    x.col(0).array() += shift;
    Series series;
    record_profile(x, series);
    // r² = 0.04 + 2 s (199/200 - s), s = x3²: least at s = 0, largest at s = 199/400, zero at the tips.
    EXPECT_NEAR(series["neck_radius"][0], 0.2, 1e-6 + 0.05 * shift);
    EXPECT_NEAR(series["widest_radius"][0], std::sqrt(0.04 + 2 * std::pow(199.0 / 400, 2)), 1e-4 + shift);
    EXPECT_NEAR(series["tip"][0], std::sqrt(199.0 / 400 + std::sqrt(std::pow(199.0 / 400, 2) + 0.02)), 1e-3);
  }
}

TEST(NodeDensity, IsThatOfTheRingWithTheSmallestElements) {
  const Mesh mesh = generate_mesh(dumbbell(), 0.1);
  Series series;
  record_node_density(mesh.elements, mesh.nodes, series);
  EXPECT_GT(series["smallest_elements"].back(), 0.9) << "edges of nearly one length";
  // Squeezed towards the plane x3 = 0, where triangles become small.
  Field x = mesh.nodes;
  x.col(2) = x.col(2).cwiseProduct(x.col(2).cwiseAbs());
  record_node_density(mesh.elements, x, series);
  EXPECT_LT(series["smallest_elements"].back(), 0.7);
  EXPECT_LT(series["smallest_elements_x3"].back(), 0.3);
}

TEST(FittedRadii, OfASphereAndATorusAwayFromTheOrigin) {
  Field ball = 1.3 * icosphere(1, 2).nodes;
  ball.rowwise() += Eigen::RowVector3d(0.4, -2, 1);
  EXPECT_NEAR(fitted_sphere_radius(ball), 1.3, 1e-12);
  ball.col(0) *= 1.01;
  EXPECT_GT(fitted_sphere_radius(ball), 1.302);

  Field ring = torus_grid(1.7, 0.6, 24, 14).nodes;
  ring.rowwise() += Eigen::RowVector3d(0.2, 0.1, -3);
  const TorusRadii radii = fitted_torus_radii(ring);
  EXPECT_NEAR(radii.major, 1.7, 1e-12);
  EXPECT_NEAR(radii.minor, 0.6, 1e-12);
}

TEST(PinchTime, IsExactWhereTheSquaredNeckRadiusIsAParabola) {
  Series series;
  for (double t : {0.0, 0.05, 0.06, 0.068}) {
    series["t"].push_back(t);
    series["neck_radius"].push_back(std::sqrt((0.08 - t) * (t + 0.5)));
  }
  ASSERT_TRUE(pinch_time(series));
  EXPECT_NEAR(*pinch_time(series), 0.08, 1e-12);
  // What happens when the neck is nearly gone does not count.
  for (double t : {0.079, 0.085}) {
    series["t"].push_back(t);
    series["neck_radius"].push_back(0.02);
  }
  EXPECT_NEAR(*pinch_time(series), 0.08, 1e-12);
}

TEST(PinchTime, OfTheAxisymmetricReference) {
  const auto reference =
      read_json(std::string(ESFEM_SOURCE_DIR) + "/reference/independent/dumbbell_axisymmetric.json");
  const double pinch = reference["pinch"];
  Series series;
  for (const auto& row : reference["rows"]) {
    if (row[0].get<double>() > 0.0805) break;
    series["t"].push_back(row[0]);
    series["neck_radius"].push_back(row[1]);
  }
  ASSERT_EQ(series["t"].size(), 17u) << "0, 0.005, .., 0.08";
  EXPECT_NEAR(*pinch_time(series), pinch, 1.5e-4);
}

TEST(PinchTime, IsNotThereWithoutAPinch) {
  const auto of = [](std::vector<double> radius) {
    Series series;
    for (double r : radius) {
      series["t"].push_back(0.01 * series["t"].size());
      series["neck_radius"].push_back(r);
    }
    return pinch_time(series);
  };
  EXPECT_FALSE(of({0.2, 0.05})) << "too few steps";
  EXPECT_FALSE(of({0.2, 0.19, 0.18, 0.17})) << "still wide";
  EXPECT_FALSE(of({0.2, 0.05, 0.06, 0.07})) << "opens";
  EXPECT_TRUE(of({0.2, 0.09, 0.08, 0.06}));
  // Bent upwards: the line through the last two, here of slope -1 a step.
  EXPECT_NEAR(*of({2, std::sqrt(3.5), std::sqrt(1.5), std::sqrt(0.5)}), 0.035, 1e-12);
}

TEST(ExtinctionTime, IsWhereTheAreaOfTheNextStepIsNotPositive) {
  const auto of = [](std::vector<double> area, int steps = 1) {
    Series series;
    for (double a : area) {
      series["t"].push_back(0.5 * series["t"].size());
      series["area"].push_back(a);
    }
    return extinction_time(series, steps);
  };
  EXPECT_FALSE(of({4}));
  EXPECT_FALSE(of({4, 4}));
  EXPECT_FALSE(of({4, 5})) << "grows";
  EXPECT_FALSE(of({5, 4, 3, 2})) << "one more step";
  EXPECT_EQ(*of({5, 4, 3, 2}, 2), 2.5) << "that of the line";
  EXPECT_EQ(*of({3, 2, 1}), 1.5);
  EXPECT_NEAR(*of({3, 2, 0.5}), 1 + 0.5 / 3, 1e-15);
  EXPECT_FALSE(of({3, 1})) << "too few";
  EXPECT_FALSE(of({3, 2.9, 1})) << "a jump";
  // Small steps: the area halves no more, but nothing is left.
  EXPECT_FALSE(of({1, 4e-6, 3e-6}));
  EXPECT_TRUE(of({1, 1.1e-6, 9e-7}));
}

TEST(LatestEnd, OfMeanCurvatureFlowIsThatOfTheSphereOfTheArea) {
  const double a = 16 * pi;  // of the sphere of radius 2, which lives for a time of 1
  EXPECT_DOUBLE_EQ(latest_end_of_mean_curvature_flow({{"t", {0}}, {"area", {a}}}), 1);
  EXPECT_DOUBLE_EQ(latest_end_of_mean_curvature_flow({{"t", {0, 0.5}}, {"area", {a, a / 2}}}), 1);
  EXPECT_DOUBLE_EQ(latest_end_of_mean_curvature_flow({{"t", {0, 0.5, 0.6}}, {"area", {2 * a, a / 4, a / 4}}}),
                   0.75);
}

}  // namespace
}  // namespace esfem::test_profile
