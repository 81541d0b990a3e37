// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/flows/exact_evolution.hpp"
#include "solver/mesh/mesh.hpp"

namespace esfem {
namespace {

/// The largest difference of a value or gradient to what the surface's level set says, in the nodes x.
double deviation_from_level_set(const ExactEvolution& exact, const Surface& surface, const Field& x) {
  Eigen::VectorXd value(exact.components());
  Eigen::MatrixXd gradient(3, exact.components());
  double largest = 0;
  const auto compare = [&](const auto& difference) {
    largest = std::max(largest, difference.cwiseAbs().maxCoeff());
  };
  for (int j = 0; j < x.rows(); ++j) {
    const Vec3 y = x.row(j), nu = surface.normal(y);
    exact.fields(0.3, y, exact.surface(0.3).shape_at(y), value, gradient);
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

}  // namespace
}  // namespace esfem
