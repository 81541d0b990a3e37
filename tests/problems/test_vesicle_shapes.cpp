// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "solver/flows/area_and_volume.hpp"
#include "solver/problems/vesicle_shapes.hpp"
#include "solver/tables/table.hpp"
#include "tests/assembly/meshes.hpp"

namespace esfem::test_vesicle_shapes {
namespace {

TEST(VesicleShapes, AreThoseOfTheReference) {
  const nlohmann::json json =
      read_json(std::string(ESFEM_SOURCE_DIR) + "/reference/independent/helfrich.json");
  ASSERT_EQ(json["shapes"].size(), vesicle_shapes().size());
  for (const nlohmann::json& expected : json["shapes"]) {
    const VesicleShape& shape = vesicle_shape(expected["branch"], expected["v"], expected["H0"]);
    EXPECT_EQ(shape.energy, expected["E_over_8pi"].get<double>());
    EXPECT_EQ(shape.lambda_A, expected["lambda_A"].get<double>());
    EXPECT_EQ(shape.lambda_V, expected["lambda_V"].get<double>());
    const std::vector<Eigen::Vector2d> profile = shape.profile(4000);
    for (int i = 0; i <= 40; ++i) {
      EXPECT_NEAR(profile[100 * i][0], expected["profile"]["r"][i].get<double>(), 1e-10);
      EXPECT_NEAR(profile[100 * i][1], expected["profile"]["z"][i].get<double>(), 1e-10);
    }
  }
}

TEST(VesicleShapes, ASurfaceOnTheShapeHasDistanceZero) {
  // Nodes of a sphere are moved to the profile, and the surface to another place, size and axis.
  const VesicleShape& shape = vesicle_shape("prolate", 0.8, 0);
  const std::vector<Eigen::Vector2d> profile = shape.profile(20000);
  Mesh mesh = sphere_mesh(1, 2, 2);
  for (int j = 0; j < mesh.nodes.rows(); ++j) {
    const Vec3 y = mesh.nodes.row(j);
    const Eigen::Vector2d p =
        profile[std::lround(std::acos(std::clamp(y[2], -1.0, 1.0)) / 3.14159265358979 * 20000)];
    const double rho = std::hypot(y[0], y[1]);
    mesh.nodes.row(j) << (rho > 0 ? y[0] / rho * p[0] : 0), (rho > 0 ? y[1] / rho * p[0] : 0), p[1];
  }
  const SurfaceSpace space(mesh);
  const double area = space.area(mesh.nodes);
  EXPECT_LT(distance_from(shape, space, mesh.nodes), 1e-3) << "the area of the P2 surface is not quite 4 pi";
  Field moved = 3 * mesh.nodes;
  moved.col(0).swap(moved.col(2));
  moved.col(1).array() += 2;
  EXPECT_NEAR(distance_from(shape, space, moved), distance_from(shape, space, mesh.nodes), 1e-9);
  EXPECT_NEAR(reduced_volume(area, space.volume(mesh.nodes)), 0.8, 1e-3);
  EXPECT_GT(distance_from(vesicle_shape("prolate", 0.75, 0), space, mesh.nodes), 0.02);
  EXPECT_GT(distance_from(vesicle_shape("oblate", 0.8, 0), space, mesh.nodes), 0.02);
}

}  // namespace
}  // namespace esfem::test_vesicle_shapes
